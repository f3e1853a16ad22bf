"""Whether answers with confidence p are right in p of the cases, and the fit that makes them so."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from cellcrawl.modes import classify_track
from cellcrawl.modes.calibrate import Answers, answers, fit
from cellcrawl.modes.confidence import FILE
from cellcrawl.modes.mixture import FEWEST, MOST, mixture
from cellcrawl.plot.style import INK, PAGE, RIM, TRACK, paper_figure

SEED: Final = 2024
"""Of the tracks that the confidence is fitted to; it is checked on others."""
_CHECK_SEED: Final = 7
_TRACKS: Final = 30_000
_PART: Final = 500
LENGTHS: Final = ((12, 24), (25, 60), (61, 200), (201, 1000))
"""Numbers of records that are looked at apart."""
_EDGES: Final = np.linspace(0.0, 1.0, 11)


class Reliability(NamedTuple):
    """Answers of like confidence: how many, what was said of them, and how many were right."""

    records: str
    answers: int
    confidence: float
    right: float


def calibrate(tracks: int = _TRACKS, seed: int = SEED, workers: int = 2) -> Path:
    """Fit the confidence to a mixture of known tracks and store it beside the classifier."""
    parts = [(seed, first // _PART) for first in range(0, tracks, _PART)]
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        found = list(pool.map(_answers, parts))
    known = Answers(
        *(np.concatenate([getattr(part, name) for part in found]) for name in Answers._fields)
    )
    kept = {"seed": seed, "tracks": tracks, "records": [FEWEST, MOST], **fit(known)}
    import cellcrawl.modes

    target = Path(cellcrawl.modes.__file__).with_name(FILE)
    target.write_text(json.dumps(kept, separators=(",", ":")) + "\n", encoding="utf-8")
    return target


def _answers(part: tuple[int, int]) -> Answers:
    seed, number = part
    return answers(mixture(_PART, seed * 10_000 + number))


def measure(quick: bool = False) -> tuple[list[Reliability], list[Reliability]]:
    """Name tracks of other seeds than those of the fit: by confidence, and by length too."""
    said, right, sizes = _named(600 if quick else 8000)
    together = list(_rows("all", said, right))
    apart = []
    for low, high in LENGTHS:
        inside = (sizes >= low) & (sizes <= high)
        apart += list(_rows(f"{low} to {high}", said[inside], right[inside]))
    return together, apart


def _named(count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rows = []
    for track in mixture(count, _CHECK_SEED):
        found = classify_track(track.t, track.x, track.y)
        rows.append((found.confidence, found.mode == track.mode, track.t.size))
    said, right, sizes = np.array(rows, dtype=float).T
    return said, right > 0.5, sizes


def _rows(records: str, said: np.ndarray, right: np.ndarray) -> Iterator[Reliability]:
    place = np.clip(np.searchsorted(_EDGES, said, side="right") - 1, 0, _EDGES.size - 2)
    for number in range(_EDGES.size - 1):
        inside = place == number
        if inside.any():
            yield Reliability(
                records,
                int(inside.sum()),
                float(said[inside].mean()),
                float(right[inside].mean()),
            )


def largest_gap(rows: Iterable[Reliability]) -> float:
    """Return by how much confidence and truth differ, over the bins of 10 answers or more.

    What chance alone makes of it, two standard errors, is taken off.
    """
    gaps = [0.0]
    for row in rows:
        error = 2.0 * np.sqrt(max(row.confidence * (1.0 - row.confidence), 1e-4) / row.answers)
        if row.answers >= 10:
            gaps.append(abs(row.right - row.confidence) - float(error))
    return max(gaps)


def plot(together: list[Reliability], apart: list[Reliability]) -> Figure:
    """Draw how often answers are right against their confidence."""
    with paper_figure(PAGE, 2.9) as figure:
        left, right = figure.subplots(1, 2)
        for axes in (left, right):
            axes.plot([0, 1], [0, 1], color=RIM, linewidth=0.8)
            axes.fill_between([0, 1], [-0.05, 0.95], [0.05, 1.05], color=RIM, alpha=0.2, lw=0)
            axes.set(xlim=(0, 1), ylim=(0, 1), xlabel="confidence", aspect="equal")
        left.set_ylabel("part of the answers that is right")
        _draw(left, together, TRACK, "all")
        left.set_title(f"{sum(row.answers for row in together)} tracks, 12 to 1000 records")
        colours = ("#0072b2", "#009e73", "#d55e00", INK)
        for (low, high), colour in zip(LENGTHS, colours, strict=True):
            name = f"{low} to {high}"
            _draw(right, [row for row in apart if row.records == name], colour, name)
        right.legend(title="records", frameon=False, loc="upper left")
        right.set_title("by the length of the track")
    return figure


def _draw(axes: Any, rows: list[Reliability], colour: str, label: str) -> None:
    shown = [row for row in rows if row.answers >= 10]
    x, y = (np.array([getattr(row, name) for row in shown]) for name in ("confidence", "right"))
    count = np.array([row.answers for row in shown])
    error = np.sqrt(np.maximum(x * (1.0 - x), 1e-4) / count)
    axes.errorbar(x, y, error, color=colour, fmt="o-", markersize=3, linewidth=0.8, label=label)
