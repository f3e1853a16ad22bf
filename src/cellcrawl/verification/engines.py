"""Solvers at work outside a run: from a start to frames at any times."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from cellcrawl.parameters import Parameters
from cellcrawl.solvers import SOLVERS, Frame, Solver
from cellcrawl.solvers.conditions import Conditions
from cellcrawl.starts import Start


def started(name: str, parameters: Parameters, start: Start, **options: Any) -> Solver:
    """Return a solver with its first state; ``options`` are its own."""
    scheme = SOLVERS[name]
    nodes = scheme.checked_nodes(options.pop("nodes", None))
    state = start.state(parameters, scheme.start_nodes(nodes, **options))
    return scheme(state, Conditions(parameters), nodes=nodes, **options)


def frames(solver: Solver, times: Iterable[float]) -> list[Frame]:
    """Return the frames at rising times, or raise if the solver breaks down."""
    found = []
    for time in times:
        broken = solver.advance(float(time))
        if broken is not None:
            raise RuntimeError(broken.message)
        found.append(solver.frame(float(time)))
    return found
