"""The microscope: what a camera would have seen of a run."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.microscopy.label_images import outlines_of_labels
from cellcrawl.microscopy.options import Reading
from cellcrawl.microscopy.outlines import Outlines
from cellcrawl.microscopy.raster import rasterised
from cellcrawl.microscopy.source import Source
from cellcrawl.microscopy.track import Tracks
from cellcrawl.validation import real_array, real_number, whole_number

_MARGIN = 3  # pixels around all the cell ever covers
_LARGEST = 2_000_000_000  # pixels of a film


@dataclass(frozen=True, eq=False)
class Observation:
    """A film of one cell as a label image, made by `observe`.

    Attributes
    ----------
    labels : ndarray of uint8, shape (frame, row, column)
        1 where the cell is, 0 elsewhere. Rows run downwards, as in any image.
    t : ndarray, shape (frame,)
        Times of the frames in the run.
    pixel, frame : float
        Size of a pixel and time between frames, in the units of the run.
    origin : tuple of float
        Where the run's x and y are at the centre of the pixel in row 0 and column 0.
    length_units, time_units : str
        Units of the run.
    """

    labels: np.ndarray
    t: np.ndarray
    pixel: float
    frame: float
    origin: tuple[float, float]
    length_units: str = "R_0"
    time_units: str = "1/k_off0"

    @cached_property
    def outlines(self) -> Outlines:
        """The outlines that the images show, as `read_outlines` reads them from a file."""
        source = Source("", "observed run", {}, "pixel", "", True)
        reading = Reading(
            frame_interval=self.frame,
            time_units=self.time_units,
            pixel_size=self.pixel,
            length_units=self.length_units,
        )
        return outlines_of_labels(list(self.labels), source, reading)

    @property
    def tracks(self) -> Tracks:
        """The path of the centroid of what the images show."""
        return self.outlines.tracks

    def write(self, path: str | PathLike[str]) -> Path:
        """Write the film as a label TIFF that knows its pixel size and frame interval."""
        from cellcrawl.microscopy.writing_outlines import write_label_tiff

        target = Path(path)
        write_label_tiff(
            target, self.labels, self.pixel, self.frame, self.length_units, self.time_units
        )
        return target


@checked
def observe(
    run: xr.Dataset,
    *,
    pixel: float = 0.1,
    error: float = 0.0,
    frame: float | None = None,
    edge_error: float = 0.0,
    seed: int = 0,
) -> Observation:
    """Return what a microscope would have seen of a run: a film in pixels, with errors.

    Parameters
    ----------
    run : Dataset
        A run, or anything with ``x`` and ``y`` by time and node.
    pixel : float
        Size of a pixel in the run's unit of length; 0.1 is a tenth of the cell's radius.
    error : float
        Standard deviation, along each axis, of where the cell is seen in a frame.
    frame : float, optional
        Time between frames; that between the run's records unless given. Between records the
        edge is interpolated.
    edge_error : float
        Standard deviation of each point of the edge along its normal, from frame to frame and
        from pixel to pixel along the edge.
    seed : int
        Of the errors.

    Returns
    -------
    Observation
        With ``labels``, ``outlines`` and ``tracks``; ``write`` makes a label TIFF of it.

    Raises
    ------
    InputError
        For a dataset without an edge, or more pixels than fit.

    Notes
    -----
    Images have y downwards: row 0 shows the largest y, so that what turns left in the run is seen
    to turn left on the screen, and positions read from the images have ``y_down``.
    """
    pixel = real_number("pixel", pixel, 0.0, 1e6, open_low=True)
    error = real_number("error", error, 0.0, 1e6)
    edge_error = real_number("edge_error", edge_error, 0.0, 1e6)
    random = np.random.default_rng(whole_number("seed", seed, 0))
    time, x, y = _edge(run)
    if frame is None:
        frame = float(np.median(np.diff(time))) if time.size > 1 else 1.0
    frame = real_number("frame", frame, 0.0, 1e9, open_low=True)
    count = 1 + int((time[-1] - time[0]) / frame + 1e-9)
    t = time[0] + frame * np.arange(count)
    x, y = _at_times(t, time, x), _at_times(t, time, y)
    if edge_error > 0.0:
        x, y = _roughened(x, y, edge_error, pixel, random)
    shift = error * random.standard_normal((2, count, 1))
    x, y = x + shift[0], y + shift[1]
    # The grid of a camera knows nothing of the cell: it lies anywhere between two pixels.
    aside = _MARGIN + random.random(2)
    left, top = float(x.min()) - aside[0] * pixel, float(y.max()) + aside[1] * pixel
    wide, high = ((end - begin) / pixel for begin, end in ((left, x.max()), (y.min(), top)))
    if not count * (high + _MARGIN) * (wide + _MARGIN) <= _LARGEST:
        raise InputError(
            f"{count} frames of {high:.0f} x {wide:.0f} pixels are too many: give a larger pixel "
            "or frame"
        )
    columns, rows = (math.ceil(size) + _MARGIN for size in (wide, high))
    labels = np.zeros((count, rows, columns), np.uint8)
    for number in range(count):
        shape = np.column_stack([(x[number] - left) / pixel, (top - y[number]) / pixel])
        labels[number] = rasterised(shape, (rows, columns))
    return Observation(labels, t, pixel, frame, (left, top))


def _edge(run: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    wanted = ("time", "node")
    if not isinstance(run, xr.Dataset) or any(name not in run for name in ("x", "y", "time")):
        raise InputError("observe needs a run: a Dataset with the edge, x and y by time and node")
    edge = [run[name] for name in ("x", "y")]
    if any(tuple(field.dims) != wanted for field in edge):
        raise InputError(f"the edge must have dimensions (time, node), not {tuple(edge[0].dims)}")
    time = real_array("time", run["time"].values, (None,))
    if not time.size:
        raise InputError("the run has no records to observe")
    x, y = (real_array(name, run[name].values, (time.size, None)) for name in ("x", "y"))
    return time, x, y


def _at_times(t: np.ndarray, time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Interpolate each node in time."""
    if time.size == 1:
        return np.repeat(values, t.size, axis=0)
    after = np.clip(np.searchsorted(time, t, side="right"), 1, time.size - 1)
    part = np.clip((t - time[after - 1]) / (time[after] - time[after - 1]), 0.0, 1.0)[:, None]
    return np.asarray((1.0 - part) * values[after - 1] + part * values[after])


def _roughened(
    x: np.ndarray, y: np.ndarray, edge_error: float, pixel: float, random: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """Shift points along the normal by noise that is independent from pixel to pixel."""
    tangent_x = np.roll(x, -1, axis=1) - np.roll(x, 1, axis=1)
    tangent_y = np.roll(y, -1, axis=1) - np.roll(y, 1, axis=1)
    size = np.maximum(np.hypot(tangent_x, tangent_y), 1e-300)
    noise = random.standard_normal(x.shape)
    length = np.hypot(np.diff(x, axis=1), np.diff(y, axis=1)).sum(axis=1).mean()
    width = pixel / length  # of the outline
    k = np.fft.rfftfreq(x.shape[1], 1.0 / x.shape[1])
    filtered = np.fft.irfft(
        np.fft.rfft(noise, axis=1) * np.exp(-0.5 * (np.pi * width * k) ** 2), x.shape[1], axis=1
    )
    filtered *= edge_error / max(float(filtered.std()), 1e-300)
    return x + filtered * tangent_y / size, y - filtered * tangent_x / size
