"""Orders of accuracy, from the check start and from a manufactured solution."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any, Final

import numpy as np

from cellcrawl.bench.cases import LAWS, check_start
from cellcrawl.numerics import fourier
from cellcrawl.parameters import Parameters
from cellcrawl.solvers.adaptive import AdaptiveSolver
from cellcrawl.solvers.adaptive import state as layout
from cellcrawl.solvers.adaptive.mesh import MESH_ROWS, hold
from cellcrawl.solvers.adaptive.rates import WORK_ROWS, rates, renew_rates
from cellcrawl.solvers.adaptive.staggered import HALO
from cellcrawl.solvers.conditions import Conditions
from cellcrawl.verification import manufactured
from cellcrawl.verification.agreement import CELL, disagreement, last, summary
from cellcrawl.verification.check import Result, at_least, at_most, near

_FINEST: Final = 1024  # nodes on which the rates are as good as exact


def ratio_orders(
    parameters: Parameters, t_end: float, solver: str, settings: Sequence[dict[str, Any]]
) -> np.ndarray:
    """Return the orders of a solver whose settings halve step or spacing from one to the next.

    From three runs, one order each of length, tension, area and the centroid's coordinates.
    """
    coarse, middle, fine = (summary(last(parameters, t_end, solver, **s)) for s in settings)
    orders: np.ndarray = np.log2(np.abs((coarse - middle) / (middle - fine)))
    return orders


def orders_against_finest(
    parameters: Parameters, t_end: float, solver: str, settings: Sequence[dict[str, Any]]
) -> tuple[list[float], list[float]]:
    """Return orders and errors of a solver against its own finest run, settings halving."""
    runs = [summary(last(parameters, t_end, solver, **s)) for s in settings]
    errors = [disagreement(run, runs[-1]) for run in runs[:-1]]
    return [math.log2(a / b) for a, b in pairwise(errors)], errors


def adaptive_order_in_space(parameters: Parameters, nodes: tuple[int, int] = (96, 128)) -> float:
    """Return the order of the rates of change on the staggered grid."""
    exact = _rates(parameters, _FINEST)
    errors = []
    for count in nodes:
        found = _rates(parameters, count)
        ahead = math.pi / count - math.pi / _FINEST
        true = fourier.resample(layout.bound(exact), count, ahead)
        errors.append(float(np.abs(layout.bound(found) - true).max()))
    return math.log(errors[0] / errors[1]) / math.log(nodes[1] / nodes[0])


def _rates(parameters: Parameters, nodes: int) -> np.ndarray:
    """Return the rates of change of the check start."""
    conditions = Conditions(parameters)
    state = layout.from_cell(check_start(parameters).state(parameters, 2 * _FINEST), nodes)
    out, work = np.zeros_like(state), np.zeros((WORK_ROWS, nodes + 2 * HALO))
    log_rate = np.full(nodes, math.log(parameters.r_p))
    edge = np.vstack([conditions.edge(0.0, nodes), np.full(nodes, parameters.tension_rate)])
    mesh = np.zeros((MESH_ROWS, nodes + 2 * HALO))
    hold(layout.fields(state)[2], mesh, nodes)
    laws = conditions.laws.compiled
    renew_rates(laws, log_rate, edge, work)
    if not rates(laws, None, 0.0, state, out, log_rate, edge, mesh, work):
        raise RuntimeError("the check start has no off-rate somewhere")
    return out


def adaptive_order_in_time(parameters: Parameters, nodes: int = 640) -> float:
    """Return the slope of error against steps at t = 1, on a grid that is held."""
    tolerances = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
    true, _ = _held(parameters, 1e-10, nodes)
    found = [_held(parameters, rtol, nodes) for rtol in tolerances]
    errors = [disagreement(values, true) for values, _ in found]
    slope = np.polyfit(np.log([steps for _, steps in found]), np.log(errors), 1)[0]
    return float(-slope)


def _held(parameters: Parameters, rtol: float, nodes: int) -> tuple[np.ndarray, float]:
    state = check_start(parameters).state(parameters, 4 * nodes)
    solver = AdaptiveSolver(
        state, Conditions(parameters), rtol=rtol, min_nodes=nodes, max_nodes=nodes
    )
    broken = solver.advance(1.0)
    if broken is not None:
        raise RuntimeError(broken.message)
    frame = solver.frame(1.0)
    values = [frame.length, frame.tension, frame.area, frame.centroid_x, frame.centroid_y]
    return np.array(values), solver.diagnostics()["steps"]


def error_against_tolerance(
    parameters: Parameters, tolerances: Sequence[float]
) -> tuple[np.ndarray, float]:
    """Return the adaptive solver's errors at t = 5 and their slope against the tolerance."""
    true = summary(last(parameters, 5.0, "adaptive", rtol=1e-8))
    errors = np.array(
        [
            disagreement(summary(last(parameters, 5.0, "adaptive", rtol=rtol)), true)
            for rtol in tolerances
        ]
    )
    return errors, float(np.polyfit(np.log(tolerances), np.log(errors), 1)[0])


