"""The cell that was filmed: what people bring, as evenly spaced frames in s and µm."""

from __future__ import annotations

import math
import zlib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
import xarray as xr

from cellcrawl.errors import InputError
from cellcrawl.infer import camera, films
from cellcrawl.infer.summaries import FEWEST_FRAMES, Films
from cellcrawl.microscopy import Observation, Outlines, Track, Tracks
from cellcrawl.microscopy.columns import length_unit, time_unit
from cellcrawl.microscopy.options import Reading
from cellcrawl.microscopy.polygons import equally_spaced
from cellcrawl.validation import shown

_MICROMETRES: Final = {"nm": 1e-3, "µm": 1.0, "mm": 1e3, "m": 1e6}
_SECONDS: Final = {"ms": 1e-3, "s": 1.0, "min": 60.0, "h": 3600.0, "d": 86400.0}
_OF_THE_MODEL: Final = ("R_0", "1/k_off0")
_UNEVEN: Final = 0.05  # of the interval between frames
_TRACED: Final = 256


@dataclass(frozen=True, eq=False)
class Cell:
    """One cell of a film.

    Attributes
    ----------
    name : str
    frame : float
        Time between frames in s; in 1/k_off0 where ``model_units``.
    path : ndarray of complex, shape (frame,)
        Centroid in µm; in R_0 where ``model_units``.
    modes : ndarray of complex, shape (frame, wave), or None
        Outline; see `films.modes_of_edge`.
    pixel : float
        Size of a pixel, 0 where nobody said.
    model_units : bool
        Whether it is a run in the model's own units.
    notes : tuple of str
        What was done to it.
    """

    name: str
    frame: float
    path: np.ndarray
    modes: np.ndarray | None
    pixel: float = 0.0
    model_units: bool = False
    notes: tuple[str, ...] = ()

    @property
    def radius(self) -> float:
        """Median of the square root of area over pi, 0 without outlines."""
        if self.modes is None:
            return 0.0
        area = math.pi * np.sum(films.WAVES * np.abs(self.modes) ** 2, axis=-1)
        return math.sqrt(max(float(np.median(area)), 0.0) / math.pi)

    def first(self, frames: int) -> Cell:
        """Return the first frames."""
        modes = None if self.modes is None else self.modes[:frames]
        return replace(self, path=self.path[:frames], modes=modes)

    def track_alone(self) -> Cell:
        """Return the cell without its outlines."""
        return replace(self, modes=None)

    def film(self, time: float, length: float) -> Films:
        """Return the film in units of so many s and µm."""
        modes = None if self.modes is None else self.modes[None] / length
        return Films(self.frame / time, self.path[None] / length, modes)


def cells_of(observed: Any, outlines: Any = None) -> list[Cell]:
    """Return the cells of whatever holds tracks or outlines.

    Parameters
    ----------
    observed : run, Observation, Outlines, Track, Tracks or a sequence of these
        A track is joined with its outlines in ``outlines`` where that has the same id, or where
        both hold one cell.
    outlines : Outlines, optional
        Where ``observed`` is tracks.

    Raises
    ------
    InputError
        For no units, fewer than 16 frames, or outlines for some frames only.
    """
    if isinstance(observed, Cell):
        return [observed]
    if outlines is not None:
        if not isinstance(outlines, Outlines):
            raise InputError(f"outlines must be what read_outlines returns, not {shown(outlines)}")
        return _joined(observed, outlines)
    if isinstance(observed, xr.Dataset):
        return [_of_run(observed)]
    if isinstance(observed, Observation):
        cells = [_of_outlines(observed.outlines, name) for name in observed.outlines.track_ids]
        return [replace(cell, pixel=observed.pixel * _unit(observed)) for cell in cells]
    if isinstance(observed, Outlines):
        return [_of_outlines(observed, name) for name in observed.track_ids]
    if isinstance(observed, Track):
        return [_of_track(observed)]
    if isinstance(observed, Tracks):
        return [_of_track(track) for track in observed]
    if isinstance(observed, Sequence) and not isinstance(observed, (str, bytes)):
        if not observed:
            raise InputError("there is no cell to fit: the list is empty")
        cells = [cell for one in observed for cell in cells_of(one)]
        if len(cells) > 1 and len({cell.name for cell in cells}) == 1:  # nobody named them
            return [replace(cell, name=str(number)) for number, cell in enumerate(cells, 1)]
        return cells
    raise InputError(
        "observed must be a run, or what observe, read_tracks or read_outlines returns, not "
        f"{shown(observed)}"
    )


