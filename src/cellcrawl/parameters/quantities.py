"""Numbers with units, where the user has them: pint is imported only for a quantity."""

from __future__ import annotations

from typing import Any

from cellcrawl.errors import InputError, MissingExtraError

_LAST_DIGITS = 4e-15  # relative: what conversions and ratios may cost


def is_quantity(value: Any) -> bool:
    """Whether ``value`` is a pint quantity, without importing pint."""
    return all(hasattr(value, name) for name in ("to", "magnitude", "dimensionality"))


def magnitude_in(name: str, value: Any, unit: str) -> Any:
    """Return the number of a quantity in ``unit``, anything else as it is.

    Raises
    ------
    InputError
        For a quantity of another dimension.
    """
    if not is_quantity(value):
        return value
    try:
        return as_written(value.to(unit).magnitude)
    except (TypeError, ValueError, AttributeError, ArithmeticError):  # pint's errors are among them
        text = " ".join(str(value).split())
        given = text if len(text) <= 60 else text[:57] + "..."
        raise InputError(
            f"{name} = {given} has the wrong dimension: it must be in {unit} or a unit like it"
        ) from None


def as_written(number: Any) -> Any:
    """Return the number of up to 12 digits that ``number`` is but for rounding, if there is one.

    10 um are 1e-5 m, not 9.999999999999999e-06, and a cell is the same in either unit.
    """
    if not isinstance(number, float):
        return number
    short = float(f"{number:.12g}")
    return short if abs(short - number) <= _LAST_DIGITS * abs(number) else number


def quantity(value: Any, unit: str) -> Any:
    """Return ``value`` with a unit, a quantity of pint's application registry.

    Raises
    ------
    MissingExtraError
        If pint is not installed.
    """
    try:
        import pint
    except ImportError:
        raise MissingExtraError(
            "quantities need pint: install it with pip install 'cellcrawl[units]'"
        ) from None
    registry: Any = pint.application_registry
    return registry.Quantity(value, unit)
