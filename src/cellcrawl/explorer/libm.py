"""The C library's functions by name, for compiled code that asks for them; see `_elementary`."""

from __future__ import annotations

from typing import Any, Final

from cellcrawl import _elementary
from cellcrawl.physics.exponential import exponential


def _exponential(x: float) -> float:
    return exponential(x)


FUNCTIONS: Final[dict[str, tuple[Any, int]]] = {
    "sin": (_elementary.sine.py_func, 1),
    "cos": (_elementary.cosine.py_func, 1),
    "exp": (_exponential, 1),
    "log": (_elementary.natural_logarithm.py_func, 1),
    "log1p": (_elementary.logarithm_of_one_plus.py_func, 1),
    "tanh": (_elementary.hyperbolic_tangent.py_func, 1),
    "atan": (_elementary.arc_tangent.py_func, 1),
    "pow": (_elementary.power.py_func, 2),
    "hypot": (_elementary.hypotenuse.py_func, 2),
}
"""By name in C: the function and how many numbers it takes."""
