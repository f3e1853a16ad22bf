"""Runs of two edges under one tension."""

from __future__ import annotations

import json
import math
from typing import Any, Final

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.laws import as_law
from cellcrawl.laws.law import PAPER, Law
from cellcrawl.one_dimensional import drive
from cellcrawl.one_dimensional.cell import (
    FREE,
    Anchoring,
    checked_cell,
    edge_of,
    length_stiffness,
)
from cellcrawl.one_dimensional.rosenbrock import (
    IMBALANCE,
    N_FRONT,
    N_REAR,
    STATE,
    TENSION,
    X_FRONT,
    X_REAR,
)
from cellcrawl.one_dimensional.starts import TwoEdges, start_of
from cellcrawl.parameters import Parameters
from cellcrawl.solvers.base import pointwise
from cellcrawl.validation import real_number

TENSION_SCALE: Final = 100.0
"""An error of the tension counts as much as one of the bound fraction that is this much smaller."""
MOST_RECORDS: Final = 10_000_000
_MOST_STEPS = 5_000_000
_ENDINGS = {
    drive.REACHED: ("completed", "reached t_end"),
    drive.NO_ROOT: (
        "out_of_range",
        "no off-rate r >= 1 balances the forces on an edge: outside the model",
    ),
    drive.STEP_TOO_SMALL: (
        "step_too_small",
        "the tolerance could not be met with any reasonable step: try a looser rtol",
    ),
    drive.TOO_MANY_STEPS: ("step_too_small", "too many steps: try a looser rtol or a shorter run"),
}


@checked
def simulate_two_edges(
    parameters: Parameters,
    t_end: float = 60.0,
    *,
    start: str | TwoEdges = "small",
    save_every: float = 0.02,
    rtol: float = 1e-6,
    anchoring: Anchoring = FREE,
    laws: Any = PAPER,
) -> xr.Dataset:
    """Simulate a cell on a line: a front and a rear edge coupled by one tension.

    Parameters
    ----------
    parameters : Parameters
        The cell. ``D`` and ``h`` have no meaning on a line and are not used.
    t_end : float
        Until when.
    start : {"small", "large", "in_phase"} or TwoEdges
        A still cell with a little asymmetry, a stuck front with a slipping rear, two equal edges
        short of linkers, or a state of your own.
    save_every : float
        Time between records.
    rtol : float
        Error allowed in a step: this much in the bound fractions, a hundred times as much in the
        tension; 1e-12 to 1e-2.
    anchoring : Anchoring
        Springs to the cell body; none unless given.
    laws : Law or str
        The law set, as for `cellcrawl.simulate`; the paper's unless given.

    Returns
    -------
    Dataset
        Over time and edge ("front", "rear"): ``position`` on the line (the cell lies from -1 to 1
        at time 0), ``velocity`` outwards, ``bound_fraction``, ``off_rate``, ``friction``. Over
        time: ``tension``, ``imbalance`` (half of what the springs pull more on the front), and
        ``length``. ``attrs`` hold ``status`` and ``status_message``, the parameters, the start, and
        the numbers of steps; a run that could not go on has its records up to then.

    Raises
    ------
    InputError
        For values out of range or a start without an off-rate.

    Notes
    -----
    The mean pull of the springs is part of ``tension``, so that ``tension - (pi G + stiffness / 2)
    length`` is constant.

    Examples
    --------
    >>> from cellcrawl import Parameters, one_dimensional
    >>> run = one_dimensional.simulate_two_edges(Parameters(), 20.0)
    >>> bool(run.bound_fraction.sel(edge="front")[-1] > run.bound_fraction.sel(edge="rear")[-1])
    True
    """
    checked_cell(parameters, anchoring)
    t_end = real_number("t_end", t_end, 0.0, math.inf, open_low=True)
    save_every = real_number("save_every", save_every, 0.0, math.inf, open_low=True)
    if t_end / save_every > MOST_RECORDS:
        raise InputError(
            f"t_end = {t_end:g} with save_every = {save_every:g} makes more than "
            f"{MOST_RECORDS} records: give a larger save_every"
        )
    rtol = real_number("rtol", rtol, 1e-12, 1e-2)
    law = as_law(laws)
    begin = start_of(parameters, start, law)
    times = record_times(t_end, save_every)
    records, bond_forces, counters, ending = integrate(
        parameters, begin, times, rtol, anchoring, law
    )
    made = len(records)
    if made == 0:
        raise InputError(
            f"no force on the bonds balances the forces on an edge at tension = {begin.tension:g}: "
            "give another start"
        )
    status, message = _ENDINGS[ending]
    return _dataset(
        parameters,
        law,
        times[:made],
        records,
        bond_forces,
        {
            "status": status,
            "status_message": message,
            "end_time": float(times[made - 1]),
            "start": json.dumps(
                {"front": begin.front, "rear": begin.rear, "tension": begin.tension}
            ),
            "anchoring": json.dumps(vars(anchoring)),
            "laws": json.dumps(law.describe()),
            "rtol": rtol,
            "steps": int(counters[drive.STEPS]),
            "rejected_steps": int(counters[drive.REJECTED]),
        },
    )