def manufactured_order_in_time() -> dict[str, float]:
    """Return the order in the step of the paper's scheme, by field."""
    coarse, fine = (
        manufactured.errors(*manufactured.solve("paper", nodes=1600, dt=dt)) for dt in (1e-3, 5e-4)
    )
    return {name: math.log2(coarse[name] / fine[name]) for name in coarse}


def manufactured_order_in_space() -> dict[str, float]:
    """Return the order in the spacing of the paper's scheme, by field.

    The same step on three grids: at common nodes what they differ by is the error in space alone.
    """
    frames = [manufactured.solve("paper", nodes=n, dt=4e-4)[0] for n in (60, 120, 240)]
    orders = {}
    for name in ("x", "y", "bound_fraction", "off_rate"):
        values = [getattr(frame, name)[:: frame.x.size // 60] for frame in frames]
        first, second = (float(np.linalg.norm(a - b)) for a, b in pairwise(values))
        orders[name] = math.log2(first / second)
    return orders


def of_adaptive(full: bool) -> Iterator[Result]:
    """Measure the adaptive solver's orders, and that its tolerance means something."""
    yield near(
        "order in space of the adaptive solver's rates, 96 to 128 nodes",
        adaptive_order_in_space(CELL),
        10.0,
        0.6,
    )
    for law in LAWS:
        tolerances = (1e-3, 1e-4, 1e-5, 1e-6)
        p = CELL.replace(elasticity=law)
        yield at_least(
            f"order in time of the adaptive solver, error against steps on a held grid, {law}",
            adaptive_order_in_time(p),
            4.0,
            note="its formulas are of order 1 to 5 and change on the way",
        )
        errors, slope = error_against_tolerance(p, tolerances)
        yield near(
            f"slope of error against tolerance, adaptive solver, t = 5, {law}", slope, 1.0, 0.4
        )
        yield at_most(
            f"error over tolerance, 1e-3 to 1e-6, adaptive solver, t = 5, {law}",
            float(np.max(errors / np.array(tolerances))),
            4.0,
        )
    for rtol in (1e-3, 1e-5, 1e-7, 1e-9) if full else (1e-3, 1e-6, 1e-9):
        errors_by_field = manufactured.errors(*manufactured.solve("adaptive", rtol=rtol))
        worst = max(errors_by_field, key=lambda name: errors_by_field[name])
        yield at_most(
            f"error on the manufactured solution, adaptive solver, rtol {rtol:g}",
            errors_by_field[worst],
            rtol,
            note=f"the largest is that of the {worst.replace('_', ' ')}",
        )


def of_paper(full: bool) -> Iterator[Result]:
    """Measure the orders of the paper's scheme."""
    # The y of the centroid changes too little with the step to show an order.
    in_time = ratio_orders(CELL, 2.0, "paper", [{"nodes": 400, "dt": d} for d in STEPS])[:4]
    in_space = ratio_orders(CELL, 2.0, "paper", [{"nodes": n, "dt": 5e-4} for n in NODES])
    yield _farthest("order in time of the paper's scheme, check start, t = 2", in_time, 1.0, 0.1)
    yield _farthest("order in space of the paper's scheme, check start, t = 2", in_space, 2.0, 0.1)
    by_time, by_space = manufactured_order_in_time(), manufactured_order_in_space()
    told = "order in {} of the paper's scheme, manufactured solution"
    yield _farthest(told.format("time"), np.array(list(by_time.values())), 1.0, 0.15)
    yield at_least(
        told.format("space"),
        min(by_space.values()),
        1.85,
        note="of positions on its circle more than two: closing the outline takes most of their "
        "error away",
    )


STEPS: Final = (1e-3, 5e-4, 2.5e-4)
NODES: Final = (300, 600, 1200)


def of_spline(full: bool) -> Iterator[Result]:
    """Measure the orders of the spline scheme."""
    for law in LAWS if full else LAWS[:1]:
        p = CELL.replace(elasticity=law)
        grids = [{"nodes": n} for n in (256, 512, 1024)]
        (order,), _ = orders_against_finest(p, 2.0, "spline", grids)
        yield near(f"order in space of the spline scheme, t = 2, {law}", order, 4.0, 0.4)
        # before the first remeshing, whose time would change with the step
        steps = [{"nodes": 128, "dt": dt} for dt in (1.6e-2, 8e-3, 4e-3, 2e-3)]
        orders, _ = orders_against_finest(p, 0.512, "spline", steps)
        # a stiff tension costs some order
        within = 0.6 if law == "consistent" else 0.3
        told = f"order in time of the spline scheme, t = 0.512, {law}"
        yield _farthest(told, np.array(orders), 3.0, within)


def _farthest(what: str, orders: np.ndarray, target: float, within: float) -> Result:
    """Return the result for the order that is farthest from the target."""
    worst = orders[np.abs(orders - target).argmax()]
    return near(what, float(worst), target, within, note=f"the worst of {orders.size}")
