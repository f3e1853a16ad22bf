"""The one place that says how numerical kernels are compiled."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar, cast

import numba

F = TypeVar("F", bound=Callable[..., object])


def kernel(function: F) -> F:
    """Compile a numerical kernel: cached on disk, divisions vectorise, fused multiply-adds allowed.

    NaN and infinity keep their meaning, so a kernel may test for them.
    """
    compiled = numba.njit(cache=True, error_model="numpy", fastmath={"contract"})(function)
    return cast(F, compiled)


def inlined_kernel(function: F) -> F:
    """Like `kernel`, for a few lines that are inlined wherever they are called."""
    compiled = numba.njit(cache=True, error_model="numpy", fastmath={"contract"}, forceinline=True)(
        function
    )
    return cast(F, compiled)


def exact_kernel(function: F) -> F:
    """Compile with strict IEEE arithmetic, for predicates whose sign must be right."""
    compiled = numba.njit(cache=True, error_model="numpy")(function)
    return cast(F, compiled)