def record_times(t_end: float, save_every: float) -> np.ndarray:
    """Return the times of the records: evenly spaced, and ``t_end``."""
    whole = math.floor(t_end / save_every * (1.0 + 1e-12))
    times = save_every * np.arange(whole + 1)
    if t_end - times[-1] > 1e-9 * save_every:
        return np.append(times, t_end)
    times[-1] = t_end
    return times


def integrate(
    parameters: Parameters,
    start: TwoEdges,
    times: np.ndarray,
    rtol: float,
    anchoring: Anchoring,
    laws: Law = PAPER,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
    """Return records (times, STATE), bond forces (times, 2), step counts, how the run ended."""
    springs = 0.5 * anchoring.stiffness
    constants = np.array([length_stiffness(parameters) + springs, springs, anchoring.relaxation])
    records, bond_forces = np.zeros((times.size, STATE)), np.empty((times.size, 2))
    records[0, [N_FRONT, N_REAR, TENSION]] = start.front, start.rear, start.tension
    counters = np.zeros(2, np.int64)
    ending, made = drive.run(
        laws.compiled,
        edge_of(parameters, laws, 2),
        times,
        constants,
        rtol,
        TENSION_SCALE,
        _MOST_STEPS,
        records,
        bond_forces,
        counters,
    )
    return records[:made], bond_forces[:made], counters, ending


def _dataset(
    p: Parameters,
    laws: Law,
    times: np.ndarray,
    records: np.ndarray,
    bond_forces: np.ndarray,
    attributes: dict[str, Any],
) -> xr.Dataset:
    bound = records[:, [N_FRONT, N_REAR]]
    tension = records[:, [TENSION]] + records[:, [IMBALANCE]] * np.array([1.0, -1.0])
    off_rates, velocity, friction = pointwise(
        laws, bond_forces, bound, tension, 0.0, edge_of(p, laws, 2)
    )
    outward = records[:, [X_FRONT, X_REAR]]
    edge = ("time", "edge")
    variables: dict[str, tuple[Any, np.ndarray, dict[str, str]]] = {
        "position": (
            edge,
            (1.0 + outward) * np.array([1.0, -1.0]),
            _about("position on the line", "R_0"),
        ),
        "velocity": (edge, velocity, _about("outward velocity of the edge", "R_0 k_off0")),
        "bound_fraction": (edge, bound, _about("fraction of bound linkers", "1")),
        "off_rate": (edge, off_rates, _about("off-rate of linkers", "k_off0")),
        "friction": (edge, friction, _about("friction (traction) on the edge", "zeta_0 v_beta")),
        "tension": ("time", records[:, TENSION], _about("membrane tension", "zeta_0 v_beta / 2")),
        "imbalance": (
            "time",
            records[:, IMBALANCE],
            _about("half the difference of the springs' pulls", "zeta_0 v_beta / 2"),
        ),
        "length": ("time", 2.0 + outward.sum(axis=1), _about("length of the cell", "R_0")),
    }
    coordinates = {
        "time": ("time", times, _about("time", "1/k_off0")),
        "edge": ("edge", ["front", "rear"]),
    }
    described = {"model": "two edges", "parameters": json.dumps(p.to_dict())}
    return xr.Dataset(variables, coordinates, {**described, **attributes})


def _about(long_name: str, units: str) -> dict[str, str]:
    return {"long_name": long_name, "units": units}
