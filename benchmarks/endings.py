"""Runs that leave the model: is it the cell or the solver? One cell by several solvers.

    python benchmarks/endings.py --output benchmarks/results

Takes seeds that `seeds.py` recorded as out_of_range and follows the sharpest concave bend of the
edge. The force balance has no off-rate where the curvature falls below -(1 + sigma_c / sigma) / h.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np

import cellcrawl as cc
from cellcrawl.bench import machine

BENDS = (20.0, 40.0, 60.0, 80.0)
"""Concave curvatures, times R_0, whose first times are compared."""
RUNS: dict[str, dict[str, Any]] = {
    "adaptive, rtol 1e-4": {"rtol": 1e-4, "nodes": 2048},
    "adaptive, rtol 1e-6": {"rtol": 1e-6, "nodes": 2048},
    "adaptive, rtol 1e-8": {"rtol": 1e-8, "nodes": 2048},
    "spline, 2048 nodes": {"solver": "spline", "nodes": 2048, "dt": 5e-4},
    "paper, 2000 nodes": {"solver": "paper", "nodes": 2000},
}
BEYOND = 0.2  # time units after the first run's end, for the others to end too


def left(name: str, results: Path, most: int) -> tuple[list[float], list[int]]:
    """Return the cell of a recorded count and the first seeds that left the model."""
    found = json.loads((results / f"{name}.json").read_text("utf-8"))
    seeds = [seed for seed, how in enumerate(found["of_each_seed"], 1) if how == "out_of_range"]
    return found["cell"], seeds[:most]


def followed(cell: list[float], seed: int, t_end: float, options: dict[str, Any]) -> dict[str, Any]:
    """Return how a run ends and when its edge is first bent so much."""
    p = cc.Parameters(r_on=cell[0], zeta_1=cell[1])
    start = cc.RandomPerturbation(seed=seed)
    run = cc.simulate(p, t_end, start=start, save_every=0.01, **options)
    sharpest = run["curvature"].min("node").values
    limit = -(1.0 + p.sigma_c / run["tension"].values) / p.h
    passed = [np.flatnonzero(sharpest < -bend) for bend in BENDS]
    return {
        "status": run.attrs["status"],
        "end": float(run.attrs["end_time"]),
        "bends": [float(run["time"][at[0]]) if at.size else None for at in passed],
        "sharpest": float(sharpest.min()),
        "limit": float(limit[-1]),
    }


def main() -> None:
    """Follow, print and record."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--seeds", type=int, default=6, help="of each cell")
    parser.add_argument("--output", type=Path, default=Path("benchmarks/results"))
    given = parser.parse_args()
    rows = []
    for name in ("turns", "tears"):
        cell, seeds = left(name, given.output, given.seeds)
        for seed in seeds:
            ends = 30.0
            for told, options in RUNS.items():
                run = followed(cell, seed, ends, options)
                if told == next(iter(RUNS)):
                    ends = run["end"] + BEYOND
                rows.append({"cell": cell, "seed": seed, "run": told, **run})
                print(cell, seed, told, run, flush=True)
    machine.write(given.output / "endings.json", {"bends": list(BENDS), "runs": rows})


if __name__ == "__main__":
    main()
