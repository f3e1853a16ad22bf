"""The one place that says how numerical kernels are compiled."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final, TypeVar, cast

import numba
from numba.extending import register_jitable

F = TypeVar("F", bound=Callable[..., object])


_compile: Any = numba.njit  # its types do not know every option
_CACHED: Final[dict[str, Any]] = {
    "cache": True,
    "error_model": "numpy",
    "no_cfunc_wrapper": True,  # nothing calls a kernel through a C function pointer
}
_CONTRACTED: Final[dict[str, Any]] = {"fastmath": {"contract"}}


def kernel(function: F) -> F:
    """Compile a numerical kernel: cached on disk, divisions vectorise, fused multiply-adds allowed.

    NaN and infinity keep their meaning, so a kernel may test for them.
    """
    return cast(F, _compile(**_CACHED, **_CONTRACTED)(function))


def woven_kernel(function: F) -> F:
    """Like `kernel`, but a caller compiles it as if it were written there.

    For long parts with one caller or two: a kernel is otherwise optimised once by itself and again
    within each of its callers. Called from Python it is compiled by itself.
    """
    return cast(F, _compile(**_CACHED, **_CONTRACTED, inline="always")(function))


def inlined_kernel(function: F) -> F:
    """Let kernels compile a few lines as `kernel` does, inlined wherever they are called.

    Python sees the function as it was written; it works on whole arrays if its lines do.
    """
    inlined: F = register_jitable(
        error_model="numpy",
        forceinline=True,
        no_cpython_wrapper=True,
        no_cfunc_wrapper=True,
        **_CONTRACTED,
    )(function)
    return inlined


def exact_kernel(function: F) -> F:
    """Compile with strict IEEE arithmetic, for predicates whose sign must be right."""
    return cast(F, _compile(**_CACHED)(function))


def woven_exact_kernel(function: F) -> F:
    """Like `exact_kernel`, but compiled within its callers, which must be exact too."""
    return cast(F, _compile(**_CACHED, inline="always")(function))
