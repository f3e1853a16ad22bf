"""What comes back of a run, and of a shape, that was seen through a microscope."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
import xarray as xr

from cellcrawl.microscopy import observe, read_outlines
from cellcrawl.microscopy.label_images import pieces
from cellcrawl.microscopy.raster import rasterised
from cellcrawl.modes import Classification, classify, classify_track
from cellcrawl.observables import circularity, edge_series, persistent_walk, speed
from cellcrawl.parameters import Parameters
from cellcrawl.parameters.paper_cells import PAPER_MODES
from cellcrawl.simulation import simulate
from cellcrawl.starts import RandomPerturbation

PIXEL: Final = 0.1
"""Size of a pixel, in cell radii."""
ERROR: Final = 0.05
"""Error of the position in each frame, in cell radii."""
FRAME: Final = 0.5
"""Time between frames, in 1/k_off0."""
_T_END = 100.0
_PLACES = 24  # in which a shape lies on the grid of pixels
_SIZES, _ASPECTS = (20, 30, 40, 60, 80), (1.0, 1.5, 2.0)


class Seen(NamedTuple):
    """A named cell: what the run is, and what the film of it shows, after the transient.

    Speeds are root mean squares; that of the film is `persistent_walk`'s, with its interval of 95
    percent. Circularities are medians.
    """

    point: str
    mode: str
    mode_seen: str
    speed: float
    speed_seen: float
    speed_low: float
    speed_high: float
    circularity: float
    circularity_seen: float
    period: float
    period_seen: float


class Shape(NamedTuple):
    """Errors of an ellipse on a grid of pixels, in percent: the worst of all places and turns.

    ``size`` is the diameter of the circle of the same area, in pixels; ``near`` the part of the
    places where the area is right to 0.5 percent. The curvature's is its root mean square.
    """

    size: int
    aspect: float
    area: float
    near: float
    length: float
    curvature: float


def measure_cells(quick: bool = False, seed: int = 1) -> Iterator[Seen]:
    """Film the nine named cells, write label TIFFs, read them and measure."""
    for point in list(PAPER_MODES)[:: 4 if quick else 1]:
        yield see(point, seed)


def see(point: tuple[int, int], seed: int = 1) -> Seen:
    """Film one cell, write a label TIFF, read it and measure both."""
    run = simulate(
        Parameters(r_on=point[0], zeta_1=point[1]),
        t_end=_T_END,
        save_every=0.1,
        nodes=128,
        start=RandomPerturbation(seed=seed),
    )
    with tempfile.TemporaryDirectory() as folder:
        film = observe(run, pixel=PIXEL, error=ERROR, frame=FRAME, seed=seed)
        outlines = read_outlines(film.write(Path(folder) / "run.tif"))
    edge = edge_series(outlines)
    track = outlines.tracks[0]
    radius = math.sqrt(float(np.median(edge["area"])) / math.pi)
    found = classify(run)
    back = classify_track(track.t, track.x, track.y, cell_radius=radius)
    after = track.t >= found.measures.start
    walk = persistent_walk(track.t[after], track.x[after], track.y[after])
    moved = speed(run).sel(time=slice(found.measures.start, None))
    return Seen(
        f"({point[0]}, {point[1]})",
        found.mode,
        back.mode,
        math.sqrt(float((moved**2).mean())),
        walk.speed.value,
        walk.speed.low,
        walk.speed.high,
        _median(circularity(run), found),
        _median(circularity(edge), back),
        _period(found),
        _period(back),
    )


def _median(values: xr.DataArray, found: Classification) -> float:
    """Return the median after the transient."""
    return float(values.sel(time=slice(found.measures.start, None)).median())


def _period(found: Classification) -> float:
    return found.measures.period if found.mode in ("rotational", "zigzag") else math.nan


def measure_shapes(quick: bool = False) -> Iterator[Shape]:
    """Draw circles and ellipses on a grid of pixels, and measure their outlines."""
    for size in _SIZES[2:3] if quick else _SIZES:
        for aspect in _ASPECTS:
            yield _shape(size, aspect, 6 if quick else _PLACES)


def _shape(size: int, aspect: float, places: int) -> Shape:
    random = np.random.default_rng(size)
    a, b = 0.5 * size * math.sqrt(aspect), 0.5 * size / math.sqrt(aspect)
    around = np.linspace(0.0, 2.0 * math.pi, 4001)
    ring = a * np.cos(around) + 1j * b * np.sin(around)
    missed = []
    for _ in range(places):
        turn = np.exp(1j * random.uniform(0.0, math.pi))
        wide = int(2.0 * a) + 8
        middle = complex(*(0.5 * wide + random.uniform(0.0, 1.0, 2)))
        place = middle + turn * ring[:-1]
        image = rasterised(np.column_stack([place.real, place.imag]), (wide, wide)).astype(int)
        found = edge_series([piece.xy for piece in pieces(image)]).isel(time=0)
        at = ((found["x"] + 1j * found["y"]).values - middle) / turn
        angle = np.arctan2(at.imag / b, at.real / a)
        right = a * b / ((a * np.sin(angle)) ** 2 + (b * np.cos(angle)) ** 2) ** 1.5
        off = found["curvature"].values - right
        missed.append(
            (
                float(found["area"]) / (math.pi * a * b) - 1.0,
                float(found["length"]) / float(np.abs(np.diff(ring)).sum()) - 1.0,
                math.sqrt(float(np.mean(off**2))) / float(right.mean()),
            )
        )
    area, length, bend = np.abs(missed).T
    near = float(np.mean(area <= 0.005))
    worst: tuple[Any, ...] = tuple(100.0 * float(part.max()) for part in (area, length, bend))
    return Shape(size, aspect, worst[0], near, worst[1], worst[2])
