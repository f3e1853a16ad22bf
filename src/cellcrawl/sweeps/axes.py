"""The values along an axis of a grid, as lists or ranges."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.laws import Law, as_law
from cellcrawl.parameters import DESCRIPTIONS, Schedule
from cellcrawl.simulation.start_tables import start_from_table
from cellcrawl.solvers import SOLVERS
from cellcrawl.starts import Start
from cellcrawl.surroundings import Surroundings, as_surroundings
from cellcrawl.validation import known_names, real_number, shown, whole_number

PARAMETERS: Final = (*DESCRIPTIONS, "elasticity")
OPTIONS: Final = tuple(
    dict.fromkeys(name for s in SOLVERS.values() for name in s.OPTIONS if name != "nodes")
)
SETTINGS: Final = ("t_end", "save_every", "solver", "nodes")
WORLD: Final = ("laws", "surroundings")
NAMES: Final = (*PARAMETERS, "seed", "start", "schedule", *WORLD, *SETTINGS, *OPTIONS)
"""Everything that may differ from run to run."""

_MOST_VALUES = 1_000_000
_RANGE = ("from", "to", "step", "count")


def axis_values(name: str, given: Any) -> tuple[Any, ...]:
    """Return the values of an axis: of a list, of a range, or a single one.

    Parameters
    ----------
    name : str
        One of `NAMES`.
    given : sequence, mapping or value
        A list; a range ``{from, to, step}`` or ``{from, to, count}``, both ends included; or one
        value.

    Raises
    ------
    InputError
        For an unknown name, an empty list, a value given twice or a range that cannot be.
    """
    known_names("the grid", [name], NAMES)
    if isinstance(given, Mapping) and "from" in given:
        given = _range(name, given)
    if isinstance(given, (str, Mapping, Start, Schedule, Surroundings)) or not isinstance(
        given, (Sequence, np.ndarray, range)
    ):
        given = [given]
    values = tuple(value_of(name, value) for value in given)
    if not values:
        raise InputError(f"axis {name} of the grid is empty: give at least one value, or leave it")
    seen: set[str] = set()
    for value in values:
        if repr(value) in seen:
            raise InputError(f"axis {name} of the grid has {shown(value)} twice")
        seen.add(repr(value))
    return values


def value_of(name: str, value: Any) -> Any:
    """Return a value of an axis or a point: numbers plain, starts and schedules made of tables."""
    if isinstance(value, np.generic):
        value = value.item()
    if name == "start" and isinstance(value, Mapping):
        return start_from_table(value)
    if name == "schedule" and isinstance(value, Mapping):
        return Schedule(value)
    if name == "laws":
        return as_law(value)
    if name == "surroundings":
        return as_surroundings(value)
    if name in DESCRIPTIONS:
        limits = DESCRIPTIONS[name]
        return real_number(name, value, limits.low, limits.high)
    if name == "seed":
        return whole_number("seed", value, 0, 2**63 - 1)
    return value


def plain(value: Any) -> Any:
    """Return a value of an axis as JSON has it."""
    if isinstance(value, (Start, Law, Surroundings)):
        return value.describe()
    return value.to_dict() if isinstance(value, Schedule) else value


def _range(name: str, given: Mapping[str, Any]) -> list[float]:
    known_names(f"the range of {name}", given, _RANGE)
    if "to" not in given or ("step" in given) == ("count" in given):
        raise InputError(f"the range of {name} must have from, to, and either step or count")
    first = real_number(f"{name} from", given["from"], -1e12, 1e12)
    last = real_number(f"{name} to", given["to"], -1e12, 1e12)
    if "count" in given:
        count = whole_number(f"{name} count", given["count"], 1, _MOST_VALUES)
        return [_tidy(name, value) for value in np.linspace(first, last, count).tolist()]
    step = real_number(f"{name} step", given["step"], -1e12, 1e12)
    steps = (last - first) / step if step else -1.0
    if steps < 0.0 or steps > _MOST_VALUES or abs(steps - round(steps)) > 1e-6:
        raise InputError(f"{name}: steps of {step:g} do not lead from {first:g} to {last:g}")
    return [_tidy(name, first + i * step) for i in range(round(steps) + 1)]


def _tidy(name: str, value: float) -> float:
    """0.1 + 2 * 0.1 is meant as 0.3; seeds and nodes are whole numbers."""
    tidy = round(value, 12)
    return int(tidy) if name in ("seed", "nodes") and tidy == int(tidy) else tidy
