"""What a verification is made of: checks, and the results they measure."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

HOLDS = "holds"
FAILS = "FAILS"
AS_DOCUMENTED = "does not hold, as documented"


@dataclass(frozen=True)
class Result:
    """One statement, what was expected of it and what was measured; immutable.

    Parameters
    ----------
    what : str
        The statement, in our own words.
    expected : str
        What must be measured for it to hold.
    measured : str
        What was measured.
    holds : bool
        Whether it does.
    where : str
        For a claim of the paper, where it stands there.
    known_not_to_hold : str
        Why the statement is known not to hold; empty if it should. Then it fails if it holds: the
        truth has changed.
    note : str
        What else a reader should know.
    values : mapping of str to float
        The numbers behind ``measured``.
    """

    what: str
    expected: str
    measured: str
    holds: bool
    where: str = ""
    known_not_to_hold: str = ""
    note: str = ""
    values: Mapping[str, float] = field(default_factory=dict)

    @property
    def passed(self) -> bool:
        """Whether what was measured is what we say is true."""
        return self.holds is not bool(self.known_not_to_hold)

    @property
    def verdict(self) -> str:
        """The verdict in words."""
        if not self.passed:
            return FAILS
        return HOLDS if self.holds else AS_DOCUMENTED

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {
            **dataclasses.asdict(self),
            "values": {name: float(value) for name, value in self.values.items()},
            "passed": self.passed,
            "verdict": self.verdict,
        }


@dataclass(frozen=True)
class Check:
    """Something to verify: a name, the part it belongs to, and what measures it; immutable.

    Parameters
    ----------
    name : str
        A name to ask for it by.
    part : str
        The chapter it belongs to.
    measure : callable
        A function of a module, so that another process finds it. It is given whether the long
        version is wanted and returns results.
    only_in_full : bool
        Whether it takes part in the long verification only.
    """

    name: str
    part: str
    measure: Callable[[bool], Iterable[Result]]
    only_in_full: bool = False


@dataclass(frozen=True)
class Outcome:
    """What a check measured, and the seconds it took; immutable."""

    check: str
    part: str
    results: tuple[Result, ...]
    seconds: float

    @property
    def passed(self) -> bool:
        """Whether every result passed; a check without results did not."""
        return bool(self.results) and all(result.passed for result in self.results)


def at_most(what: str, found: float, limit: float, **rest: Any) -> Result:
    """Return the result that ``found`` is a number of at most ``limit``."""
    holds = bool(math.isfinite(found) and found <= limit)
    return Result(what, f"at most {limit:g}", f"{found:.2g}", holds, **_with(found, rest))


def at_least(what: str, found: float, limit: float, **rest: Any) -> Result:
    """Return the result that ``found`` is a number of at least ``limit``."""
    holds = bool(math.isfinite(found) and found >= limit)
    return Result(what, f"at least {limit:g}", f"{found:.3g}", holds, **_with(found, rest))


def near(what: str, found: float, target: float, within: float, **rest: Any) -> Result:
    """Return the result that ``found`` is ``target`` within ``within``."""
    holds = bool(math.isfinite(found) and abs(found - target) <= within)
    places = max(0, 1 - math.floor(math.log10(within)))
    expected = f"{target:.{places}f} within {within:g}"
    return Result(what, expected, f"{found:.{places}f}", holds, **_with(found, rest))


def complex_text(value: complex) -> str:
    """Return a rate as text: ``-77``, ``4.65 + 15.5i``."""
    if value.imag == 0.0:
        return f"{value.real:.4g}"
    return f"{value.real:.4g} {'+' if value.imag > 0.0 else '-'} {abs(value.imag):.4g}i"


def _with(found: float, rest: dict[str, Any]) -> dict[str, Any]:
    note = {"found": float(found)}
    return {**rest, "values": {**note, **rest.get("values", {})}}
