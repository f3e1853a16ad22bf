"""Checks that turn a bad value into one line naming the field, the value and what is allowed."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from cellcrawl.errors import InputError, close_name, nearest_name


def real_number(
    name: str, value: Any, low: float, high: float, *, open_low: bool = False, unit: str = ""
) -> float:
    """Return ``value`` as a finite float from low (or above it) to high, or raise `InputError`."""
    allowed = f"a number {_interval(low, high, open_low)} {unit}".rstrip()
    value = plain_number(value)
    number = _as_float(name, value, allowed)
    if not (math.isfinite(number) and low <= number <= high) or (open_low and number == low):
        raise InputError(f"{name} = {shown(value)} is out of range: it must be {allowed}")
    return number


def whole_number(name: str, value: Any, low: int, high: int | None = None) -> int:
    """Return ``value`` as an int within [low, high], or raise `InputError`."""
    allowed = f"a whole number of at least {low}"
    if high is not None:
        allowed = f"a whole number from {low} to {high}"
    value = plain_number(value)
    if not is_real(value):
        raise InputError(f"{name} = {shown(value)} has the wrong type: it must be {allowed}")
    whole = int(value) if isinstance(value, (int, np.integer)) or math.isfinite(value) else None
    if whole is None or whole != value or whole < low or (high is not None and whole > high):
        raise InputError(f"{name} = {shown(value)} is out of range: it must be {allowed}")
    return whole


def one_of(name: str, value: Any, allowed: Iterable[str]) -> str:
    """Return ``value`` if it is one of the ``allowed`` words, or raise `InputError`."""
    words = list(allowed)
    if not isinstance(value, str) or value not in words:
        near = close_name(value, words)
        hint = f" (did you mean {near!r}?)" if near else ""
        choices = ", ".join(repr(word) for word in words)
        raise InputError(f"{name} = {shown(value)} is not known: it must be one of {choices}{hint}")
    return str(value)


def real_array(name: str, value: Any, shape: tuple[int | None, ...] | None) -> np.ndarray:
    """Return a finite float array of ``shape`` (None: any size, or any shape), or raise.

    What lies under a NumPy mask is no data: an array with masked values is refused.
    """
    wanted = "any shape"
    if shape is not None:
        sizes = ("any" if size is None else str(size) for size in shape)
        wanted = f"shape ({', '.join(sizes)})"
    try:
        given = np.asarray(value)
    except Exception:  # an object of anybody's may raise anything
        given = np.asarray(None)
    if given.dtype.kind not in "iuf":
        raise InputError(f"{name} must be an array of numbers of {wanted}")
    array = np.array(given, dtype=float)
    if shape is not None and (
        array.ndim != len(shape)
        or any(want not in (None, have) for have, want in zip(array.shape, shape, strict=True))
    ):
        raise InputError(f"{name} has shape {array.shape}: it must have {wanted}")
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        where = tuple(int(i) for i in np.argwhere(np.ma.getmaskarray(value))[0])
        raise InputError(f"{name} is masked at index {where}: leave masked values out")
    bad = np.argwhere(~np.isfinite(array))
    if len(bad):
        where = tuple(int(i) for i in bad[0])
        place = f" at index {where}" if where else ""
        raise InputError(f"{name} is not finite{place}: {array[where]}")
    return array


def without_masked(*columns: Any) -> tuple[Any, ...]:
    """Return columns of one length without the rows in which any of them is masked."""
    if not any(isinstance(column, np.ma.MaskedArray) for column in columns):
        return columns
    sizes = {np.shape(column) for column in columns}
    if len(sizes) > 1:
        return columns  # refused where the sizes are checked
    kept = ~np.any([np.ma.getmaskarray(np.ma.asarray(column)) for column in columns], axis=0)
    return tuple(np.ma.getdata(np.ma.asarray(column))[kept] for column in columns)


def known_names(what: str, given: Iterable[Any], known: Iterable[str]) -> None:
    """Raise `InputError` for the first of ``given`` that is not in ``known``."""
    known = list(known)
    try:
        given = list(given)
    except Exception:
        raise InputError(f"{what}: names must be a list of text, not {shown(given)}") from None
    for name in given:
        if not isinstance(name, str) or name not in known:
            raise InputError(f"{what} has no {shown(name)}: {nearest_name(name, known)}")


def table(what: str, value: Any) -> Mapping[str, Any]:
    """Return ``value`` if it is a mapping, or raise `InputError`."""
    if not isinstance(value, Mapping):
        raise InputError(f"{what} must be a table of names and values, not {shown(value)}")
    return value


def listed(name: str, value: Any, wanted: str) -> list[Any]:
    """Return the members of a collection, or raise `InputError` if it cannot be gone through."""
    try:
        if not isinstance(value, (str, bytes)):
            return list(value)
    except Exception:  # arrays without dimensions, classes, objects that promise and fail
        pass
    raise InputError(f"{name} must be {wanted}, not {shown(value)}")


def shown(value: Any, longest: int = 60) -> str:
    """Return ``value`` as short text on one line, whatever it is."""
    if isinstance(value, np.generic):
        value = value.item()
    try:
        text = " ".join(repr(value).split())
    except Exception:  # a whole number of thousands of digits, or a broken __repr__
        text = f"<{type(value).__name__}>"
    return text if len(text) <= longest else text[: longest - 3] + "..."


def plain_number(value: Any) -> Any:
    """Return the number or flag in one of NumPy's or xarray's boxes, anything else as it is."""
    if isinstance(value, np.generic) or (
        type(value).__module__.partition(".")[0] in ("numpy", "xarray")
        and getattr(value, "ndim", None) == 0
    ):
        dtype = getattr(value, "dtype", None)
        if dtype is not None and dtype.kind in "biuf":
            return value.item()
    return value


def is_real(value: Any) -> bool:
    """Whether ``value`` is a real number: Python's or NumPy's, no flag and no span of time."""
    if isinstance(value, (bool, np.bool_, np.timedelta64)):
        return False
    return isinstance(value, (int, float, np.integer, np.floating))


def _as_float(name: str, value: Any, allowed: str) -> float:
    if not is_real(value):
        raise InputError(f"{name} = {shown(value)} has the wrong type: it must be {allowed}")
    try:
        return float(value)
    except OverflowError:
        raise InputError(f"{name} is too large: it must be {allowed}") from None


def _interval(low: float, high: float, open_low: bool) -> str:
    if math.isinf(high):
        return f"{'above' if open_low else 'of at least'} {low:g}, finite"
    return f"above {low:g}, up to {high:g}" if open_low else f"from {low:g} to {high:g}"
