"""Runs of a flat edge: bound fraction, off-rate and height along a periodic line."""

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
from cellcrawl.one_dimensional import runge_kutta
from cellcrawl.one_dimensional.cell import checked_cell, edge_of, still_tension
from cellcrawl.one_dimensional.flat_starts import FlatNoise, FlatSetting, FlatStart
from cellcrawl.one_dimensional.flat_theory import LONGEST, TENSION_LAWS, uniform_states
from cellcrawl.one_dimensional.two_edges import TENSION_SCALE, record_times
from cellcrawl.parameters import Parameters
from cellcrawl.solvers.base import pointwise
from cellcrawl.validation import one_of, real_number, shown, whole_number

_FEWEST, _MOST_NODES = 16, 8192
_NODE = 0.5
"""Distance between nodes, over the width of a front."""
_HEIGHT_SCALE = 0.1
_MOST_STEPS = 5_000_000
_MOST_VALUES = 20_000_000
_STIFFEST = 1e9
_RESOLVED = 1e-3
_ENDINGS: Final = {
    runge_kutta.REACHED: ("completed", "reached t_end"),
    runge_kutta.NO_ROOT: (
        "out_of_range",
        "no off-rate r >= 1 balances the forces somewhere: the edge is too concave for the model",
    ),
    runge_kutta.STEP_TOO_SMALL: (
        "step_too_small",
        "the tolerance could not be met with any reasonable step: try a looser rtol",
    ),
    runge_kutta.TOO_MANY_STEPS: (
        "step_too_small",
        "too many steps: try fewer nodes, a looser rtol or a shorter run",
    ),
}


@checked
def simulate_flat_edge(
    parameters: Parameters,
    t_end: float = 10.0,
    *,
    tension: float | None = None,
    tension_law: str = "fixed",
    length: float = 2.0 * math.pi,
    start: FlatStart | None = None,
    anchoring: float = 0.0,
    nodes: int | None = None,
    save_every: float = 0.02,
    rtol: float = 1e-5,
    laws: Any = PAPER,
) -> xr.Dataset:
    """Simulate a flat edge, periodic along its length.

    Parameters
    ----------
    parameters : Parameters
        The cell.
    t_end : float
        Until when.
    tension : float, optional
        Membrane tension (at time 0, for the elastic law); that at which a flat edge stands still
        unless given.
    tension_law : {"fixed", "elastic"}
        Hold the tension, or let it follow the area the edge sweeps, ``sigma_t = G`` times the
        integral of the velocity along the edge, as in a whole cell.
    length : float
        Length of the edge, above 0, up to 10000; that of the round cell unless given.
    start : FlatNoise, FlatWave, StuckPatch or FlatFields
        How it begins; random waves unless given. Any object with their method ``fields`` will do.
    anchoring : float
        Stiffness of springs that pull each point back by ``anchoring * height``: those of
        `Anchoring` with a body that never moves. Not part of the two-dimensional model.
    nodes : int, optional
        16 to 8192; enough for two a width of the sharpest front unless given.
    save_every : float
        Time between records.
    rtol : float
        Error allowed in a step: this much in the bound fraction, a tenth of it in the height, a
        hundred times as much in the tension; 1e-10 to 1e-2.
    laws : Law or str
        The law set, as for `cellcrawl.simulate`; the paper's unless given.

    Returns
    -------
    Dataset
        Over time and s: ``bound_fraction``, ``off_rate``, ``height`` (how far the edge is out),
        ``curvature`` (minus the second derivative of the height), ``velocity``, ``friction``. Over
        time: ``tension``. ``attrs`` hold ``status`` and ``status_message``, the parameters, the
        numbers of steps, ``largest_slope`` of the height, which the theory takes as small, and
        ``unresolved``: how much of the contrast of the bound fraction is in the shortest third of
        the waves, at most.

    Raises
    ------
    InputError
        For values out of range or a start that is none.

    Notes
    -----
    Where the largest slope is not small against 1 the curvature is overstated and the linkers'
    spread along the edge too; the equations remain those of a gentle slope.

    Examples
    --------
    >>> from cellcrawl import Parameters, one_dimensional
    >>> run = one_dimensional.simulate_flat_edge(Parameters(), 0.1)
    >>> run.attrs["status"]
    'completed'
    """
    checked_cell(parameters)
    p = parameters
    t_end = real_number("t_end", t_end, 0.0, math.inf, open_low=True)
    save_every = real_number("save_every", save_every, 0.0, math.inf, open_low=True)
    length = real_number("length", length, 0.0, LONGEST, open_low=True)
    one_of("tension_law", tension_law, TENSION_LAWS)
    springs = real_number("anchoring", anchoring, 0.0, _STIFFEST)
    rtol = real_number("rtol", rtol, 1e-10, 1e-2)
    law = as_law(laws)
    held = still_tension(p, law) if tension is None else tension
    uniform_states(p, held, law)
    count = _nodes_for(p, length) if nodes is None else nodes
    count = whole_number("nodes", count, _FEWEST, _MOST_NODES)
    if t_end / save_every * count > _MOST_VALUES:
        raise InputError(
            f"t_end = {t_end:g} with save_every = {save_every:g} and {count} nodes makes more than "
            f"{_MOST_VALUES} values: give a larger save_every"
        )
    s = length / count * np.arange(count)
    begin = FlatNoise() if start is None else start
    if not hasattr(begin, "fields"):
        raise InputError(
            f"start = {shown(start)} is no start of a flat edge: give FlatNoise, FlatWave, "
            "StuckPatch or FlatFields"
        )
    bound, height = begin.fields(FlatSetting(p, float(held), s, length, tension_law, springs, law))
    times = record_times(t_end, save_every)
    records = np.empty((times.size, 2 * count + 1))
    records[0] = np.concatenate([bound, height, [held]])
    bond_forces, curvatures = np.empty((times.size, count)), np.empty((times.size, count))
    counters = np.zeros(2, np.int64)
    rate = p.tension_rate if tension_law == "elastic" else 0.0
    constants = np.array([p.D, length / count, rate, springs])
    scales = np.array([1.0, _HEIGHT_SCALE, TENSION_SCALE])
    ending, made = runge_kutta.run(
        law.compiled,
        edge_of(p, law, count),
        times,
        constants,
        rtol,
        scales,
        _MOST_STEPS,
        records,
        bond_forces,
        curvatures,
        counters,
    )
    if made == 0:
        raise InputError(
            "this start has no off-rate somewhere: it is too concave for this tension; give a "
            "gentler height, a smaller amplitude or a lower tension"
        )
    status, message = _ENDINGS[ending]
    return _dataset(
        p,
        law,
        (times[:made], s, records[:made], bond_forces[:made], curvatures[:made]),
        length / count,
        {
            "status": status,
            "status_message": message,
            "end_time": float(times[made - 1]),
            "tension_law": tension_law,
            "length": length,
            "anchoring": springs,
            "laws": json.dumps(law.describe()),
            "rtol": rtol,
            "steps": int(counters[runge_kutta.STEPS]),
            "rejected_steps": int(counters[runge_kutta.REJECTED]),
        },
    )


