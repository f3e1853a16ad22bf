"""What is thought possible before a cell is seen: independent ranges of parameters and units."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.laws import as_law
from cellcrawl.laws.law import Law
from cellcrawl.parameters import DESCRIPTIONS, Parameters
from cellcrawl.validation import known_names, listed, one_of, real_number, shown, table

TIME_UNIT: Final = "time_unit"
LENGTH_UNIT: Final = "length_unit"
UNITS: Final = {TIME_UNIT: "s", LENGTH_UNIT: "µm"}
"""Sizes of the model's units: how many seconds 1/k_off0 lasts, how many micrometres R_0 is."""
LAWS: Final = "laws."
SCALES: Final = ("linear", "log")


@checked
@dataclass(frozen=True)
class Range:
    """A number between two bounds, each value as likely, or each factor as likely ("log").

    Parameters
    ----------
    low, high : float
        The bounds; both above zero for ``scale="log"``.
    scale : {"linear", "log"}
        What is spread evenly: the number, or its logarithm.

    Raises
    ------
    InputError
        For bounds that leave nothing between them.
    """

    low: float
    high: float
    scale: str = "linear"

    def __post_init__(self) -> None:
        one_of("scale", self.scale, SCALES)
        low = real_number("low", self.low, -1e30, 1e30)
        high = real_number("high", self.high, -1e30, 1e30)
        if not low < high:
            raise InputError(f"a range goes from low to high, not from {low:g} to {high:g}")
        if self.scale == "log" and low <= 0.0:
            raise InputError(f"a range of factors is above zero, not from {low:g}")
        object.__setattr__(self, "low", low)
        object.__setattr__(self, "high", high)

    def value(self, part: np.ndarray) -> np.ndarray:
        """Return the values at parts 0 to 1 of the range."""
        if self.scale == "log":
            return np.asarray(np.exp(self._ends[0] + part * (self._ends[1] - self._ends[0])))
        return np.asarray(self.low + part * (self.high - self.low))

    def part(self, value: np.ndarray) -> np.ndarray:
        """Return where values lie in the range, 0 to 1 within it."""
        values = np.asarray(value, float)
        scaled = np.log(np.maximum(values, 1e-300)) if self.scale == "log" else values
        return np.asarray((scaled - self._ends[0]) / (self._ends[1] - self._ends[0]))

    @property
    def _ends(self) -> tuple[float, float]:
        if self.scale == "log":
            return math.log(self.low), math.log(self.high)
        return self.low, self.high

    def __str__(self) -> str:
        how = ", evenly in its logarithm" if self.scale == "log" else ""
        return f"{self.low:g} to {self.high:g}{how}"


def as_range(name: str, given: Any) -> Range:
    """Return a range from itself, a pair, or ``{"low", "high", "scale"}``."""
    if isinstance(given, Range):
        return given
    if isinstance(given, Mapping):
        known_names(f"the range of {name}", given, ("low", "high", "scale"))
        if "low" not in given or "high" not in given:
            raise InputError(f"the range of {name} needs low and high")
        return Range(given["low"], given["high"], given.get("scale", "linear"))
    ends = listed(name, given, "a range, as (15, 40) or Range(0.02, 0.2, 'log')")
    if len(ends) not in (2, 3):
        raise InputError(f"{name} must be a range, as (15, 40), not {shown(given)}")
    try:
        return Range(*ends)
    except InputError as error:
        raise InputError(f"{name}: {error}") from None


