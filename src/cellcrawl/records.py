"""Results as frozen values that are equal to themselves also where they hold NaN."""

from __future__ import annotations

import dataclasses
from typing import Any


class EqualWithNaN:
    """Base of dataclasses with ``eq=False``: NaN, which stands for "there is none", equals NaN.

    Python's own rule depends on its version and on which NaN it is.
    """

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return bool(_comparable(self) == _comparable(other))

    def __hash__(self) -> int:
        return hash(_comparable(self))


def _comparable(value: Any) -> Any:
    """Return a value with NaN replaced by what equals itself, and with tables as tuples."""
    if isinstance(value, EqualWithNaN) and dataclasses.is_dataclass(value):
        return tuple(_comparable(getattr(value, field.name)) for field in dataclasses.fields(value))
    if isinstance(value, dict):
        return tuple(sorted((key, _comparable(item)) for key, item in value.items()))
    if isinstance(value, float) and value != value:
        return "NaN"
    return value
