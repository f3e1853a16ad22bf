"""Parameters that change during a run, by jump or ramp."""

from __future__ import annotations

import bisect
import itertools
from collections.abc import Mapping, Sequence
from typing import Any, Final

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.parameters.dimensionless import DESCRIPTIONS, Parameters
from cellcrawl.validation import known_names, real_number, shown, table

_LAWS: Final = "laws."


class Schedule:
    """Values of some parameters at given times; immutable.

    Between two times a value changes linearly; before the first and after the last it is held. A
    repeated time is a jump: the first value holds up to it, the second from it on.

    Parameters
    ----------
    changes : mapping of str to sequence of (time, value)
        For each parameter, its values at times in order. Times are dimensionless. A number of the
        law set is ``laws.`` and its name, as in ``laws.chi``.

    Raises
    ------
    InputError
        For an unknown parameter, times out of order, or a value out of the parameter's range.

    Examples
    --------
    >>> ramp = Schedule({"r_on": [(25.0, 16.0), (35.0, 30.0)]})
    >>> ramp.at(Parameters(), 30.0).r_on
    23.0
    >>> jump = Schedule({"r_on": [(25.0, 16.0), (25.0, 30.0)]})
    >>> jump.at(Parameters(), 25.0).r_on, jump.before(Parameters(), 25.0).r_on
    (30.0, 16.0)
    """

    def __init__(self, changes: Mapping[str, Sequence[tuple[float, float]]]) -> None:
        names = [name for name in table("Schedule", changes) if not _of_laws(name)]
        known_names("Schedule", names, DESCRIPTIONS)
        self._points = {name: _checked(name, points) for name, points in changes.items()}
        self._law_numbers = tuple(n.removeprefix(_LAWS) for n in self._points if _of_laws(n))
        times = {time for points in self._points.values() for time, _ in points}
        self._breaks = tuple(sorted(times))

    @checked
    def at(self, parameters: Parameters, time: float) -> Parameters:
        """Return ``parameters`` with the scheduled values that hold from ``time`` on."""
        return self._evaluate(parameters, time, bisect.bisect_right)

    @checked
    def before(self, parameters: Parameters, time: float) -> Parameters:
        """Return ``parameters`` with the scheduled values that hold up to ``time``."""
        return self._evaluate(parameters, time, bisect.bisect_left)

    @property
    def law_numbers(self) -> tuple[str, ...]:
        """Names of the law set's numbers that change."""
        return self._law_numbers

    @checked
    def laws_at(self, time: float, *, before: bool = False) -> dict[str, float]:
        """Return the scheduled numbers of the law set that hold from ``time`` on, or up to it."""
        side = bisect.bisect_left if before else bisect.bisect_right
        return {name: _value(self._points[_LAWS + name], time, side) for name in self.law_numbers}

    @property
    def breaks(self) -> tuple[float, ...]:
        """Times at which a value jumps or a ramp begins or ends, in order."""
        return self._breaks

    @checked
    def next_break(self, time: float) -> float:
        """Return the first break after ``time``, infinity if there is none."""
        later = bisect.bisect_right(self._breaks, time)
        return self._breaks[later] if later < len(self._breaks) else float("inf")

    @checked
    def varies(self, start: float, end: float) -> bool:
        """Whether any value ramps between the breaks around ``start`` and ``end``."""
        return any(
            first[0] < end and second[0] > start and first[1] != second[1]
            for points in self._points.values()
            for first, second in itertools.pairwise(points)
            if first[0] < second[0]
        )

    def to_dict(self) -> dict[str, list[list[float]]]:
        """Return the schedule as plain lists, for JSON and TOML."""
        return {name: [list(point) for point in points] for name, points in self._points.items()}

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Schedule) and self._points == other._points

    def __hash__(self) -> int:
        return hash(tuple(sorted(self._points.items())))

    def __repr__(self) -> str:
        return f"Schedule({self.to_dict()!r})"

    def _evaluate(self, parameters: Parameters, time: float, side: Any) -> Parameters:
        if not self._points:
            return parameters
        values = {
            name: _value(points, time, side)
            for name, points in self._points.items()
            if not _of_laws(name)
        }
        return parameters.replace(**values) if values else parameters


def _of_laws(name: Any) -> bool:
    return isinstance(name, str) and name.startswith(_LAWS)


def _checked(name: str, points: Any) -> tuple[tuple[float, float], ...]:
    try:
        pairs = [(time, value) for time, value in points]
        if isinstance(points, (str, Mapping)):
            raise TypeError
    except (TypeError, ValueError):
        raise InputError(f"Schedule {name} must be a list of (time, value) pairs") from None
    if not pairs:
        raise InputError(f"Schedule {name} is empty: give at least one (time, value) pair")
    low, high = -1e300, 1e300  # of a law's number, whose range is known when its law is
    if not _of_laws(name):
        low, high = DESCRIPTIONS[name].low, DESCRIPTIONS[name].high
    checked = tuple(
        (
            real_number(f"Schedule {name} time", time, -1e12, 1e12),
            real_number(f"Schedule {name} at t = {shown(time)}", value, low, high),
        )
        for time, value in pairs
    )
    times = [time for time, _ in checked]
    if times != sorted(times):
        late = next(i for i in range(1, len(times)) if times[i] < times[i - 1])
        raise InputError(
            f"Schedule {name} has times out of order: {times[late]:g} after {times[late - 1]:g}"
        )
    if any(first == third for first, third in zip(times, times[2:], strict=False)):
        raise InputError(f"Schedule {name} has a time three times: two make a jump")
    return checked


def _value(points: tuple[tuple[float, float], ...], time: float, side: Any) -> float:
    following: int = side(points, time, key=lambda point: point[0])
    if following == 0:
        return points[0][1]
    if following == len(points):
        return points[-1][1]
    (t0, v0), (t1, v1) = points[following - 1], points[following]
    between = v0 + (v1 - v0) * ((time - t0) / (t1 - t0))
    if time == t1:
        return v1
    return min(max(between, min(v0, v1)), max(v0, v1))  # rounding must not leave the range


CONSTANT = Schedule({})
