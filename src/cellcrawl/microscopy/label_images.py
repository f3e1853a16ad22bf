"""Outlines from label images: every cell its own number, the background 0."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.microscopy.options import Reading
from cellcrawl.microscopy.outlines import Outline, Outlines
from cellcrawl.microscopy.source import LeftOut, Source

FEWEST_PIXELS: Final = 4
_JUMP = 2.0  # centroids further apart than this many square roots of the area are two cells
_MOST_LABELS = 0.2  # distinct values over pixels at which an image is a photograph


@dataclass(frozen=True)
class Piece:
    """A cell in a label image: its outline in pixels, and what was done to get it."""

    label: int
    xy: np.ndarray
    pixels: int
    changes: tuple[str, ...]


def outlines_of_labels(
    frames: Sequence[np.ndarray], source: Source, reading: Reading, first_frame: int = 0
) -> Outlines:
    """Return the outlines of all labels in a series of images.

    Parameters
    ----------
    frames : sequence of ndarray of int, shape (height, width)
        One image a frame. The centre of the pixel in row j and column i is at (i, j).
    source : Source
        Where they are from, in pixels.
    reading : Reading
        Pixel size and frame interval.

    Notes
    -----
    The outline passes halfway between the centres of pixels inside and outside, so that it is
    smooth to half a pixel. It encloses half a pixel less than the pixels counted. Of a cell in
    several pieces the largest counts; holes are filled; both is told in ``changes``.
    """
    numbers = first_frame + np.arange(len(frames))
    source, times = reading.timed(source, numbers)
    source, _, _ = reading.scaled(source, np.empty(0), np.empty(0))
    size = reading.pixel_size or 1.0
    found: list[Outline] = []
    left_out: list[LeftOut] = []
    for frame, t, image in zip(numbers, times, frames, strict=True):
        _must_be_labels(image, source.path)
        for piece in pieces(image):
            if piece.pixels < FEWEST_PIXELS:
                told = f"{piece.label} in frame {frame}"
                left_out.append(LeftOut(told, f"fewer than {FEWEST_PIXELS} pixels", piece.pixels))
                continue
            found.append(
                Outline(
                    size * piece.xy,
                    str(piece.label),
                    int(frame),
                    float(t),
                    source.length_units,
                    source.time_units,
                    source.y_down,
                    piece.changes,
                    source,
                )
            )
    if not found:
        raise InputError(f"{source.path} has no labelled cells: all its pixels are 0")
    found, notes = linked_or_apart(found)
    source = replace(source, notes=(*source.notes, *notes))
    return Outlines([replace(one, source=source) for one in found], source, tuple(left_out))


def linked_or_apart(outlines: Sequence[Outline]) -> tuple[list[Outline], list[str]]:
    """Return outlines by track and frame, and what to say of their numbers.

    A number that stays with a cell from frame to frame is its track. Where numbers are given anew
    in every frame, as a segmentation without tracking does, most of them jump by more than a cell's
    size: then no two frames are linked, and each outline is a track of its own.
    """
    ordered = sorted(outlines, key=lambda outline: (int(outline.track), outline.frame))
    jumps = [
        float(np.hypot(*(after.centroid - before.centroid)))
        > _JUMP * math.sqrt(max(before.area, after.area))
        for before, after in pairwise(ordered)
        if before.track == after.track and after.frame == before.frame + 1
    ]
    if jumps and sum(jumps) > 0.5 * len(jumps):
        apart = [replace(one, track=f"{one.frame}/{one.track}") for one in ordered]
        note = "the numbers of cells start anew in every frame: no cells are linked over time"
        return apart, [note]
    over_time = len({one.frame for one in ordered}) > 1
    several = len({one.track for one in ordered}) > 1
    return ordered, ["a number is one cell in all frames"] if over_time and several else []


def pieces(image: np.ndarray) -> Iterator[Piece]:
    """Yield the largest piece of every label of an image."""
    height, width = image.shape
    for label, rows, columns in _boxes(image):
        mask = image[rows, columns] == label
        rings = _rings(mask)
        sizes = [_ring_area(ring) for ring in rings]
        largest = int(np.argmax(sizes))
        changes = []
        outer = sum(size > 0 for size in sizes)
        if outer > 1:
            pixels = int(mask.sum())
            share = 100.0 * (1.0 - sizes[largest] / max(pixels, 1))
            changes.append(f"largest of {outer} pieces ({max(share, 0.0):.0f} % of pixels dropped)")
        holes = outer < len(sizes)
        if holes:
            changes.append("holes filled")
        if rows.start == 0 or columns.start == 0 or rows.stop == height or columns.stop == width:
            changes.append("cut by the edge of the image")
        ring = rings[largest]
        # Corners of pixels lie at half numbers: the middle of each side lies between two centres.
        middles = 0.5 * (ring + np.roll(ring, -1, axis=0)) - 0.5
        xy = _without_straight(middles) + np.array([columns.start, rows.start])
        yield Piece(int(label), xy, int(sizes[largest]), tuple(changes))


def _must_be_labels(image: np.ndarray, path: str) -> None:
    if image.ndim != 2:
        raise InputError(f"{path}: a frame has shape {image.shape}, not rows and columns")
    whole = image.dtype.kind in "iub" or bool(np.all(image == np.round(image)))
    if not whole or len(np.unique(image)) > max(256, _MOST_LABELS * image.size):
        raise InputError(
            f"{path} is a picture, not a label image: give the masks of its segmentation"
        )


def _boxes(image: np.ndarray) -> Iterator[tuple[int, slice, slice]]:
    """Yield each label with the rows and columns that hold it."""
    rows, columns = np.nonzero(image)
    values = image[rows, columns]
    order = np.argsort(values, kind="stable")
    labels, first = np.unique(values[order], return_index=True)
    if not labels.size:
        return
    ends = [
        extreme.reduceat(side[order], first)
        for side in (rows, columns)
        for extreme in (np.minimum, np.maximum)
    ]
    for label, top, bottom, left, right in zip(labels, *ends, strict=True):
        if label > 0:
            yield int(label), slice(int(top), int(bottom) + 1), slice(int(left), int(right) + 1)


def _rings(mask: np.ndarray) -> list[np.ndarray]:
    """Return the closed paths along the sides of pixels, inside kept on the same hand.

    Outer paths have a positive area, holes a negative one. Pixels that touch at a corner only are
    not connected. Points are corners of pixels (column, row), whole numbers.
    """
    padded = np.pad(mask, 1)
    inside = padded[1:-1, 1:-1]
    starts, ends = [], []
    # Each side of a pixel whose neighbour is outside, run through with the inside on one hand.
    for neighbour, (a, b) in (
        (padded[:-2, 1:-1], ((0, 0), (1, 0))),  # above: to the right
        (padded[1:-1, 2:], ((1, 0), (1, 1))),  # right: down
        (padded[2:, 1:-1], ((1, 1), (0, 1))),  # below: to the left
        (padded[1:-1, :-2], ((0, 1), (0, 0))),  # left: up
    ):
        rows, columns = np.nonzero(inside & ~neighbour)
        starts.append(np.column_stack([columns + a[0], rows + a[1]]))
        ends.append(np.column_stack([columns + b[0], rows + b[1]]))
    start, end = np.concatenate(starts), np.concatenate(ends)
    leaving: dict[tuple[int, int], list[int]] = {}
    for number, (i, j) in enumerate(start.tolist()):
        leaving.setdefault((i, j), []).append(number)
    unused = np.ones(len(start), bool)
    ending, beginning = end.tolist(), start.tolist()
    rings = []
    for first in range(len(start)):
        if not unused[first]:
            continue
        path, at = [], first
        while unused[at]:
            unused[at] = False
            path.append(beginning[at])
            choices = [n for n in leaving[tuple(ending[at])] if unused[n]]
            if not choices:
                break
            if len(choices) > 1:  # at a corner that two pixels share: stay with the same pixel
                along = (ending[at][0] - beginning[at][0], ending[at][1] - beginning[at][1])
                turn = (-along[1], along[0])
                choices.sort(
                    key=lambda n: (
                        (
                            ending[n][0] - beginning[n][0],
                            ending[n][1] - beginning[n][1],
                        )
                        != turn
                    )
                )
            at = choices[0]
        rings.append(np.array(path, float))
    return rings


def _ring_area(ring: np.ndarray) -> float:
    x, y = ring.T
    return float(0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def _without_straight(xy: np.ndarray) -> np.ndarray:
    """Return the polygon without points in the middle of straight runs."""
    before, after = xy - np.roll(xy, 1, axis=0), np.roll(xy, -1, axis=0) - xy
    bends = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0] != 0.0
    return xy[bends] if bends.sum() >= 3 else xy