def _unit(observed: Any) -> float:
    return _units("the film", observed.length_units, observed.time_units)[0]


def _joined(observed: Any, outlines: Outlines) -> list[Cell]:
    tracks = [observed] if isinstance(observed, Track) else list(observed)
    known = outlines.track_ids
    if len(tracks) == 1 and len(known) == 1:
        return [replace(_of_outlines(outlines, known[0]), name=tracks[0].id or known[0])]
    cells = []
    for track in tracks:
        if track.id in known:
            cells.append(_of_outlines(outlines, track.id, len(track)))
    if cells:
        return cells
    # Numbers of different programs differ; places do not.
    for track in tracks:
        near = [name for name in known if _together(track, outlines.of_track(name))]
        if len(near) == 1:
            cells.append(replace(_of_outlines(outlines, near[0], len(track)), name=track.id))
    if not cells:
        raise InputError(
            f"no track lies within the outlines of a cell ({len(tracks)} tracks, {len(known)} "
            "cells): do both have the same pixel size and frame interval?"
        )
    return cells


def _together(track: Track, outlines: Outlines) -> bool:
    """Whether a track lies within a radius of outlines at most of their common times."""
    near, common = 0, 0
    for one in outlines:
        place = np.flatnonzero(np.abs(track.t - one.t) < 1e-6 * max(abs(one.t), 1.0))
        if place.size:
            common += 1
            away = np.hypot(*(one.centroid - (track.x[place[0]], track.y[place[0]])))
            near += bool(away < math.sqrt(one.area / math.pi))
    return common > 0 and near > 0.5 * common


def _of_run(run: xr.Dataset) -> Cell:
    if any(name not in run for name in ("x", "y", "time", "centroid_x", "centroid_y")):
        raise InputError("observed must be a run: a Dataset with its edge and centroid over time")
    time = np.asarray(run["time"].values, float)
    late = time >= films.TRANSIENT - 1e-9
    steps = np.diff(time)
    if steps.size > 1 and steps[-1] < (1.0 - _UNEVEN) * steps[-2]:
        late[-1] = False  # the end of a run, or where it tore, is between two saved times
    if late.sum() < FEWEST_FRAMES:
        raise InputError(
            f"the run has {int(late.sum())} records after t = {films.TRANSIENT:g}, where its "
            f"symmetry is broken: at least {FEWEST_FRAMES} are needed"
        )
    kept = run.isel(time=late)
    centre = kept["centroid_x"].values + 1j * kept["centroid_y"].values
    edge = kept["x"].values + 1j * kept["y"].values - centre[:, None]
    modes = films.modes_of_edge(edge.real, edge.imag)
    # The same errors of the same run, whoever fits it again; others of another.
    of_run = np.random.default_rng(zlib.crc32(centre.tobytes()))
    centre, seen = camera.least(centre, modes, of_run)
    step = _even("the run", time[late])
    note = f"the first {films.TRANSIENT:g}/k_off0, in which a resting cell starts, are left out"
    return Cell("run", step, centre, seen, 0.0, True, (note,))