@checked
class Prior:
    """Independent ranges, by name; immutable.

    Parameters
    ----------
    ranges : mapping of str to Range
        Of any field of `Parameters` (``r_on``, ``zeta_1``, ...), of a law's own numbers as
        ``laws.gain``, and of the units ``time_unit`` (s) and ``length_unit`` (µm). A pair
        ``(low, high)`` is a range whose values are as likely each; ``(low, high, "log")`` spreads
        the logarithm.

    Raises
    ------
    InputError
        For an unknown name, a range beyond what the model takes, or no parameter at all.

    Examples
    --------
    >>> prior = Prior({"r_on": (15, 40), "D": (0.02, 0.2, "log"), "time_unit": (5, 20, "log")})
    >>> prior.cell_names, prior.unit_names
    (('r_on', 'D'), ('time_unit',))
    """

    def __init__(self, ranges: Mapping[str, Any]) -> None:
        given = table("the prior", ranges)
        found: dict[str, Range] = {}
        for name, value in given.items():
            if isinstance(name, str) and name.startswith(LAWS):
                found[name] = as_range(name, value)
                continue
            known_names("the prior", [name], (*DESCRIPTIONS, *UNITS))
            found[name] = as_range(name, value)
            limits = DESCRIPTIONS.get(name)
            low, high = (1e-12, 1e12) if limits is None else (limits.low, limits.high)
            if found[name].low < low or found[name].high > high:
                raise InputError(
                    f"the prior of {name}, {found[name]}, is beyond what it can be: {low:g} to "
                    f"{high:g}"
                )
        # Units last: those of the cell are what a run needs, those of the picture come after.
        ordered = sorted(found, key=lambda name: name in UNITS)
        self.ranges: Mapping[str, Range] = {name: found[name] for name in ordered}
        if not self.cell_names:
            raise InputError("the prior has no parameter of the cell: give one, as r_on=(15, 40)")

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all that is unknown: of the cell first, then of the units."""
        return tuple(self.ranges)

    @property
    def cell_names(self) -> tuple[str, ...]:
        """Names of the parameters of the cell and its law."""
        return tuple(name for name in self.ranges if name not in UNITS)

    @property
    def unit_names(self) -> tuple[str, ...]:
        """Names of the units that are unknown."""
        return tuple(name for name in self.ranges if name in UNITS)

    def draw(self, runs: range, seed: int) -> np.ndarray:
        """Return the cell parameters of runs, shape (runs, names), the same for the same run."""
        parts = np.array(
            [np.random.default_rng((seed, run)).random(len(self.cell_names)) for run in runs]
        ).reshape(len(runs), len(self.cell_names))
        return np.column_stack(
            [self.ranges[name].value(parts[:, i]) for i, name in enumerate(self.cell_names)]
        )

    def check_law(self, law: Law) -> None:
        """Refuse numbers that a law does not have, or cannot take."""
        for name in self.cell_names:
            if not name.startswith(LAWS):
                continue
            own = name.removeprefix(LAWS)
            known_names(f"the law {type(law).__name__}", [own], law.parameters)
            for end in (self.ranges[name].low, self.ranges[name].high):
                law.replace(**{own: end})

    def replace(self, **changes: Any) -> Prior:
        """Return the same prior with other ranges; None leaves one out."""
        kept = {**self.ranges, **changes}
        return Prior({name: value for name, value in kept.items() if value is not None})

    def describe(self) -> dict[str, Any]:
        """Return the ranges as plain values, from which the prior can be made again."""
        return {
            name: {"low": r.low, "high": r.high, "scale": r.scale}
            for name, r in self.ranges.items()
        }

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Prior) and self.describe() == other.describe()

    def __hash__(self) -> int:
        return hash(repr(self.describe()))

    def __repr__(self) -> str:
        return "Prior(" + "; ".join(f"{name}: {r}" for name, r in self.ranges.items()) + ")"


def unit_of(name: str) -> str:
    """Return the unit of a parameter, "" for numbers without."""
    return UNITS.get(name, "")


def meaning_of(name: str) -> str:
    """Return what a parameter is, in a few words."""
    if name in UNITS:
        return {TIME_UNIT: "lifetime 1/k_off0 of an unstressed linker", LENGTH_UNIT: "radius R_0"}[
            name
        ]
    if name.startswith(LAWS):
        return f"{name.removeprefix(LAWS)} of the law"
    return DESCRIPTIONS[name].meaning


def point_of(names: tuple[str, ...], values: np.ndarray, law: Law) -> dict[str, Any]:
    """Return one run's parameters as a point of a sweep's grid."""
    named = dict(zip(names, (float(value) for value in values), strict=True))
    point: dict[str, Any] = {n: v for n, v in named.items() if not n.startswith(LAWS)}
    own = {n.removeprefix(LAWS): v for n, v in named.items() if n.startswith(LAWS)}
    return {**point, "laws": law.replace(**own)} if own else point


def law_named(given: Any) -> Law:
    """Return a law set from itself or its name."""
    return as_law(given)


PAPER_PRIOR: Final = Prior(
    {
        "r_on": Range(15.0, 40.0),
        "zeta_1": Range(450.0, 750.0),
        "D": Range(0.02, 0.2, "log"),
        "epsilon": Range(5e-4, 2e-3, "log"),
        TIME_UNIT: Range(6.25, 16.0, "log"),
    }
)
"""Around the paper's cells, with a lifetime 1/k_off0 about the 10 s of `Scales`."""

assert set(PAPER_PRIOR.cell_names) <= set(Parameters.field_names())
