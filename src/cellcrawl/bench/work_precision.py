"""Work against precision: what each solver's accuracy costs, in one process on one machine."""

from __future__ import annotations

import itertools
import math
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from cellcrawl.bench import rivals
from cellcrawl.bench.cases import LAWS, LONG, POINTS, Case, errors, sampled
from cellcrawl.bench.references import References
from cellcrawl.bench.uniform_grid import UniformGrid
from cellcrawl.plot.style import COLUMN, PAGE, paper_figure
from cellcrawl.solvers import SOLVERS

Solve = Callable[[], tuple[np.ndarray, int]]  # gives the values at the times, and the most nodes
_FAST_ENOUGH = 0.3  # a run this short is repeated and its best time taken
_REPEATS = 3
_BUDGET = 10.0  # seconds for one solver on one case: runs foreseen to need more are left out
_PEEK = 0.02  # the part of a run from which its time is foreseen, where steps are equal
_LOOKS = (
    ("#0072b2", "o"),
    ("#e69f00", "^"),
    ("#009e73", "s"),
    ("#d55e00", "D"),
    ("#9467bd", "v"),
)
# Nodes of the uniform grid by tolerance, so that either may limit the error; where a solver is on
# the front of error against time, its grid suits it.
_GRIDS = {
    1e-2: (128,),
    1e-3: (128, 192),
    1e-4: (160, 224),
    1e-5: (192, 256, 320),
    1e-6: (256, 320, 384),
    1e-7: (320, 384, 512),
    1e-8: (384, 512),
    1e-9: (512,),
}
_QUICK_GRIDS = {1e-4: (192,), 1e-6: (256,), 1e-8: (384,)}


class Row(NamedTuple):
    """One run: what, how accurate, at what cost. ``error`` is that of length or centroid."""

    case: str
    t_end: float
    solver: str
    setting: str
    error: float
    length: float
    tension: float
    area: float
    centroid: float
    seconds: float
    nodes: int


def cases(quick: bool) -> list[Case]:
    """Return the cells measured: all points and laws, and two more diffusivities."""
    if quick:
        return [Case(26, 600), Case(26, 600, "consistent"), Case(16, 600)]
    base = [Case(*point, law) for point in POINTS for law in LAWS]
    return base + [Case(26, 600, law, D) for law in LAWS for D in (0.01, 0.1)]


def measure(
    quick: bool = False,
    references: References | None = None,
    times: tuple[float, ...] = (5.0, 2.0 * LONG),
) -> Iterator[Row]:
    """Run every solver on every case, coarse to fine, as far as each run is short enough."""
    warm_up()
    references = references or References()
    for t_end in times[:1] if quick else times:
        for shape in cases(quick):
            case = Case(shape.r_on, shape.zeta_1, shape.elasticity, shape.D, t_end)
            if t_end >= LONG and case.D < 0.05:
                continue  # its errors grow a million times by then: no solver has a figure
            truth = references.of(case)
            yield from _adaptive(case, truth, quick)
            yield from _paper(case, truth, quick)
            yield from _rivals(case, truth, quick)


def _adaptive(case: Case, truth: np.ndarray, quick: bool) -> Iterator[Row]:
    for rtol in (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8)[: 6 if quick else 7]:
        found, seconds, nodes = timed(partial(prepare, "adaptive", case, rtol=rtol))
        yield _row(case, "adaptive", f"rtol {rtol:g}", found, truth, seconds, nodes)


def _paper(case: Case, truth: np.ndarray, quick: bool) -> Iterator[Row]:
    steps = [(2000, None)] if quick else [(1000, None), (2000, None), (2000, 1e-4)]
    left = _BUDGET
    for nodes, dt in steps:
        left -= _foreseen("paper", case, nodes=nodes, dt=dt)
        if left < 0.0:
            break
        found, seconds, _ = timed(partial(prepare, "paper", case, nodes=nodes, dt=dt))
        setting = f"N {nodes}, dt {dt or 'usual'}"
        yield _row(case, "paper", setting, found, truth, seconds, nodes)


def _rivals(case: Case, truth: np.ndarray, quick: bool) -> Iterator[Row]:
    for name, solve in rivals.available().items():
        slow = name.startswith("SciPy")
        if slow and (case.t_end > 5.0 or (quick and name == "SciPy BDF")):
            continue
        left, last = _BUDGET / (3.0 if quick else 1.0), 0.0
        for rtol, grids in (_QUICK_GRIDS if quick else _GRIDS).items():
            began = time.perf_counter()
            for grid in grids[-1:] if slow else grids:
                nodes = _grid_for(case, grid)
                found, seconds, _ = timed(partial(prepare_rival, solve, case, nodes, rtol))
                setting = f"N {nodes}, rtol {rtol:g}"
                yield _row(case, name, setting, found, truth, seconds, nodes)
            spent = time.perf_counter() - began
            left -= spent
            if left < spent * max(1.0, spent / last if last else 1.0):
                break  # the next tolerance takes about as many times longer again
            last = spent