def _of_outlines(outlines: Outlines, name: str, wanted: int = 0) -> Cell:
    chosen = outlines.of_track(name)
    length, time, model = _units(
        f"cell {name}", outlines.source.length_units, outlines.source.time_units
    )
    frames = np.array([one.frame for one in chosen])
    span = int(frames[-1] - frames[0]) + 1
    if len(chosen) < max(span, wanted):
        raise InputError(
            f"cell {name} has outlines in {len(chosen)} of {max(span, wanted)} frames: give all of "
            "them, or its track alone"
        )
    _enough(name, len(chosen))
    step = _even(f"cell {name}", np.array([one.t for one in chosen])) * time
    path = np.array([complex(*one.centroid) for one in chosen]) * length
    edge = np.array(
        [_complex(equally_spaced(one.xy - one.centroid, _TRACED)) * length for one in chosen]
    )
    even = films.equal_arclength(edge)
    modes = films.modes_of_edge(even.real, even.imag)
    changed = sum(bool(one.changes) for one in chosen)
    notes = (f"{changed} outlines were changed when they were read",) if changed else ()
    pixel = _pixel_of([one.xy for one in chosen]) * length
    return Cell(name, step, path, modes, pixel, model, notes)


def _pixel_of(traced: Sequence[np.ndarray]) -> float:
    """Return the pixel that outlines traced along pixels show, 0 for any others.

    They pass through the middles of sides of pixels: points are whole numbers of half pixels
    apart.
    """
    steps = np.abs(np.concatenate([np.diff(xy, axis=0) for xy in traced])).ravel()
    steps = steps[steps > 1e-9 * max(float(steps.max(initial=0.0)), 1e-300)]
    if not steps.size:
        return 0.0
    half = steps / steps.min()
    return float(2.0 * steps.min()) if np.abs(half - np.rint(half)).max() < 1e-3 else 0.0


def _complex(xy: np.ndarray) -> np.ndarray:
    return np.asarray(xy[:, 0] + 1j * xy[:, 1])


def _of_track(track: Track) -> Cell:
    name = track.id or "the track"
    length, time, model = _units(name, track.length_units, track.time_units)
    _enough(name, len(track))
    steps = np.diff(track.t)
    usual = float(np.median(steps))
    gaps = np.flatnonzero(np.abs(steps - usual) > _UNEVEN * usual)
    notes: tuple[str, ...] = ()
    part = slice(0, len(track))
    if gaps.size:
        ends = np.concatenate([[-1], gaps, [len(track) - 1]])
        longest = int(np.argmax(np.diff(ends)))
        part = slice(int(ends[longest]) + 1, int(ends[longest + 1]) + 1)
        kept = part.stop - part.start
        _enough(f"{name}, between two gaps,", kept)
        notes = (f"of {len(track)} frames with gaps the longest stretch without, {kept}, is used",)
    path = (track.x[part] + 1j * track.y[part]) * length
    return Cell(name, usual * time, path, None, 0.0, model, notes)


def _units(name: str, length: str, time: str) -> tuple[float, float, bool]:
    """Return µm and s per unit of a file, and whether it is in the model's units."""
    if (length, time) == _OF_THE_MODEL:
        return 1.0, 1.0, True
    size, span = _MICROMETRES.get(length_unit(length)), _SECONDS.get(time_unit(time))
    if size is None or span is None:
        told = [
            f"{what} {'in ' + repr(unit) if unit else 'without a unit'}"
            for what, unit, known in (("lengths", length, size), ("times", time, span))
            if known is None
        ]
        raise InputError(
            f"{name} has {' and '.join(told)}: give the pixel size and the frame interval with "
            "their units, as '0.65 um' and '10 s'"
        )
    return size, span, False


def _enough(name: str, frames: int) -> None:
    if frames < FEWEST_FRAMES:
        raise InputError(
            f"{name} has {frames} frame{'s' if frames != 1 else ''}: at least {FEWEST_FRAMES} are "
            "needed to fit"
        )


def _even(name: str, t: np.ndarray) -> float:
    steps = np.diff(t)
    usual = float(np.median(steps))
    if np.abs(steps - usual).max() > _UNEVEN * usual:
        raise InputError(
            f"{name} has frames {steps.min():g} to {steps.max():g} apart: they must be evenly "
            "spaced in time"
        )
    return usual


def micrometres(pixel_size: Any) -> float | None:
    """Return the size of a pixel as readers take it, such as "0.65 um", in µm."""
    if pixel_size is None:
        return None
    reading = Reading.of(pixel_size=pixel_size)
    if reading.pixel_size is None:
        return None
    return reading.pixel_size * _MICROMETRES.get(reading.length_units, 1.0)
