"""Work against precision: what each solver's accuracy costs, in one process on one machine."""

from __future__ import annotations

import itertools
import math
import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, NamedTuple

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from cellcrawl.bench import rivals
from cellcrawl.bench.cases import LAWS, POINTS, Case, error, reference, summary
from cellcrawl.plot.style import COLUMN, PAGE, paper_figure
from cellcrawl.solvers import SOLVERS

Solve = Callable[[], tuple[np.ndarray, int]]  # gives the summary and the most nodes used
_FAST_ENOUGH = 0.3  # a run this short is repeated and its best time taken
_REPEATS = 3
_LOOKS = (
    ("#0072b2", "o"),
    ("#e69f00", "^"),
    ("#009e73", "s"),
    ("#d55e00", "D"),
    ("#9467bd", "v"),
)


class Row(NamedTuple):
    """One run: what, how accurate, at what cost."""

    case: str
    t_end: float
    solver: str
    setting: str
    error: float
    seconds: float
    nodes: int


def cases(quick: bool) -> list[Case]:
    """Return the cells measured: all points and laws, and two more diffusivities."""
    if quick:
        return [Case(26, 600), Case(26, 600, "consistent"), Case(16, 600)]
    base = [Case(*point, law) for point in POINTS for law in LAWS]
    return base + [Case(26, 600, law, D) for law in LAWS for D in (0.01, 0.1)]


def measure(quick: bool = False, times: tuple[float, ...] = (5.0, 20.0)) -> Iterator[Row]:
    """Run every solver on every case, coarse to fine."""
    warm_up()
    for t_end in times[:1] if quick else times:
        for shape in cases(quick):
            case = Case(shape.r_on, shape.zeta_1, shape.elasticity, shape.D, t_end)
            truth = reference(case)
            yield from _adaptive(case, truth, quick)
            yield from _paper(case, truth, quick)
            yield from _rivals(case, truth, quick)


def _adaptive(case: Case, truth: np.ndarray, quick: bool) -> Iterator[Row]:
    for rtol in (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8)[: 6 if quick else 7]:
        found, seconds, nodes = timed(partial(prepare, "adaptive", case, rtol=rtol))
        yield _row(case, "adaptive", f"rtol {rtol:g}", found, truth, seconds, nodes)


def _paper(case: Case, truth: np.ndarray, quick: bool) -> Iterator[Row]:
    steps = [(2000, None)] if quick else [(1000, None), (2000, None), (2000, 1e-4)]
    for nodes, dt in steps:
        if case.t_end > 5.0 and dt is not None:
            continue
        found, seconds, _ = timed(partial(prepare, "paper", case, nodes=nodes, dt=dt))
        setting = f"N {nodes}, dt {dt or 'usual'}"
        yield _row(case, "paper", setting, found, truth, seconds, nodes)


def _rivals(case: Case, truth: np.ndarray, quick: bool) -> Iterator[Row]:
    tolerances = (1e-4, 1e-6, 1e-8) if quick else (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)
    for name, solve in rivals.available().items():
        slow = name.startswith("SciPy")
        if slow and (case.t_end > 5.0 or (quick and name == "SciPy BDF")):
            continue
        for rtol in tolerances:
            # The grid that the adaptive solver finds necessary at such an error.
            nodes = prepare("adaptive", case, rtol=min(max(10.0 * rtol, 1e-8), 1e-2))()[1]
            found, seconds, nodes = timed(partial(_prepare_rival, solve, case, nodes, rtol))
            yield _row(case, name, f"rtol {rtol:g}", found, truth, seconds, nodes)
            if seconds > (3.0 if quick else 4.0):
                break


def prepare(name: str, case: Case, **options: Any) -> Solve:
    """Return a run of one of our solvers, its start made, ready to be timed."""
    scheme = SOLVERS[name]
    nodes = scheme.checked_nodes(options.pop("nodes", None))
    start = case.start(scheme.start_nodes(nodes, **options))
    solver = scheme(start, case.conditions, nodes=nodes, **options)

    def run() -> tuple[np.ndarray, int]:
        if solver.advance(case.t_end) is not None:
            return np.full(3, np.nan), nodes
        most = int(solver.diagnostics().get("most_nodes", nodes))
        return summary(solver.frame(case.t_end)), most

    return run


def _prepare_rival(solve: rivals.Rival, case: Case, nodes: int, rtol: float) -> Solve:
    system = rivals.FixedGrid(case, nodes)

    def run() -> tuple[np.ndarray, int]:
        try:
            return system.summary(case.t_end, solve(system, case.t_end, rtol)), nodes
        except (ValueError, RuntimeError, ArithmeticError):
            return np.full(3, np.nan), nodes  # it gave up, or went where there is no off-rate

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
        _prepare_rival(solve, case, 64, 1e-4)()


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
    return Row(case.label, case.t_end, solver, setting, error(found, truth), seconds, nodes)


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
            ax.set_title(f"{case.replace(', D', chr(10) + 'D')}, $t$ = {t_end:g}", loc="left")
            ax.spines[["top", "right"]].set_visible(False)
        for ax in grid.flat[len(keys) :]:
            ax.remove()
        size = mpl.rcParams["axes.labelsize"]
        figure.supxlabel("error of length and centroid", fontsize=size)
        figure.supylabel("time (s)", fontsize=size)
        handles, labels = grid.flat[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper center", ncols=3, frameon=False)
    return figure
