"""A run stopped and resumed has the bits of one that never stopped."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np
import xarray as xr

from cellcrawl.bench.cases import LAWS, check_start
from cellcrawl.parameters import Parameters, Schedule
from cellcrawl.simulation import resume, simulate
from cellcrawl.simulation.dataset import decode_attribute
from cellcrawl.verification.check import Result

SCHEDULE: Final = Schedule({"r_on": [(0.2, 26.0), (0.4, 40.0), (0.7, 40.0), (0.7, 20.0)]})
"""A ramp and a jump."""

_OPTIONS: Final[dict[str, dict[str, Any]]] = {
    "adaptive": {},
    "paper": {"nodes": 200},
    "spline": {"nodes": 128},
    "stochastic": {"nodes": 128, "bonds": 300.0},
}


def different_values(first: xr.Dataset, second: xr.Dataset) -> int:
    """Return how many values of two datasets are not the same bits."""
    if set(first.variables) != set(second.variables):
        raise ValueError("the datasets have different variables")
    pairs = [(first[name].values, second[name].values) for name in first.variables]
    if any(a.shape != b.shape for a, b in pairs):
        raise ValueError("the datasets have different shapes")
    return sum(int(np.count_nonzero(a != b)) for a, b in pairs)


def fixed_attributes(dataset: xr.Dataset) -> dict[str, Any]:
    """Return the attributes without the time the run took."""
    diagnostics = decode_attribute(dataset, "diagnostics")
    del diagnostics["wall_time"]
    return {**dataset.attrs, "diagnostics": diagnostics}


def work(dataset: xr.Dataset) -> tuple[int, int]:
    """Return steps and right-hand sides of a run."""
    diagnostics = decode_attribute(dataset, "diagnostics")
    return int(diagnostics["steps"]), int(diagnostics["right_hand_sides"])


def stopped_and_resumed(
    path: Path, stops: tuple[float, ...], t_end: float, **options: Any
) -> tuple[xr.Dataset, xr.Dataset]:
    """Return a run resumed after each of ``stops``, and the same run in one go."""
    run = partial(simulate, options.pop("parameters", Parameters(r_on=26)), **options)
    run(t_end=stops[0], output=path).close()
    for stop in stops[1:]:
        resume(path, stop).close()
    return resume(path, t_end), run(t_end=t_end)


def of_solvers(full: bool) -> Iterator[Result]:
    """Count the bits that a restart changes, for every solver, law and file format."""
    for solver, options in _OPTIONS.items():
        for law in LAWS if full else LAWS[:1]:
            p = Parameters(r_on=26, elasticity=law)
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder) / "run.nc"
                resumed, straight = stopped_and_resumed(
                    path,
                    (0.3337, 0.52, 0.6),
                    1.0,
                    parameters=p,
                    start=check_start(p),
                    schedule=SCHEDULE,
                    solver=solver,
                    **options,
                )
                with resumed:
                    changed = different_values(resumed, straight)
                    counts = work(resumed), work(straight)
            yield Result(
                f"a run stopped three times, across a ramp and a jump, {solver} solver, {law}",
                "0 values differ, as much work",
                f"{changed} values differ, {counts[0][0]} and {counts[1][0]} steps",
                changed == 0 and counts[0] == counts[1],
                values={"values": sum(v.size for v in straight.variables.values())},
            )
