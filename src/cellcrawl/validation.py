"""Checks that turn a bad value into one line naming the field, the value and what is allowed."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from cellcrawl.errors import InputError, nearest_name


def real_number(name: str, value: Any, low: float, high: float, *, open_low: bool = False) -> float:
    """Return ``value`` as a float within [low, high] (or (low, high]), or raise `InputError`."""
    allowed = f"a number {_interval(low, high, open_low)}"
    number = _as_float(name, value, allowed)
    if math.isnan(number) or not (low <= number <= high) or (open_low and number == low):
        raise InputError(f"{name} = {_shown(value)} is out of range: it must be {allowed}")
    return number


def whole_number(name: str, value: Any, low: int, high: int | None = None) -> int:
    """Return ``value`` as an int within [low, high], or raise `InputError`."""
    allowed = f"a whole number of at least {low}"
    if high is not None:
        allowed = f"a whole number from {low} to {high}"
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, float, np.number)):
        raise InputError(f"{name} = {_shown(value)} has the wrong type: it must be {allowed}")
    if isinstance(value, (complex, np.complexfloating)) or not math.isfinite(value):
        raise InputError(f"{name} = {_shown(value)} is out of range: it must be {allowed}")
    if int(value) != value or value < low or (high is not None and value > high):
        raise InputError(f"{name} = {_shown(value)} is out of range: it must be {allowed}")
    return int(value)


def one_of(name: str, value: Any, allowed: Iterable[str]) -> str:
    """Return ``value`` if it is one of the ``allowed`` words, or raise `InputError`."""
    words = list(allowed)
    if not isinstance(value, str) or value not in words:
        hint = f" ({nearest_name(value, words)})" if isinstance(value, str) else ""
        choices = ", ".join(repr(word) for word in words)
        raise InputError(
            f"{name} = {_shown(value)} is not known: it must be one of {choices}{hint}"
        )
    return value


def real_array(name: str, value: Any, shape: tuple[int | None, ...]) -> np.ndarray:
    """Return ``value`` as a finite float array of ``shape`` (None: any), or raise `InputError`."""
    wanted = "(" + ", ".join("any" if size is None else str(size) for size in shape) + ")"
    try:
        array = np.array(value, dtype=float)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{name} must be an array of numbers of shape {wanted}") from None
    if array.ndim != len(shape) or any(
        want is not None and have != want for have, want in zip(array.shape, shape, strict=True)
    ):
        raise InputError(f"{name} has shape {array.shape}: it must have shape {wanted}")
    bad = np.argwhere(~np.isfinite(array))
    if bad.size:
        where = tuple(int(i) for i in bad[0])
        raise InputError(f"{name} is not finite at index {where}: {array[where]}")
    return array


def known_names(what: str, given: Iterable[Any], known: Iterable[str]) -> None:
    """Raise `InputError` for the first of ``given`` that is not in ``known``."""
    known = list(known)
    for name in given:
        if name not in known:
            raise InputError(f"{what} has no {name!r}: {nearest_name(name, known)}")


def table(what: str, value: Any) -> Mapping[str, Any]:
    """Return ``value`` if it is a mapping, or raise `InputError`."""
    if not isinstance(value, Mapping):
        raise InputError(f"{what} must be a table of names and values, not {_shown(value)}")
    return value


def _as_float(name: str, value: Any, allowed: str) -> float:
    numeric = isinstance(value, (int, float, np.integer, np.floating))
    if not numeric or isinstance(value, (bool, np.bool_)):
        raise InputError(f"{name} = {_shown(value)} has the wrong type: it must be {allowed}")
    try:
        return float(value)
    except OverflowError:
        raise InputError(f"{name} is too large: it must be {allowed}") from None


def _interval(low: float, high: float, open_low: bool) -> str:
    if math.isinf(high):
        return f"above {low:g}, finite" if open_low else f"of at least {low:g}"
    return f"above {low:g}, up to {high:g}" if open_low else f"from {low:g} to {high:g}"


def _shown(value: Any) -> str:
    if isinstance(value, np.generic):
        value = value.item()
    text = repr(value).replace("\n", " ")
    return text if len(text) <= 60 else text[:57] + "..."
