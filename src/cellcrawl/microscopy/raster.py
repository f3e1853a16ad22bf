"""Polygons drawn on a grid of pixels, and back."""

from __future__ import annotations

import numpy as np


def rasterised(xy: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
    """Return the pixels whose centre a polygon encloses, by the even-odd rule.

    Parameters
    ----------
    xy : ndarray, shape (points, 2)
        Vertices in pixels; the centre of the pixel in row j and column i is at (i, j).
    shape : tuple of int
        Rows and columns.

    Returns
    -------
    ndarray of bool, shape (rows, columns)
        What is walked there and back, such as a fibre without width, encloses nothing.
    """
    rows, columns = shape
    toggles = np.zeros((rows, columns + 1), np.int32)
    ax, ay = xy.T
    bx, by = np.roll(xy, -1, axis=0).T
    low, high = np.minimum(ay, by), np.maximum(ay, by)
    first = np.clip(np.ceil(low), 0, rows).astype(np.int64)
    last = np.clip(np.ceil(high), 0, rows).astype(np.int64)  # rows j with low <= j < high
    counts = np.maximum(last - first, 0)
    edge = np.repeat(np.arange(len(xy)), counts)
    row = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts) + first[edge]
    height = by[edge] - ay[edge]
    crossing = ax[edge] + (row - ay[edge]) / height * (bx[edge] - ax[edge])
    column = np.clip(np.ceil(crossing), 0, columns).astype(np.int64)
    np.add.at(toggles, (row, column), 1)
    return np.asarray(np.cumsum(toggles, axis=1)[:, :-1] % 2 == 1)


def opened(mask: np.ndarray, radius: float) -> np.ndarray:
    """Return a mask without what a disk of this radius, in pixels, does not fit into."""
    outside = np.pad(~mask, int(np.ceil(radius)) + 1, constant_values=True)
    eroded = ~widened(outside, radius)
    reach = int(np.ceil(radius)) + 1
    return np.asarray(widened(eroded, radius)[reach:-reach, reach:-reach] & mask)


def widened(mask: np.ndarray, radius: float) -> np.ndarray:
    """Return the pixels within this distance, in pixels, of those of a mask."""
    reach = int(np.ceil(radius)) + 1
    padded = np.pad(mask, reach).astype(float)
    j, i = np.mgrid[-reach : reach + 1, -reach : reach + 1]
    disk = np.zeros(padded.shape)
    disk[: 2 * reach + 1, : 2 * reach + 1] = np.hypot(i, j) <= radius
    disk = np.roll(disk, (-reach, -reach), axis=(0, 1))
    covered = np.fft.irfft2(np.fft.rfft2(padded) * np.fft.rfft2(disk), s=padded.shape)
    return np.asarray(covered[reach:-reach, reach:-reach] > 0.5)
