"""What a sweep costs beside its runs: time of the scheduling, workers, memory of the driver."""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from cellcrawl.simulation.description import RunDescription
from cellcrawl.sweeps import Grid
from cellcrawl.sweeps.driver import Sweeping
from cellcrawl.sweeps.worker import Outcome
from cellcrawl.threads import usable_cores

_SLEEP = 0.1  # seconds: what a run costs
_DONE = {"status": "completed", "mode": "gliding", "confidence": 1.0}
_DRIVER = """
import resource, sys, time
from cellcrawl.bench.sweeps import made
seconds = made(int(sys.argv[2]), sys.argv[1], nothing=True)
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
print(seconds, peak / (1024 if sys.platform != "darwin" else 1024**2))
"""


class Figure(NamedTuple):
    """A figure asked for and the one measured."""

    what: str
    asked: str
    measured: str


def nothing(run: RunDescription, keep: str) -> Outcome:
    """Make no run, only its row."""
    return Outcome(_DONE)


def sleep(run: RunDescription, keep: str) -> Outcome:
    """Take the time of a run, whatever else the machine does."""
    time.sleep(_SLEEP)
    return Outcome(_DONE)


def made(runs: int, folder: str, *, nothing: bool = False, workers: int = 2) -> float:
    """Sweep runs that are none; return the seconds it took once the workers were there."""
    execute = globals()["nothing" if nothing else "sleep"]
    grid = Grid(axes={"seed": {"from": 1, "to": runs, "step": 1}})
    few = Grid(axes={"seed": {"from": 1, "to": 4 * workers, "step": 1}}, t_end=1.0)
    with Sweeping(folder, grid, None, workers, "rows", "sweep", execute=execute) as at_work:
        at_work.make(few, range(len(few)), False)  # the workers start
        began = time.monotonic()
        at_work.make(grid, range(len(grid)), False)
        return time.monotonic() - began


def measure(quick: bool = False) -> Iterator[Figure]:
    """Measure scheduling, scaling and memory."""
    runs = 200 if quick else 1000
    with tempfile.TemporaryDirectory() as folder:
        seconds = made(runs, str(Path(folder) / "out"))
    ideal = runs * _SLEEP / 2.0
    yield Figure(
        f"scheduling of {runs} runs of {_SLEEP:g} s (asleep) on 2 workers",
        "<= 5 %",
        f"{seconds / ideal - 1.0:.1%}",
    )
    for rows in (2_000, 10_000) if quick else (10_000, 100_000):
        with tempfile.TemporaryDirectory() as folder:
            command = [sys.executable, "-c", _DRIVER, str(Path(folder) / "out"), str(rows)]
            said = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        taken, peak = (float(word) for word in said.split())
        yield Figure(
            f"driver's peak memory, {rows} rows ({taken:.0f} s)", "<= 500 MB", f"{peak:.0f} MB"
        )
    yield from _throughput(quick)


def _throughput(quick: bool) -> Iterator[Figure]:
    """Time real runs with 1, 2, ... workers, on the diagram's own points."""
    from cellcrawl.sweeps import sweep

    seeds = [1] if quick else [1, 2, 3]
    axes = {"r_on": [16, 26, 36, 46, 56], "zeta_1": [440, 520, 600], "seed": seeds}
    counts = [1]
    while 2 * counts[-1] <= usable_cores():
        counts.append(2 * counts[-1])
    for workers in counts:
        with tempfile.TemporaryDirectory() as folder:
            began = time.monotonic()
            found = sweep(axes, Path(folder) / "out", workers=workers)
            seconds = time.monotonic() - began
            cost = sum(found.table(["wall_time"])["wall_time"].to_pylist())
        runs = len(axes["r_on"]) * len(axes["zeta_1"]) * len(seeds)
        yield Figure(
            f"{runs} runs to t = 100 with {workers} of the workers, from their start",
            "-",
            f"{seconds:.1f} s for {cost:.1f} s of runs",
        )
