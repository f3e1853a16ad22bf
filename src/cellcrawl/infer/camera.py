"""What a camera adds to the films of a bank: errors of position, and pixels."""

from __future__ import annotations

from typing import Final

import numpy as np

from cellcrawl.infer import films

_PER_PIXEL: Final = 2.0  # points of the edge
_FEWEST, _MOST = 64, 1024
_TOGETHER: Final = 8
_SEAM: Final = 16  # points within which an outline surely has a corner
_ROUNDS: Final = 2
LEAST_ERROR: Final = 1e-5
"""Of the position in each frame along each axis, in R_0; ten times the rounding in a bank."""
LEAST_WAVE: Final = 1e-4
"""Of the real and imaginary part of each wave of the outline, likewise."""


def least(
    path: np.ndarray, modes: np.ndarray | None, random: np.random.Generator
) -> tuple[np.ndarray, np.ndarray | None]:
    """Return films in R_0 with the errors that the best of microscopes has.

    Films of a bank are rounded and a run is not: without these errors, which cover the rounding, a
    cell that glides steadily would look otherwise as a run than it does in the bank.
    """
    path = path + LEAST_ERROR * _normal(path.shape, random)
    return path, None if modes is None else modes + LEAST_WAVE * _normal(modes.shape, random)


def _normal(shape: tuple[int, ...], random: np.random.Generator) -> np.ndarray:
    parts = random.standard_normal((*shape, 2))
    return np.asarray(parts[..., 0] + 1j * parts[..., 1])


def seen(
    path: np.ndarray,
    modes: np.ndarray | None,
    pixel: np.ndarray,
    error: np.ndarray,
    random: np.random.Generator,
) -> tuple[np.ndarray, np.ndarray | None]:
    """Return films as a camera sees them.

    Parameters
    ----------
    path : ndarray of complex, shape (film, frame)
        Centroid.
    modes : ndarray of complex, shape (film, frame, wave), or None
        Outline about it; see `films.modes_of_edge`.
    pixel, error : ndarray, shape (film,)
        Size of a pixel, and standard deviation of the position in a frame; 0 for none. A track
        alone shows no pixels.
    random : Generator

    Notes
    -----
    The outline of a label image has a corner wherever the edge crosses a line between the centres
    of two pixels beside each other, halfway between the two. So has this one: the corners are those
    of `observe`, to which `tests/infer` holds it, without any image. The grid stands still while
    the cell moves, so that errors last as long as they do in a film.
    """
    shift = random.standard_normal((2, *path.shape)) * error[:, None]
    path = path + shift[0] + 1j * shift[1]
    # The grid lies anywhere between two pixels.
    aside = random.random(len(path)) + 1j * random.random(len(path))
    if modes is None or not (pixel > 0.0).any():
        return path, modes
    perimeter = 2.0 * np.pi * np.sqrt((films.WAVES**2 * np.abs(modes) ** 2).sum(axis=-1))
    wanted = _PER_PIXEL * float(np.median(perimeter.max(axis=1) / pixel))
    points = int(np.clip(2.0 ** np.ceil(np.log2(wanted)), _FEWEST, _MOST))
    films_ = np.empty_like(path), np.empty_like(modes)
    for first in range(0, len(path), _TOGETHER):  # few enough for the processor's cache
        part = slice(first, first + _TOGETHER)
        films_[0][part], films_[1][part] = _in_pixels(
            path[part], modes[part], pixel[part, None, None], aside[part, None, None], points
        )
    return films_


def _in_pixels(
    path: np.ndarray, modes: np.ndarray, pixel: np.ndarray, aside: np.ndarray, points: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return the films of what a camera shows, with at least a point a pixel of the edge."""
    origin = path[..., None]
    at = (_with_corners(modes, points) + origin) / pixel + aside
    shape = at.shape
    traced = _traced(at.reshape(-1, points)).reshape(shape)
    edge = (traced - aside) * pixel - origin
    centre = _centroid(edge)
    even = films.equal_arclength(films.evenly(edge - centre[..., None], points))
    return path + centre, films.modes_of_edge(even.real, even.imag)


def _with_corners(modes: np.ndarray, points: int) -> np.ndarray:
    """Return the outlines of modes with the corners that too few waves have rounded.

    The waves that a bank keeps are those of points evenly spaced. Without the waves beyond, they
    are not evenly spaced: spaced anew, they show such waves again, to which those kept belong.
    """
    edge = films.edge_of_modes(modes, points)
    for _ in range(_ROUNDS):
        spectrum = np.fft.fft(films.evenly(edge, points), axis=-1)
        spectrum[..., films.WAVES] = points * modes
        edge = np.fft.ifft(spectrum, axis=-1)
    return np.asarray(edge)


def _traced(at: np.ndarray) -> np.ndarray:
    """Return as many points along the outlines that label images show, in pixels.

    Parameters
    ----------
    at : ndarray of complex, shape (outline, point)
        The edge in pixels, whose centres are at whole numbers; no side as long as a pixel.
    """
    count, points = at.shape
    after = np.roll(at, -1, axis=1)
    place = np.full((count, points, 2), np.inf)
    corner = np.empty((count, points, 2), complex)
    for axis, (one, other, across, along) in enumerate(
        ((at.real, after.real, at.imag, after.imag), (at.imag, after.imag, at.real, after.real))
    ):
        line = np.floor(np.maximum(one, other))  # the last line below the upper end
        crossed = line > np.minimum(one, other)
        part = (line - one) / np.where(crossed, other - one, 1.0)
        middle = np.floor(across + part * (along - across)) + 0.5
        corner[..., axis] = line + 1j * middle if axis == 0 else middle + 1j * line
        place[..., axis] = np.where(crossed, part, np.inf)
    swapped = place[..., 0] > place[..., 1]
    place[swapped] = place[swapped][:, ::-1]
    corner[swapped] = corner[swapped][:, ::-1]
    # Each outline one turn long, the next three turns on, and a little of it on either side.
    turn = np.arange(points)[:, None] / points
    begin = 3.0 * np.arange(count)[:, None, None]
    known = begin + turn + place / points
    seam = min(_SEAM, points)
    known = np.concatenate([known[:, -seam:] - 1.0, known, known[:, :seam] + 1.0], axis=1)
    corner = np.concatenate([corner[:, -seam:], corner, corner[:, :seam]], axis=1)
    there = np.isfinite(known)
    return np.asarray(np.interp((begin + turn)[..., 0], known[there], corner[there]))


def _centroid(edge: np.ndarray) -> np.ndarray:
    """Return the centroid of the area of polygons."""
    after = np.roll(edge, -1, axis=-1)
    cross = (np.conj(edge) * after).imag
    return np.asarray(((edge + after) * cross).sum(axis=-1) / (3.0 * cross.sum(axis=-1)))
