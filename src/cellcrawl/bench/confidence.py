"""Whether answers with confidence p are right in p of the cases, and the fit that makes them so."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from cellcrawl.modes import classify_track
from cellcrawl.modes.calibrate import LENGTHS, Answers, answers, fit
from cellcrawl.modes.confidence import FILE
from cellcrawl.modes.mixture import FEWEST, MOST, mixture
from cellcrawl.plot.style import INK, PAGE, RIM, TRACK, paper_figure
from cellcrawl.sweeps.pool import WorkerPool

SEED: Final = 2024
"""Of the tracks that the confidence is fitted to; it is checked on others."""
_CHECK_SEED: Final = 7
_TRACKS: Final = 40_000
_PART: Final = 500
_QUANTILE: Final = 1.96
WITHIN: Final = 0.05
"""By how much confidence and truth may differ."""
_EDGES: Final = np.linspace(0.0, 1.0, 11)


class Reliability(NamedTuple):
    """Answers of like confidence: how many, what was said of them, and how many were right.

    ``low`` and ``high`` are the interval of 95 percent around the part that is right (Wilson).
    """

    records: str
    answers: int
    confidence: float
    right: float
    low: float
    high: float

    @property
    def gap(self) -> float:
        """Part that is right less confidence."""
        return self.right - self.confidence

    @property
    def can_be_told(self) -> bool:
        """Whether there are answers enough to tell a gap of `WITHIN`."""
        return self.high - self.low <= 2.0 * WITHIN

    @property
    def agrees(self) -> bool:
        """Whether the interval reaches to within `WITHIN` of the confidence."""
        return self.low - WITHIN <= self.confidence <= self.high + WITHIN


def calibrate(tracks: int = _TRACKS, seed: int = SEED, workers: int = 2) -> Path:
    """Fit the confidence to a mixture of known tracks and store it beside the classifier."""
    found = _in_parts(_answers, seed, tracks, workers)
    known = Answers(
        *(np.concatenate([getattr(part, name) for part in found]) for name in Answers._fields)
    )
    kept = {"seed": seed, "tracks": tracks, "records": [FEWEST, MOST], **fit(known)}
    import cellcrawl.modes

    target = Path(cellcrawl.modes.__file__).with_name(FILE)
    target.write_text(json.dumps(kept, separators=(",", ":")) + "\n", encoding="utf-8")
    return target


def _in_parts(do: Callable[[tuple[int, int]], Any], seed: int, tracks: int, workers: int) -> Any:
    parts = [(seed, number) for number in range(-(-tracks // _PART))]
    with WorkerPool(workers) as pool:
        return list(pool.map(do, parts))


def _answers(part: tuple[int, int]) -> Answers:
    seed, number = part
    return answers(mixture(_PART, seed * 10_000 + number))


def measure(quick: bool = False, workers: int = 2) -> tuple[list[Reliability], list[Reliability]]:
    """Name tracks of other seeds than those of the fit: by confidence, and by length too."""
    named = _in_parts(_named, _CHECK_SEED, 2 * _PART if quick else _TRACKS, workers)
    said, right, sizes = np.concatenate(named).T
    right = right > 0.5
    together = list(_rows("all", said, right))
    apart = []
    for low, high in LENGTHS:
        inside = (sizes >= low) & (sizes <= high)
        apart += list(_rows(f"{low} to {high}", said[inside], right[inside]))
    return together, apart


def _named(part: tuple[int, int]) -> np.ndarray:
    seed, number = part
    rows = []
    for track in mixture(_PART, seed * 10_000 + number):
        found = classify_track(track.t, track.x, track.y)
        rows.append((found.confidence, found.mode == track.mode, track.t.size))
    return np.array(rows, dtype=float)


def _rows(records: str, said: np.ndarray, right: np.ndarray) -> Iterator[Reliability]:
    place = np.clip(np.searchsorted(_EDGES, said, side="right") - 1, 0, _EDGES.size - 2)
    for number in range(_EDGES.size - 1):
        inside = place == number
        if inside.any():
            count, part = int(inside.sum()), float(right[inside].mean())
            ends = _interval(part, count)
            yield Reliability(records, count, float(said[inside].mean()), part, *ends)


def _interval(part: float, count: int) -> tuple[float, float]:
    """Return the interval of a part of so many (Wilson, J. Am. Stat. Assoc. 22, 209, 1927)."""
    square = _QUANTILE**2 / count
    middle = (part + 0.5 * square) / (1.0 + square)
    half = np.sqrt(part * (1.0 - part) * square + 0.25 * square**2) / (1.0 + square)
    return float(middle - half), float(middle + half)


def largest_gap(rows: Iterable[Reliability]) -> float:
    """Return by how much confidence and truth differ at most, where answers are enough to tell."""
    return max((abs(row.gap) for row in rows if row.can_be_told), default=0.0)


def summary(rows: list[Reliability]) -> str:
    """Say in a line how well the confidence holds."""
    told = [row for row in rows if row.can_be_told]
    good = sum(row.agrees for row in rows)
    return (
        f"largest gap {largest_gap(rows):.3f} in the {len(told)} bins that can tell "
        f"{WITHIN:g}; in {good} of all {len(rows)} bins the interval reaches to within it"
    )


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
    x, y, low, high = np.array([(row.confidence, row.right, row.low, row.high) for row in shown]).T
    ends = np.maximum([y - low, high - y], 0.0)
    axes.errorbar(x, y, ends, color=colour, fmt="o-", markersize=3, linewidth=0.8, label=label)
