"""Shape modes: principal components of aligned outlines, of simulations and data in one space."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.microscopy.outlines import Outlines
from cellcrawl.microscopy.polygons import area_of, centroid_of, equally_spaced
from cellcrawl.observables.edges import edge_series
from cellcrawl.validation import real_array, whole_number

POINTS = 100
_ROUNDS = 30
_SETTLED = 1e-10


@dataclass(frozen=True, eq=False)
class ShapeModes:
    """How shapes vary about their mean.

    Attributes
    ----------
    mean : ndarray, shape (point, 2)
        Mean of the aligned outlines, centred.
    modes : ndarray, shape (mode, point, 2)
        Unit vectors, the one with the largest variance first.
    variances : ndarray, shape (mode,)
        Variance of the shapes along each.
    scores : tuple of ndarray, shape (outline, mode)
        Where the outlines of each series lie along the modes.
    normalised : bool
        Whether outlines were brought to the area pi.
    reflected : bool
        Whether mirror images count as one shape.
    """

    mean: np.ndarray
    modes: np.ndarray
    variances: np.ndarray
    scores: tuple[np.ndarray, ...]
    normalised: bool
    reflected: bool

    @property
    def explained(self) -> np.ndarray:
        """Part of the whole variance in each mode, (mode,)."""
        total = float(self.variances.sum())
        return self.variances / total if total > 0.0 else np.zeros_like(self.variances)

    def project(self, series: Any) -> np.ndarray:
        """Return where other outlines lie in the same space, (outline, mode).

        Parameters
        ----------
        series : Dataset, Outlines or sequence of array_like, shape (points, 2)
        """
        shapes = _prepared(series, self.mean.shape[0], self.normalised)
        target = _complex(self.mean)
        aligned = np.array([_aligned(shape, target, self.reflected) for shape in shapes])
        return self._scores(aligned)

    def shape(self, scores: Any) -> np.ndarray:
        """Return the outline, (point, 2), at scores along the first modes."""
        along = real_array("scores", np.atleast_1d(scores), (None,))
        if along.size > self.modes.shape[0]:
            raise InputError(f"there are {self.modes.shape[0]} modes, not {along.size}")
        outline: np.ndarray = self.mean + np.tensordot(along, self.modes[: along.size], axes=1)
        return outline

    def _scores(self, aligned: np.ndarray) -> np.ndarray:
        apart = aligned - _complex(self.mean)
        rows = np.concatenate([apart.real, apart.imag], axis=1)
        flat = np.concatenate([self.modes[..., 0], self.modes[..., 1]], axis=1)
        scores: np.ndarray = rows @ flat.T
        return scores


@checked
def shape_modes(
    *series: Any,
    modes: int = 6,
    points: int = POINTS,
    normalise: bool = True,
    reflect: bool = False,
) -> ShapeModes:
    """Find the principal components of outlines from runs and from data, in one space.

    Parameters
    ----------
    *series : Dataset, Outlines or sequence of array_like, shape (points, 2)
        Runs, edges from `edge_series`, outlines of any number of cells, or polygons.
    modes : int
        How many to keep.
    points : int
        Points along each outline.
    normalise : bool
        Bring all outlines to the area pi first, so that shapes from cells of another size, or in
        another unit, can be compared. Without it size is a mode too, in most data the first.
    reflect : bool
        Let mirror images count as one shape: a cell that turns left is then one that turns right.

    Returns
    -------
    ShapeModes

    Raises
    ------
    InputError
        For fewer than two outlines, or what is no series of them.

    Notes
    -----
    As Keren et al. (Nature 453, 475, 2008) and Celltool (Pincus & Theriot, J. Microsc. 227, 140,
    2007) do: outlines are sampled at equal arclength, centred, and turned, and their first point
    moved along, until each lies nearest to the mean of all in the sum of squares; the mean is
    taken again until it settles. Each series weighs by its number of outlines. Data are smoothed
    as `edge_series` does. The sign of a mode means nothing. Modes are fluctuations about a mean:
    of two kinds of cell the first mode is how the kinds differ, whatever the cells do.
    """
    whole_number("modes", modes, 1)
    whole_number("points", points, 8)
    prepared = [_prepared(one, points, normalise) for one in series]
    shapes = np.concatenate(prepared) if prepared else np.zeros((0, points))
    if shapes.shape[0] < 2:
        raise InputError("shape modes need two outlines at least")
    target = shapes[0]
    for _ in range(_ROUNDS):
        aligned = np.array([_aligned(shape, target, reflect) for shape in shapes])
        mean = aligned.mean(axis=0)
        moved = float(np.mean(np.abs(mean - target) ** 2) / np.mean(np.abs(mean) ** 2))
        target = mean
        if moved < _SETTLED:
            break
    target = target * np.conj(_long_axis(target))
    aligned = np.array([_aligned(shape, target, reflect) for shape in shapes])
    mean = aligned.mean(axis=0)
    apart = aligned - mean
    rows = np.concatenate([apart.real, apart.imag], axis=1)
    _, sizes, vectors = np.linalg.svd(rows, full_matrices=False)
    kept = min(modes, sizes.size)
    vectors = vectors[:kept]
    scores = rows @ vectors.T
    bounds = np.cumsum([one.shape[0] for one in prepared])[:-1]
    return ShapeModes(
        np.column_stack([mean.real, mean.imag]),
        np.stack([vectors[:, :points], vectors[:, points:]], axis=-1),
        (sizes**2 / (rows.shape[0] - 1))[:kept],
        tuple(np.split(scores, bounds)),
        normalise,
        reflect,
    )


def _prepared(series: Any, points: int, normalise: bool) -> np.ndarray:
    """Return centred outlines (outline, point) in the complex plane, counter-clockwise."""
    shapes = []
    for polygon in _polygons(series):
        centred = polygon - centroid_of(polygon)
        if normalise:
            centred = centred * np.sqrt(np.pi / abs(area_of(centred)))
        shapes.append(_complex(equally_spaced(centred, points)))
    return np.array(shapes).reshape(-1, points)


def _polygons(series: Any) -> Iterable[np.ndarray]:
    if isinstance(series, Outlines):
        for track in series.track_ids:
            yield from _polygons(edge_series(series.of_track(track)))
    elif isinstance(series, xr.Dataset):
        if not {"x", "y"} <= set(series.variables) or series["x"].dims != ("time", "node"):
            raise InputError("a series of shapes is a run, or edges from edge_series")
        for x, y in zip(series["x"].values, series["y"].values, strict=True):
            yield np.column_stack([x, y])
    else:
        yield from _polygons(edge_series(series))


def _complex(xy: np.ndarray) -> np.ndarray:
    joined: np.ndarray = xy[..., 0] + 1j * xy[..., 1]
    return joined


def _aligned(shape: np.ndarray, target: np.ndarray, reflect: bool) -> np.ndarray:
    """Turn a shape (point,) and move its first point along until it lies nearest to another."""
    candidates = [shape]
    if reflect:
        candidates.append(np.conj(np.concatenate([shape[:1], shape[:0:-1]])))
    best, fit = shape, -np.inf
    n = shape.size
    wanted = np.conj(np.fft.fft(target))
    for candidate in candidates:
        overlap = np.fft.ifft(wanted * np.fft.fft(candidate))
        sizes = np.abs(overlap)
        first = int(np.argmax(sizes))
        if sizes[first] > fit:
            moved = _moved_on(candidate, first + _peak(*sizes[[first - 1, first, first + 1 - n]]))
            along = np.vdot(moved, target)
            best, fit = moved * along / max(abs(along), 1e-300), float(sizes[first])
    return best


def _peak(before: float, top: float, after: float) -> float:
    """Return where the parabola through three values has its top, in steps from the middle."""
    bend = before - 2.0 * top + after
    return 0.5 * (before - after) / bend if bend < 0.0 else 0.0


def _moved_on(shape: np.ndarray, points: float) -> np.ndarray:
    """Return a shape (point,) from a place on that may lie between two points."""
    number = np.fft.fftfreq(shape.size, 1.0 / shape.size)
    turned: np.ndarray = np.fft.ifft(
        np.fft.fft(shape) * np.exp(2j * np.pi * number * points / shape.size)
    )
    return turned


def _long_axis(shape: np.ndarray) -> complex:
    """Return the direction, of size 1, in which a shape is longest."""
    second = complex(np.sum(shape**2))
    return complex(np.exp(0.5j * np.angle(second)))
