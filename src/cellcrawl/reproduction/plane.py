"""The sweep behind Figs. 4 and 7: modes and measures over (r_on, zeta_1)."""

from __future__ import annotations

import math
from collections import Counter
from typing import Any, Final

from cellcrawl.reproduction.cells import LONG
from cellcrawl.reproduction.workspace import Workspace
from cellcrawl.sweeps import Sweep

R_ON: Final = tuple(range(10, 61, 2))
ZETA_1: Final = tuple(range(400, 601, 20))
SEEDS: Final = (1, 2, 3, 4, 5)
MIXED: Final = "mixed"


def swept(workspace: Workspace) -> Sweep:
    """Return the sweep of the paper's 26 by 11 points, five seeds each, made or found."""
    if workspace.quick:
        axes: dict[str, Any] = {"r_on": [16, 26, 36], "zeta_1": [560, 600], "seed": [1, 2]}
        return workspace.sweep("plane-quick", axes, t_end=0.3 * LONG)
    axes = {"r_on": R_ON, "zeta_1": ZETA_1, "seed": SEEDS}
    return workspace.sweep("plane", axes, t_end=LONG)


def verdicts(sweep: Sweep) -> dict[tuple[float, float], tuple[str, Counter[str]]]:
    """Return the mode that the runs of each point agree on, or "mixed", and how many show which.

    Torn cells count only where all are torn.
    """
    counts: dict[tuple[float, float], Counter[str]] = {}
    for row in sweep.table(["r_on", "zeta_1", "mode"]).to_pylist():
        counts.setdefault((row["r_on"], row["zeta_1"]), Counter())[row["mode"] or "unnamed"] += 1
    found = {}
    for point, count in sorted(counts.items()):
        whole = [mode for mode in count if mode != "fragmented"] or ["fragmented"]
        found[point] = (whole[0] if len(whole) == 1 else MIXED, count)
    return found


def keep_table(workspace: Workspace, sweep: Sweep, measures: tuple[str, ...]) -> None:
    """Write one row a point: the verdict, how many runs show each mode, the mean of measures."""
    found = verdicts(sweep)
    modes = sorted({mode for _, count in found.values() for mode in count})
    columns: dict[str, Any] = {
        "r_on": [point[0] for point in found],
        "zeta_1": [point[1] for point in found],
        "verdict": [verdict for verdict, _ in found.values()],
        **{mode: [count[mode] for _, count in found.values()] for mode in modes},
    }
    rows = sweep.table(["r_on", "zeta_1", "mode", *measures]).to_pylist()
    whole = [row for row in rows if row["mode"] != "fragmented"]
    for name in measures:
        columns[name] = [
            _mean([row[name] for row in whole if (row["r_on"], row["zeta_1"]) == point])
            for point in found
        ]
    workspace.table("points", columns)


def _mean(values: list[float | None]) -> float | str:
    measured = [value for value in values if value is not None]
    return math.fsum(measured) / len(measured) if measured else ""  # in whatever order they came
