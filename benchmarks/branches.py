"""Time branches: states with growth rates, crossings, a curve of points, orbits, an exponent.

    python benchmarks/branches.py [--output DIR]

Processor time on one core; a machine that is busy beside it still adds a part, and the load is
kept with the numbers. The gliding cells at zeta_1 = 560 from where they leave the circle down to
r_on = 12; the zigzag (26, 600) under both tension laws; the exponent of (44, 560).
"""

from __future__ import annotations

import argparse
import json
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cellcrawl as cc
from cellcrawl.bench.machine import record
from cellcrawl.branches.points import crossings

CELL = cc.Parameters(r_on=56, zeta_1=560)


def timed(function: Callable[[], Any]) -> tuple[float, Any]:
    """Return the processor time of a call, and what it returned."""
    began = time.process_time()
    found = function()
    return time.process_time() - began, found


def measured() -> dict[str, float]:
    """Return processor times in seconds."""
    start = cc.branches.from_circle(CELL)
    start.continue_in("r_on", 57.0)  # compiles
    alone, plain = timed(lambda: start.continue_in("r_on", 12.0, spectra=False))
    whole, branch = timed(lambda: start.continue_in("r_on", 12.0))
    longest = 0.0
    for point in branch.special_points:
        k = int(point.position)
        ends = branch[k], branch[k + 1]
        weight = 1.0 / ends[0].parameters.r_on ** 2
        seconds, _ = timed(lambda ends=ends, w=weight, k=k: crossings("r_on", w, *ends, k))
        longest = max(longest, seconds)
    fork = branch.points("pitchfork")[0]
    box = {"zeta_1": (540.0, 600.0)}
    curve_time, curve = timed(lambda: fork.continue_in("zeta_1", within=box))
    return {
        "states": float(len(branch)),
        "branch_seconds": whole,
        "branch_of_60_states_seconds": 60.0 * whole / len(branch),
        "without_growth_rates_seconds": alone * len(branch) / len(plain),
        "crossings": float(len(branch.special_points)),
        "longest_interval_with_crossings_seconds": longest,
        "curve_point_seconds": curve_time / len(curve),
        **of_orbits(),
    }


def of_orbits() -> dict[str, float]:
    """Return processor times of an orbit under either law, and of a time unit of an exponent."""
    found = {}
    cell = cc.Parameters(r_on=26, zeta_1=600)
    for law in ("printed", "consistent"):
        run = cc.simulate(cell.replace(elasticity=law), 120.0, save_every=1.0)
        if not found:
            cc.branches.orbit(run, nodes=256)  # compiles
        seconds, made = timed(lambda run=run: cc.branches.orbit(run))
        found[f"orbit_{law}_seconds"] = seconds
        found[f"orbit_{law}_nodes"] = float(made.nodes)
        found[f"multipliers_{law}_seconds"] = timed(lambda made=made: made.multipliers)[0]
    spinning = cell.replace(r_on=44, zeta_1=560)
    seconds, _ = timed(lambda: cc.branches.lyapunov_exponent(spinning, t_end=100.0))
    return {**found, "exponent_seconds_per_time": seconds / 160.0}


def main() -> None:
    """Measure, print, and keep the numbers beside the machine they are of."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", type=Path)
    asked = parser.parse_args()
    found = measured()
    for name, value in found.items():
        print(f"{name:42} {value:8.3f}")
    if asked.output is not None:
        asked.output.mkdir(parents=True, exist_ok=True)
        load = os.getloadavg()[0] if hasattr(os, "getloadavg") else None
        content = {"machine": record(), "load": load, "branches": found}
        (asked.output / "branches.json").write_text(json.dumps(content, indent=1), "utf-8")


if __name__ == "__main__":
    main()
