"""Cost against the number of nodes and against the length of the run."""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from matplotlib.figure import Figure

from cellcrawl.bench.cases import Case
from cellcrawl.plot.style import PAGE, paper_figure
from cellcrawl.solvers import SOLVERS

_STREAM = """
import resource, sys, time
import cellcrawl as cc
cc.simulate(cc.Parameters(r_on=26), 1.0, output=sys.argv[1] + "-warm.nc").close()
start = time.perf_counter()
run = cc.simulate(cc.Parameters(r_on=26), float(sys.argv[2]), output=sys.argv[1])
seconds = time.perf_counter() - start
assert run.attrs["status"] == "completed", run.attrs["status_message"]
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
peak /= 1024 if sys.platform != "darwin" else 1024**2
print(seconds, peak)
"""

_COLOURS = {"adaptive": "#0072b2", "paper": "#e69f00"}


class NodeCost(NamedTuple):
    """Cost of one right-hand side on a number of nodes."""

    solver: str
    nodes: int
    microseconds: float


class Stream(NamedTuple):
    """Cost of one run written to disk."""

    t_end: float
    seconds: float
    peak_megabytes: float
    file_megabytes: float


def cost_of_nodes(quick: bool = False) -> Iterator[NodeCost]:
    """Time one right-hand side (``adaptive``) or step (``paper``) on more and more nodes."""
    case = Case(26, 600, t_end=0.2)
    counts = (128, 512) if quick else (64, 128, 256, 512, 1024, 2048)
    for name, options in (("adaptive", {}), ("paper", {"dt": 1e-4})):
        scheme = SOLVERS[name]
        for nodes in counts:
            held = {"min_nodes": nodes, "max_nodes": nodes} if name == "adaptive" else options
            start = case.start(scheme.start_nodes(nodes))
            solver = scheme(start, case.conditions, nodes=nodes, **held)
            solver.advance(0.05)  # compile and warm up
            before = solver.diagnostics()["right_hand_sides"]
            began = time.perf_counter()
            solver.advance(case.t_end)
            seconds = time.perf_counter() - began
            count = solver.diagnostics()["right_hand_sides"] - before
            yield NodeCost(name, nodes, 1e6 * seconds / max(count, 1))


def cost_of_time(quick: bool = False) -> Iterator[Stream]:
    """Time runs written to disk, each in a process of its own, and their peak memory."""
    for t_end in (100.0, 400.0) if quick else (100.0, 1000.0, 10000.0):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "run.nc"
            command = [sys.executable, "-c", _STREAM, str(path), str(t_end)]
            said = subprocess.run(command, check=True, capture_output=True, text=True).stdout
            seconds, peak = (float(word) for word in said.split())
            yield Stream(t_end, seconds, peak, path.stat().st_size / 1e6)


def plot(nodes: list[NodeCost], streams: list[Stream]) -> Figure:
    """Draw both."""
    with paper_figure(PAGE, 2.4) as figure:
        left, right = figure.subplots(1, 2)
        for name in dict.fromkeys(row.solver for row in nodes):
            rows = [row for row in nodes if row.solver == name]
            what = "right-hand side" if name == "adaptive" else "step"
            left.loglog(
                [r.nodes for r in rows],
                [r.microseconds for r in rows],
                "o-",
                markersize=3,
                color=_COLOURS[name],
                label=f"{name}, one {what}",
            )
        left.set(xlabel="nodes", ylabel="time (µs)")
        ends = [s.t_end for s in streams]
        for values, colour, style, label in (
            ([s.seconds for s in streams], "#0072b2", "o-", "time (s)"),
            ([s.peak_megabytes for s in streams], "#d55e00", "s-", "memory (MB)"),
        ):
            right.loglog(ends, values, style, markersize=3, color=colour, label=label)
        right.set(xlabel=r"length of the run $t_\mathrm{end}$ ($1/k_\mathrm{off}^0$)")
        for panel in (left, right):
            panel.spines[["top", "right"]].set_visible(False)
            panel.legend(frameon=False)
    return figure
