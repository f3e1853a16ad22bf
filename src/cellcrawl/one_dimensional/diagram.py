"""Which regime two edges settle into over two parameters, from several starts."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.laws import as_law
from cellcrawl.laws.law import PAPER, Law
from cellcrawl.linear.characteristic import two_axes
from cellcrawl.linear.level_curves import level_curves
from cellcrawl.one_dimensional import drive
from cellcrawl.one_dimensional.cell import FREE, Anchoring, checked_cell
from cellcrawl.one_dimensional.regimes import FAILED, LATE, REGIMES, THRESHOLD, Regime, measured
from cellcrawl.one_dimensional.rosenbrock import N_FRONT, N_REAR, X_FRONT, X_REAR
from cellcrawl.one_dimensional.starts import STARTS, TwoEdges, start_of
from cellcrawl.one_dimensional.theory import crawling_margin, margin
from cellcrawl.one_dimensional.two_edges import integrate
from cellcrawl.parameters import DESCRIPTIONS, Parameters
from cellcrawl.validation import known_names, one_of, real_number

_RECORDS = 400
_LONGEST = 1e4
_MOST = 1_000_000
_GRID = (60, 200)
BOUNDARIES = ("symmetric", "antisymmetric", "crawling")


@checked
def phase_diagram(
    parameters: Parameters,
    *,
    starts: Sequence[str] = ("small", "large", "in_phase"),
    t_end: float = 60.0,
    rtol: float = 1e-4,
    anchoring: Anchoring = FREE,
    laws: Any = PAPER,
    **ranges: Any,
) -> xr.Dataset:
    """Label the regime of two edges over any two parameters by the rule of `regime`.

    Parameters
    ----------
    parameters : Parameters
        The cell, which gives all other parameters and the tension law.
    starts : sequence of {"small", "large", "in_phase"}
        Where each cell begins; differences between them are bistability.
    t_end : float
        How long each runs, 1 to 10000; what comes after 0.6 of it is looked at.
    rtol : float
        Error allowed in a step, 1e-12 to 1e-2.
    anchoring : Anchoring
        Springs to the cell body; none unless given.
    laws : Law or str
        The law set; the paper's unless given.
    **ranges : array
        The two parameters by name, each with its increasing values; the first is the first axis:
        ``phase_diagram(p, r_on=np.linspace(5, 80, 40), zeta_1=np.linspace(300, 1000, 40))``.

    Returns
    -------
    Dataset
        Over start and both parameters: ``regime``, an index into ``attrs["regimes"]``, ``speed``
        (mean, of the cell's middle), ``swing`` and ``polarity`` of the bound fractions, and
        ``settled``, which is False where a run was still changing. Over both parameters
        ``bistable``: whether starts that settled ended in different regimes.

    Raises
    ------
    InputError
        For other than two parameters, unknown names or starts, or values out of range.
    """
    checked_cell(parameters, anchoring)
    law = as_law(laws)
    axes = two_axes("a phase diagram", ranges)
    starts = [starts] if isinstance(starts, str) else list(starts)
    if not starts:
        raise InputError(f"starts is empty: known names: {', '.join(STARTS)}")
    known_names("phase_diagram", starts, STARTS)
    t_end = real_number("t_end", t_end, 1.0, _LONGEST)
    rtol = real_number("rtol", rtol, 1e-12, 1e-2)
    (first, x), (second, y) = axes.items()
    shape = (len(starts), x.size, y.size)
    if x.size * y.size * len(starts) > _MOST:
        raise InputError(f"a diagram of {shape} runs is too large: it may have {_MOST}")
    times = np.concatenate([[0.0], np.linspace(LATE * t_end, t_end, _RECORDS)])
    found = {name: np.zeros(shape) for name in ("speed", "swing", "polarity")}
    codes, settled = np.zeros(shape, np.int8), np.zeros(shape, bool)
    for i, j in np.ndindex(x.size, y.size):
        cell = parameters.replace(**{first: float(x[i]), second: float(y[j])})
        for k, name in enumerate(starts):
            label = _label(cell, start_of(cell, name, law), times, rtol, anchoring, law)
            codes[k, i, j] = REGIMES.index(label.name)
            settled[k, i, j] = label.settled
            for measure, values in found.items():
                values[k, i, j] = getattr(label, measure)
    dims = ("start", first, second)
    about = {
        "speed": {"long_name": "mean speed of the cell's middle", "units": "R_0 k_off0"},
        "swing": {"long_name": "how far the bound fraction both rises and falls", "units": "1"},
        "polarity": {"long_name": "largest difference of bound fraction", "units": "1"},
    }
    variables: dict[str, Any] = {
        "regime": (dims, codes, {"long_name": "regime, an index into attrs['regimes']"}),
        "settled": (dims, settled, {"long_name": "whether the run had stopped changing"}),
        **{name: (dims, values, about[name]) for name, values in found.items()},
        "bistable": (
            dims[1:],
            _differ(codes, settled),
            {"long_name": "whether starts ended in different regimes"},
        ),
    }
    coordinates = {
        "start": ("start", starts),
        **{name: (name, v, {"long_name": DESCRIPTIONS[name].meaning}) for name, v in axes.items()},
    }
    attributes = {
        "model": "two edges",
        "parameters": json.dumps(parameters.to_dict()),
        "anchoring": json.dumps(vars(anchoring)),
        "laws": json.dumps(law.describe()),
        "regimes": json.dumps(REGIMES),
        "t_end": t_end,
        "rtol": rtol,
    }
    return xr.Dataset(variables, coordinates, attributes)


@checked
def boundaries(
    parameters: Parameters,
    which: str,
    *,
    anchoring: Anchoring = FREE,
    laws: Any = PAPER,
    **ranges: Any,
) -> list[np.ndarray]:
    """Curves of theory in the plane of two parameters, to lay over a phase diagram.

    Parameters
    ----------
    parameters : Parameters
        The cell, which gives all other parameters and the tension law.
    which : {"symmetric", "antisymmetric", "crawling"}
        Where the still cell starts to stick and slip in phase, where it starts to lose its
        symmetry, or where steady crawling begins to exist (stable or not).
    anchoring : Anchoring
        Springs to the cell body; none unless given.
    laws : Law or str
        The law set; the paper's unless given. Others take some seconds.
    **ranges : array
        The two parameters by name, each with at least the two ends of its range.

    Returns
    -------
    list of array, shape (vertices, 2)
        The branches, with the unstable side, or that of crawling, on the left when the first
        parameter points right and the second up.

    Raises
    ------
    InputError
        For an unknown name, other than two parameters, or values out of range.
    """
    checked_cell(parameters, anchoring)
    law = as_law(laws)
    one_of("which", which, BOUNDARIES)
    (first, x), (second, y) = two_axes("a phase diagram", ranges).items()

    def field(at_x: np.ndarray, at_y: np.ndarray) -> np.ndarray:
        values = {first: np.asarray(at_x, float), second: np.asarray(at_y, float)}
        if which == "crawling":
            return crawling_margin(parameters, anchoring, values, law)
        return margin(parameters, which, anchoring, values, law)

    lines = (np.linspace(axis[0], axis[-1], int(np.clip(axis.size, *_GRID))) for axis in (x, y))
    return level_curves(field, *lines)


def _label(
    cell: Parameters,
    start: TwoEdges,
    times: np.ndarray,
    rtol: float,
    anchoring: Anchoring,
    laws: Law,
) -> Regime:
    records, _, _, ending = integrate(cell, start, times, rtol, anchoring, laws)
    if ending != drive.REACHED:
        return FAILED
    late = records[1:]
    middle = 0.5 * (late[:, X_FRONT] - late[:, X_REAR])
    speed = float((middle[-1] - middle[0]) / (times[-1] - times[1]))
    return measured(late[:, [N_FRONT, N_REAR]], THRESHOLD, speed)


def _differ(codes: np.ndarray, settled: np.ndarray) -> np.ndarray:
    lowest = np.where(settled, codes, len(REGIMES)).min(axis=0)
    highest = np.where(settled, codes, -1).max(axis=0)
    different: np.ndarray = highest > lowest
    return different
