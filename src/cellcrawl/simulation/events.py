"""How a run can end, and the search for the instant at which an edge crosses itself."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cellcrawl.curve import Crossing, first_crossing
from cellcrawl.solvers import Breakdown, Solver

_TIME_RESOLUTION = 1e-4


class CrossingFound(NamedTuple):
    """The instant an edge first crosses itself."""

    last_valid: float
    breakdown: Breakdown


def locate_crossing(
    solver: Solver, checkpoint: dict[str, np.ndarray], valid: float, crossed: float
) -> CrossingFound:
    """Narrow down when the edge crosses itself between ``valid`` and ``crossed``.

    ``checkpoint`` is the solver's state at ``valid`` or earlier.
    The solver ends at the last valid time, from which its frame can be taken.
    """
    crossing = crossing_at(solver, crossed)
    while crossed - valid > _TIME_RESOLUTION:
        middle = 0.5 * (valid + crossed)
        solver.restore(checkpoint)
        broken = solver.advance(middle)
        found = None if broken else crossing_at(solver, middle)
        if broken is None and found is None:
            valid = middle
        else:
            crossed, crossing = middle, found or crossing
    solver.restore(checkpoint)
    solver.advance(valid)
    return CrossingFound(valid, Breakdown("fragmented", crossed, _tear(crossing, crossed, solver)))


def crossing_at(solver: Solver, time: float) -> Crossing | None:
    """Return where the edge crosses itself at a time in the solver's last step."""
    if solver.instant(time).surely_simple:
        return None
    return first_crossing(solver.frame(time).points)


def _tear(crossing: Crossing | None, time: float, solver: Solver) -> str:
    message = f"the edge crosses itself at t = {time:.4f}"
    if crossing is not None:
        nodes = solver.frame(solver.time).x.size
        first, second = (place / nodes for place in crossing.places)
        x, y = crossing.point
        message += f", where s/L = {first:.3f} meets s/L = {second:.3f} at ({x:.3f}, {y:.3f})"
    return message + ": the cell tears, and the model says nothing about what follows"
