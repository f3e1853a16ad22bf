"""The functions of a law that kernels call; each takes the law first.

``edge`` holds the local parameters, shape (rows, nodes), in the order of the law's ``rows``, and
``i`` is the node. What each law makes of them is registered by `cellcrawl.laws.compiled`.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping
from typing import Any, Final

from numba.core import types
from numba.core.datamodel import models
from numba.core.imputils import lower_constant
from numba.extending import (
    NativeValue,
    overload,
    register_model,
    unbox,
)

from cellcrawl.numerics.elementary import cosine, hyperbolic_tangent, natural_logarithm, sine
from cellcrawl.numerics.exponential import exponential, growth
from cellcrawl.numerics.kernels import INLINED, inlined_kernel

_registered: dict[str, dict[str, Callable[..., Any]]] = {}


class LawType(types.Opaque):
    """Numba's type of a compiled law; the name tells laws apart."""


register_model(LawType)(models.OpaqueModel)


class Compiled:
    """What `LawType` is the type of."""

    def __init__(self, key: str) -> None:
        self.key = key
        self._numba_type_ = LawType(key)  # where dispatch from Python looks first


@unbox(LawType)  # type: ignore[no-untyped-call, untyped-decorator]
def _unboxed(kind: LawType, value: Any, context: Any) -> NativeValue:
    return NativeValue(context.context.get_dummy_value())  # type: ignore[no-untyped-call]


@lower_constant(LawType)  # type: ignore[no-untyped-call, untyped-decorator]
def _constant(context: Any, builder: Any, kind: LawType, value: Any) -> Any:
    return context.get_dummy_value()


@inlined_kernel
def _choose(condition: bool, if_true: float, if_false: float) -> float:
    return if_true if condition else if_false


@inlined_kernel
def _power(base: float, exponent: float) -> float:
    """``base ** exponent``, 0 where the base is not positive."""
    return exponential(exponent * natural_logarithm(base)) if base > 0.0 else 0.0


_IN_KERNELS: Final[dict[str, Any]] = {
    "__name__": "cellcrawl.laws.functions",
    "exp": exponential,
    "growth": growth,
    "log": natural_logarithm,
    "sqrt": math.sqrt,
    "sin": sine,
    "cos": cosine,
    "tanh": hyperbolic_tangent,
    "choose": _choose,
    "power": _power,
}


def register(key: str, source: str, also: Mapping[str, Any] | None = None) -> None:
    """Make the functions in ``source``, which may call ``also``, known to kernels under a key."""
    if key not in _registered:
        space = {**_IN_KERNELS, **(also or {})}
        exec(source, space)
        names = [line.split("(")[0][4:] for line in source.splitlines() if line.startswith("def ")]
        _registered[key] = {name: space[name] for name in names}


def _by_law(function: Callable[..., Any]) -> Callable[..., Any]:
    """Let all call what the law in the first argument has under this function's name.

    Python gets the bits that kernels get.
    """
    name = function.__name__

    @functools.wraps(function)
    def in_python(laws: Compiled, *arguments: Any) -> Any:
        return _registered[laws.key][name](laws, *arguments)

    def chosen(laws: Any, *arguments: Any) -> Any:
        return _registered[laws.name][name] if isinstance(laws, LawType) else None

    overload(in_python, jit_options=INLINED, strict=False)(chosen)
    return in_python


@_by_law
def off_rate(laws: Any, phi: float, edge: Any, i: int) -> float:
    """Off-rate of a bond that bears ``phi``."""
    raise NotImplementedError


@_by_law
def renewed_rate(laws: Any, r: float, phi: float, step: float, edge: Any, i: int) -> float:
    """Off-rate at ``phi``, where it was ``r`` a short step (below 0.12) before."""
    raise NotImplementedError


@_by_law
def nearly_renewed_rate(laws: Any, r: float, phi: float, step: float, edge: Any, i: int) -> float:
    """Off-rate at ``phi``, where it was ``r`` a tiny step (below 4e-6) before."""
    raise NotImplementedError


@_by_law
def balance(
    laws: Any, phi: float, r: float, n: float, sigma: float, kappa: float, edge: Any, i: int
) -> tuple[float, float, float]:
    """Friction less pull, its slope and its bend in ``phi``."""
    raise NotImplementedError


@_by_law
def velocity(
    laws: Any, phi: float, r: float, sigma: float, kappa: float, edge: Any, i: int
) -> float:
    """Outward normal velocity of the edge."""
    raise NotImplementedError


@_by_law
def friction(laws: Any, phi: float, r: float, n: float, edge: Any, i: int) -> float:
    """Friction on the ground."""
    raise NotImplementedError


@_by_law
def binding(laws: Any, phi: float, r: float, n: float, edge: Any, i: int) -> float:
    """Rate of change of ``n`` at a material point, without diffusion."""
    raise NotImplementedError


@_by_law
def turnover(laws: Any, phi: float, r: float, n: float, edge: Any, i: int) -> float:
    """Rates of binding and of unbinding together."""
    raise NotImplementedError


@_by_law
def partials(
    laws: Any, phi: float, r: float, n: float, sigma: float, kappa: float, edge: Any, i: int
) -> tuple[float, float, float, float, float, float, float, float, float]:
    """Slopes: balance by phi, n, sigma, kappa; velocity by phi, sigma, kappa; binding by phi, n."""
    raise NotImplementedError


@_by_law
def surround(
    around: Any,
    data: Any,
    time: float,
    x: float,
    y: float,
    normal_x: float,
    normal_y: float,
    curvature: float,
    arm_x: float,
    arm_y: float,
    velocity_x: float,
    velocity_y: float,
    edge: Any,
    local: Any,
    i: int,
) -> int:
    """Fill what surroundings change of the local parameters of a node, from those in ``edge``."""
    raise NotImplementedError
