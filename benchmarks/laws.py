"""Time what other laws and surroundings cost, beside the paper's law on bare ground.

    python benchmarks/laws.py [--output DIR] [--compile]

Runs of one cell to t = 100, in turns, so that a busy machine slows all alike; medians over the base
run. With --compile also whole starts to t = 1: of the paper's law with nothing compiled, then of
a new law, the same from disk, and of the new law with nothing compiled.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import cellcrawl as cc
from cellcrawl.bench.machine import record

CELL = cc.Parameters(r_on=26, zeta_1=600)
SQUARE = [[-40, -40], [40, -40], [40, 40], [-40, 40]]
CASES: dict[str, dict[str, Any]] = {
    "paper's law": {},
    "catch-slip": {"laws": cc.laws.CatchSlip(catch=5.0)},
    "soft ground": {"laws": cc.laws.Stiffness(chi=0.9)},
    "polymerisation under load": {"laws": cc.laws.PolymerizationUnderLoad(stall=5000.0)},
    "swept myosin": {"laws": cc.laws.SweptMyosin(sweep=0.2)},
    "stripes": {"surroundings": cc.surroundings.Stripes(period=3.0, between=0.4, edge=0.2)},
    "force": {"surroundings": cc.surroundings.UniformForce(x=0.5)},
    "walls far away": {"surroundings": cc.surroundings.Walls(SQUARE, room=True)},
}
START = """
import time
began = time.perf_counter()
import cellcrawl as cc
class New(cc.laws.Law):
    gain = cc.laws.Parameter(0.01, 0.0, 1.0, "of the on-rate with the force")
    def binding(self, phi, r, n, p):
        return p.r_on * (1.0 + self.gain * phi) * (1.0 - n) - r * n
cc.simulate(cc.Parameters(r_on=26, zeta_1=600), 1.0, laws={laws})
print(time.perf_counter() - began)
"""


def timed(turns: int, t_end: float) -> list[dict[str, Any]]:
    """Return medians of the time per unit time, and steps, of every case."""
    for case in CASES.values():
        cc.simulate(CELL, 1.0, **case)
    seconds: dict[str, list[float]] = {name: [] for name in CASES}
    last: dict[str, Any] = {}
    for _ in range(turns):
        for name, case in CASES.items():
            began = time.perf_counter()
            last[name] = cc.simulate(CELL, t_end, **case).attrs
            seconds[name].append(time.perf_counter() - began)
    base = statistics.median(seconds["paper's law"])
    rows = []
    for name, times in seconds.items():
        reached = float(last[name]["end_time"])
        spent = statistics.median(times) * t_end / max(reached, 1e-9)
        diagnostics = json.loads(last[name]["diagnostics"])
        rows.append(
            {
                "case": name,
                "milliseconds": 1e3 * spent,
                "ratio": spent / base,
                "steps": diagnostics["steps"],
                "ended": last[name]["status"],
            }
        )
    return rows


def started(laws: str, folder: Path) -> float:
    """Return the seconds of a start under some laws, with what is compiled in a folder."""
    done = subprocess.run(
        [sys.executable, "-c", START.format(laws=laws)],
        env={**os.environ, "NUMBA_CACHE_DIR": str(folder)},
        capture_output=True,
        text=True,
        check=True,
    )
    return float(done.stdout)


def compiled() -> dict[str, float]:
    """Return the seconds of starts: see above."""
    with tempfile.TemporaryDirectory() as folder:
        used, empty = Path(folder) / "used", Path(folder) / "empty"
        return {
            "paper's law, nothing compiled": started("None", used),
            "new law": started("New()", used),
            "new law, from disk": started("New()", used),
            "new law, nothing compiled": started("New()", empty),
        }


def main() -> None:
    """Measure, print, and write where asked."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path)
    parser.add_argument("--compile", action="store_true")
    parser.add_argument("--turns", type=int, default=5)
    parser.add_argument("--t-end", type=float, default=100.0)
    asked = parser.parse_args()
    found: dict[str, Any] = {"machine": record(), "t_end": asked.t_end}
    found["cases"] = timed(asked.turns, asked.t_end)
    for row in found["cases"]:
        print(
            f"{row['case']:28s} {row['milliseconds']:8.0f} ms  {row['ratio']:5.2f}  "
            f"{row['steps']} steps  {row['ended']}"
        )
    if asked.compile:
        found["compile"] = compiled()
        print(found["compile"])
    if asked.output is not None:
        asked.output.mkdir(parents=True, exist_ok=True)
        (asked.output / "laws.json").write_text(json.dumps(found, indent=1) + "\n", "utf-8")


if __name__ == "__main__":
    main()
