"""The C library's functions by name, for compiled code that asks for them; see `elementary`."""

from __future__ import annotations

from typing import Any, Final

from cellcrawl.numerics import elementary
from cellcrawl.numerics.exponential import exponential


def _exponential(x: float) -> float:
    return exponential(x)


def _plain(kernel: Any) -> Any:
    return kernel.py_func


FUNCTIONS: Final[dict[str, tuple[Any, int]]] = {
    "sin": (_plain(elementary.sine), 1),
    "cos": (_plain(elementary.cosine), 1),
    "exp": (_exponential, 1),
    "log": (_plain(elementary.natural_logarithm), 1),
    "log1p": (_plain(elementary.logarithm_of_one_plus), 1),
    "tanh": (_plain(elementary.hyperbolic_tangent), 1),
    "atan": (_plain(elementary.arc_tangent), 1),
    "pow": (_plain(elementary.power), 2),
    "hypot": (_plain(elementary.hypotenuse), 2),
}
"""By name in C: the function and how many numbers it takes."""
