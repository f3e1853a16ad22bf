"""`movie`: a run as a film."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked, file_path
from cellcrawl.errors import InputError, StorageError
from cellcrawl.movies.notebook import MovieFile
from cellcrawl.movies.scene import Scene
from cellcrawl.movies.timing import frame_records, gif_times
from cellcrawl.movies.writers import encoder, write_gif, write_mp4
from cellcrawl.observables.inputs import edge_field
from cellcrawl.plot.inputs import drawable
from cellcrawl.plot.scales import Limits
from cellcrawl.validation import one_of, real_number, shown, whole_number

VIEWS = ("follow", "path")
_USUAL_SIZE = {".mp4": (960, 720), ".gif": (480, 360)}
_SMALLEST, _LARGEST = 64, 4096


@checked
def movie(
    dataset: xr.Dataset,
    path: str | Path,
    *,
    fps: float = 25.0,
    seconds: float | None = None,
    every: float | None = None,
    view: str = "follow",
    field: str = "bound_fraction",
    limits: Limits | None = None,
    colormap: str | None = None,
    size: tuple[int, int] | None = None,
    progress: bool = False,
) -> MovieFile:
    """Film a run: the cell coloured by a field, the track of its centroid, the time.

    Parameters
    ----------
    dataset : Dataset
        A run.
    path : str or Path
        ``cell.mp4`` (H.264) or ``cell.gif``. Written under another name beside it and renamed
        when complete; a file that is there is replaced.
    fps : float
        Frames a second, from 0.1 to 120. A GIF counts in hundredths of a second and shows no frame
        for less than two: there frames last longer and shorter in turn, and at more than 50 a
        second some are left out, so that the movie takes as long as it should.
    seconds : float, optional
        Length of the movie.
    every : float, optional
        Time of the model between frames, instead of ``seconds``. Given neither, about ten seconds,
        or one frame a record for a short run.
    view : {"follow", "path"}
        The camera stays with the cell over a grid on the substrate, or shows the whole path.
    field : str
        The field on the edge that colours it.
    limits : (float, float), optional
        Ends of the colour scale; the field's own unless given.
    colormap : str, optional
        A colour map of matplotlib's; the field's own unless given.
    size : (int, int), optional
        Width and height in pixels, even for MP4; (960, 720), for GIF (480, 360), unless given.
    progress : bool
        Show a progress bar.

    Returns
    -------
    Path
        Where the movie is; in a notebook it appears.

    Raises
    ------
    InputError
        For a value that cannot be used; nothing has been written then.
    StorageError
        If the movie cannot be written.
    MissingExtraError
        If there is no ffmpeg for an MP4.

    Notes
    -----
    Every frame shows a saved record; nothing is interpolated. Ctrl-C ends the encoder and removes
    the unfinished file.
    """
    run = drawable(dataset)
    target = _target(path)
    suffix = target.suffix.lower()
    one_of("movie view", view, VIEWS)
    edge_field(field)
    rate = real_number("movie fps", fps, 0.1, 120.0)
    pixels = _pixels(_USUAL_SIZE[suffix] if size is None else size, even=suffix == ".mp4")
    records = frame_records(run["time"].values, rate, seconds, every)
    if suffix == ".mp4":
        encoder()
    else:
        shown, durations = gif_times(records.size, rate)
        records = records[shown]
    scene = Scene(run, records, field, limits, view, pixels, colormap)
    with _renamed_when_complete(target) as unfinished:
        frames = _frames(scene, records.size, progress)
        if suffix == ".mp4":
            write_mp4(unfinished, frames, pixels, rate)
        else:
            write_gif(unfinished, frames, durations)
    return MovieFile(target)


def _frames(scene: Scene, count: int, progress: bool) -> Iterator[np.ndarray]:
    from tqdm.auto import tqdm

    for frame in tqdm(range(count), desc="movie", unit="frame", disable=not progress):
        yield scene.draw(frame)


def _target(path: Any) -> Path:
    target = file_path("a movie's path", path)
    if target.suffix.lower() not in _USUAL_SIZE:
        raise InputError(f"{shown(str(target))}: a movie ends in .mp4 or .gif")
    if target.is_dir():
        raise InputError(f"{target} is a folder: give the name of a file in it")
    if not target.parent.is_dir():
        raise StorageError(
            f"the folder {target.parent} does not exist: make it, or write elsewhere"
        )
    return target


def _pixels(size: Any, *, even: bool) -> tuple[int, int]:
    if not isinstance(size, (tuple, list)) or len(size) != 2:
        raise InputError("movie size must be two whole numbers, (width, height) in pixels")
    width, height = (whole_number("movie size", side, _SMALLEST, _LARGEST) for side in size)
    if even and (width % 2 or height % 2):
        raise InputError(f"movie size = ({width}, {height}): an MP4 needs even width and height")
    return width, height


@contextmanager
def _renamed_when_complete(target: Path) -> Iterator[Path]:
    """Give a name beside ``target``; it becomes ``target`` at the end, or is removed."""
    unfinished = target.with_name(f".{target.stem}.{os.getpid()}.part{target.suffix}")
    try:
        try:
            unfinished.touch()
            yield unfinished
            unfinished.replace(target)
        except StorageError:
            raise
        except OSError as error:
            reason = error.strerror or str(error)
            raise StorageError(f"the movie {target} cannot be written: {reason}") from None
    finally:
        with suppress(OSError):  # where nothing can be written, nothing was
            unfinished.unlink(missing_ok=True)
