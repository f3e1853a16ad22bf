"""The cell as a whole at one time after another, in one compiled call."""

from __future__ import annotations

from typing import Any

import numpy as np

from cellcrawl.numerics.kernels import kernel
from cellcrawl.solvers.adaptive.drive import (
    AT_BREAK,
    ORDER,
    REACHED,
    RESTARTING,
    STEP,
    TIME,
    run,
)
from cellcrawl.solvers.adaptive.frame import CLEARANCE, CLEARLY, measure


@kernel
def follow(
    laws: Any,
    around: Any,
    times: np.ndarray,
    end: float,
    tolerance: float,
    most_steps: int,
    allowed: float,
    fewest_nodes: int,
    most_nodes: int,
    control: np.ndarray,
    counters: np.ndarray,
    table: np.ndarray,
    y: np.ndarray,
    profile: np.ndarray,
    edge: np.ndarray,
    ramping: bool,
    mesh: np.ndarray,
    matrix: np.ndarray,
    work: np.ndarray,
    state: np.ndarray,
    trace: np.ndarray,
    measures: np.ndarray,
    errors: np.ndarray,
) -> tuple[int, int]:
    """`run` to each of ``times`` and `measure` the cell there; rows of ``measures``.

    Returns how many times were dealt with, and what `run` returned last. Stops after a time at
    which the edge may cross itself, for the caller to look, and before a step under parameters
    that have jumped, for the caller to restart.
    """
    for i in range(times.size):
        if counters[RESTARTING] != 0 and control[TIME] < times[i]:
            return i, AT_BREAK
        code = run(
            laws,
            around,
            times[i],
            end,
            tolerance,
            most_steps,
            allowed,
            fewest_nodes,
            most_nodes,
            control,
            counters,
            table,
            y,
            profile,
            edge,
            ramping,
            mesh,
            matrix,
            work,
        )
        if code != REACHED:
            return i, code
        steps = (times[i] - control[TIME]) / control[STEP]
        measure(steps, counters[ORDER], table, state, trace, measures[i], errors)
        if not measures[i, CLEARANCE] > CLEARLY:
            return i + 1, REACHED
    return times.size, REACHED
