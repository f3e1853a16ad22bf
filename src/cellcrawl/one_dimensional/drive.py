"""Two edges from record to record, by error-controlled steps in one compiled call."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from cellcrawl.numerics.kernels import kernel
from cellcrawl.one_dimensional.rosenbrock import (
    IMBALANCE,
    N_FRONT,
    N_REAR,
    STATE,
    TENSION,
    rates,
    step,
)

# what `run` returns beside the number of records made
REACHED, NO_ROOT, STEP_TOO_SMALL, TOO_MANY_STEPS = range(4)
# entries of `counters`
STEPS, REJECTED = range(2)

_FIRST: Final = 1e-4
_SHORTEST: Final = 1e-12
_SAFETY: Final = 0.9
_LONGEST: Final = 0.5


@kernel
def run(
    laws: Any,
    edge: np.ndarray,
    times: np.ndarray,
    constants: np.ndarray,
    rtol: float,
    tension_scale: float,
    most_steps: int,
    records: np.ndarray,
    bond_forces: np.ndarray,
    counters: np.ndarray,
) -> tuple[int, int]:
    """Fill ``records`` (times, STATE) from its first row on, and ``bond_forces`` (times, edges).

    Errors are held below ``rtol`` in the bound fractions and below ``rtol * tension_scale`` in the
    tension, a step; steps end on the records exactly.
    """
    state, after, error = records[0].copy(), np.empty(STATE), np.empty(STATE)
    phi, new_phi, rate = np.full(2, np.nan), np.empty(2), np.empty(STATE)
    if not rates(laws, edge, state, constants, phi, rate):
        return NO_ROOT, 0
    bond_forces[0] = phi
    h = _FIRST
    for record in range(1, times.size):
        time, end = times[record - 1], times[record]
        while time < end:
            left = end - time
            trial = left if h >= 0.999 * left else min(h, 0.5 * left)
            if counters[STEPS] + counters[REJECTED] >= most_steps:
                return TOO_MANY_STEPS, record
            size = np.inf
            if step(laws, edge, state, phi, constants, trial, after, error):
                size = max(abs(error[N_FRONT]), abs(error[N_REAR]))
                pull = abs(error[TENSION]) + abs(error[IMBALANCE])
                size = max(size, pull / tension_scale) / rtol
            if size <= 1.0:
                new_phi[:] = phi
                if not rates(laws, edge, after, constants, new_phi, rate):
                    size = np.inf
            if not size <= 1.0:  # also where it is not a number
                counters[REJECTED] += 1
                h = trial * (max(0.2, _SAFETY * size**-0.25) if size < np.inf else 0.2)
                if h < _SHORTEST:
                    return NO_ROOT if size == np.inf else STEP_TOO_SMALL, record
                continue
            counters[STEPS] += 1
            state[:], phi[:] = after, new_phi
            time = end if trial == left else time + trial
            grown = trial * min(5.0, _SAFETY * max(size, 1e-10) ** -0.25)
            h = min(_LONGEST, max(h, grown) if trial < h else grown)
        records[record] = state
        bond_forces[record] = phi
    return REACHED, times.size
