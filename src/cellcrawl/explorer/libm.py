"""The C library's functions by name, for compiled code that asks for them; see `_elementary`."""

from __future__ import annotations

from typing import Any, Final

from cellcrawl import _elementary
from cellcrawl.physics.exponential import exponential


def _exponential(x: float) -> float:
    return exponential(x)


def _plain(kernel: Any) -> Any:
    return kernel.py_func


FUNCTIONS: Final[dict[str, tuple[Any, int]]] = {
    "sin": (_plain(_elementary.sine), 1),
    "cos": (_plain(_elementary.cosine), 1),
    "exp": (_exponential, 1),
    "log": (_plain(_elementary.natural_logarithm), 1),
    "log1p": (_plain(_elementary.logarithm_of_one_plus), 1),
    "tanh": (_plain(_elementary.hyperbolic_tangent), 1),
    "atan": (_plain(_elementary.arc_tangent), 1),
    "pow": (_plain(_elementary.power), 2),
    "hypot": (_plain(_elementary.hypotenuse), 2),
}
"""By name in C: the function and how many numbers it takes."""