def _nodes_for(p: Parameters, length: float) -> int:
    """Return an even number of nodes that shows fronts of the least width."""
    wanted = length / (_NODE * math.sqrt(p.D / (p.r_on + p.r_p)))
    if wanted > _MOST_NODES:
        raise InputError(
            f"length = {length:g} at D = {p.D:g} needs {wanted:.0f} nodes, more than "
            f"{_MOST_NODES}: give a shorter edge, a larger D, or nodes"
        )
    return max(_FEWEST, 2 * math.ceil(0.5 * wanted))


def _unresolved(bound: np.ndarray) -> float:
    spectrum = np.abs(np.fft.rfft(bound, axis=1))[:, 1:]
    contrast = spectrum.max(axis=1)
    tail = spectrum[:, 2 * spectrum.shape[1] // 3 :].max(axis=1)
    seen = contrast > 1e-6 * bound.shape[1]
    return float(np.max(tail[seen] / contrast[seen], initial=0.0))


def _dataset(
    p: Parameters,
    laws: Law,
    arrays: tuple[np.ndarray, ...],
    spacing: float,
    attributes: dict[str, Any],
) -> xr.Dataset:
    times, s, records, bond_forces, curvatures = arrays
    bound, height = records[:, : s.size], records[:, s.size : -1]
    off_rates, velocity, friction = pointwise(
        laws, bond_forces, bound, records[:, [-1]], curvatures, edge_of(p, laws, s.size)
    )
    slope = (np.roll(height, -1, axis=1) - height) / spacing
    edge = ("time", "s")
    variables: dict[str, tuple[Any, np.ndarray, dict[str, str]]] = {
        "bound_fraction": (edge, bound, _about("fraction of bound linkers", "1")),
        "off_rate": (edge, off_rates, _about("off-rate of linkers", "k_off0")),
        "height": (edge, height, _about("how far the edge is out", "R_0")),
        "curvature": (edge, curvatures, _about("curvature of the edge", "1/R_0")),
        "velocity": (edge, velocity, _about("outward velocity of the edge", "R_0 k_off0")),
        "friction": (edge, friction, _about("friction (traction) on the edge", "zeta_0 v_beta")),
        "tension": ("time", records[:, -1], _about("membrane tension", "zeta_0 v_beta / 2")),
    }
    coordinates = {
        "time": ("time", times, _about("time", "1/k_off0")),
        "s": ("s", s, _about("position along the edge", "R_0")),
    }
    described = {
        "model": "flat edge",
        "parameters": json.dumps(p.to_dict()),
        "largest_slope": float(np.abs(slope).max()),
        "unresolved": _unresolved(bound),
    }
    return xr.Dataset(variables, coordinates, {**described, **attributes})


def _about(long_name: str, units: str) -> dict[str, str]:
    return {"long_name": long_name, "units": units}