def _foreseen(name: str, case: Case, **options: Any) -> float:
    """Return about how many seconds a run in equal steps takes, from its first part."""
    run = prepare(name, replace(case, t_end=_PEEK * case.t_end), **options)
    began = time.perf_counter()
    run()
    return (time.perf_counter() - began) / _PEEK


def _grid_for(case: Case, nodes: int) -> int:
    """Return ``nodes`` for the usual diffusivity; a smaller one makes sharper waves of linkers."""
    return 16 * round(nodes * math.sqrt(max(1.0, 0.05 / case.D)) / 16)


def prepare(name: str, case: Case, **options: Any) -> Solve:
    """Return a run of one of our solvers, its start made, ready to be timed."""
    scheme = SOLVERS[name]
    nodes = scheme.checked_nodes(options.pop("nodes", None))
    start = case.start(scheme.start_nodes(nodes, **options))
    solver = scheme(start, case.conditions, nodes=nodes, **options)

    def run() -> tuple[np.ndarray, int]:
        found = sampled(solver, case.times)
        return found, int(solver.diagnostics().get("most_nodes", nodes))

    return run


def prepare_rival(solve: rivals.Rival, case: Case, nodes: int, rtol: float) -> Solve:
    """Return a run of a general solver on a uniform grid, ready to be timed."""
    system = UniformGrid(case.start(max(1024, nodes)), case.conditions, nodes)

    def run() -> tuple[np.ndarray, int]:
        return rivals.solved(solve, system, case.times, rtol), nodes

    return run


def timed(prepared: Callable[[], Solve]) -> tuple[np.ndarray, float, int]:
    """Return what a run finds, the best of a few times in seconds, and its nodes."""
    best = math.inf
    for _ in range(_REPEATS):
        run = prepared()
        began = time.perf_counter()
        found, nodes = run()
        best = min(best, time.perf_counter() - began)
        if best > _FAST_ENOUGH:
            break
    return found, best, nodes


def warm_up() -> None:
    """Compile and load everything that is going to be timed."""
    case = Case(26, 600, t_end=0.01)
    for name in ("adaptive", "paper"):
        prepare(name, case)()
    prepare("adaptive", Case(26, 600, "consistent", t_end=0.01))()
    for solve in rivals.available().values():
        prepare_rival(solve, case, 64, 1e-4)()


def speed_up(rows: list[Row], solver: str, at_error: float) -> float:
    """Return how many times longer ``solver`` takes than adaptive for ``at_error``, one case.

    Both are interpolated between their runs in logarithms, along the front of runs that no other
    run of the solver beats in both error and time. NaN where one of them does not get there.
    """
    return _seconds_at(rows, solver, at_error) / _seconds_at(rows, "adaptive", at_error)


def _seconds_at(rows: list[Row], solver: str, at_error: float) -> float:
    runs = sorted((row.error, row.seconds) for row in rows if row.solver == solver)
    front = [run for run in runs if not any(e <= run[0] and s < run[1] for e, s in runs)]
    errors, seconds = (np.log([pair[i] for pair in front] or [1.0]) for i in (0, 1))
    if not front or not errors[0] <= math.log(at_error):
        return math.nan
    return float(np.exp(np.interp(math.log(at_error), errors, seconds)))


def _row(
    case: Case,
    solver: str,
    setting: str,
    found: np.ndarray,
    truth: np.ndarray,
    seconds: float,
    nodes: int,
) -> Row:
    miss = errors(found, truth)
    return Row(case.label, case.t_end, solver, setting, miss.largest, *miss, seconds, nodes)


def plot(rows: list[Row]) -> Figure:
    """Draw error against time, one panel a case."""
    keys = list(dict.fromkeys((row.case, row.t_end) for row in rows))
    columns = min(len(keys), 4)
    lines = math.ceil(len(keys) / columns)
    names = list(dict.fromkeys(row.solver for row in rows))
    width = PAGE * columns / 4 if columns > 1 else COLUMN
    with paper_figure(width, 1.35 * lines + 0.5) as figure:
        grid = figure.subplots(lines, columns, squeeze=False, sharex=True, sharey=True)
        for ax, (case, t_end) in zip(grid.flat, keys, strict=False):
            for name, (colour, marker) in zip(names, itertools.cycle(_LOOKS), strict=False):
                runs = [r for r in rows if (r.case, r.t_end, r.solver) == (case, t_end, name)]
                ax.loglog(
                    [r.error for r in runs],
                    [r.seconds for r in runs],
                    marker=marker,
                    color=colour,
                    markersize=2.2,
                    linewidth=0.8,
                    label=name,
                )
            ax.set_title(f"{case.replace(', D', chr(10) + '$D$')}, $t$ = {t_end:g}", loc="left")
            ax.spines[["top", "right"]].set_visible(False)
        for number, ax in enumerate(grid.flat[len(keys) :], len(keys)):
            grid.flat[number - columns].tick_params(labelbottom=True)
            ax.remove()
        size = mpl.rcParams["axes.labelsize"]
        figure.supxlabel(
            "error of length and centroid, over $t$ = 50 to 100 where $t$ = 100", fontsize=size
        )
        figure.supylabel("time (s)", fontsize=size)
        handles, labels = grid.flat[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper center", ncols=3, frameon=False)
    return figure
