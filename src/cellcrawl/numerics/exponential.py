"""An exponential that vectorises; the one in the C library is a scalar call."""

from __future__ import annotations

import numpy as np

from cellcrawl.numerics.kernels import inlined_kernel

_SHIFT = 6755399441055744.0  # 1.5 * 2**52: adding it rounds to the nearest integer
_LOG2E = 1.4426950408889634
_LN2_HIGH = 6.93147180369123816490e-01
_LN2_LOW = 1.90821492927058770002e-10


@inlined_kernel
def exponential(x: float) -> float:
    """``exp(x)`` to about 4e-16 for |x| < 700; larger |x| is clipped to 700, NaN stays NaN."""
    x = min(max(x, -700.0), 700.0) if x == x else x
    shifted = x * _LOG2E + _SHIFT
    whole = shifted - _SHIFT
    f = (x - whole * _LN2_HIGH) - whole * _LN2_LOW
    p = 1.0 / 6227020800.0
    p = p * f + 1.0 / 479001600.0
    p = p * f + 1.0 / 39916800.0
    p = p * f + 1.0 / 3628800.0
    p = p * f + 1.0 / 362880.0
    p = p * f + 1.0 / 40320.0
    p = p * f + 1.0 / 5040.0
    p = p * f + 1.0 / 720.0
    p = p * f + 1.0 / 120.0
    p = p * f + 1.0 / 24.0
    p = p * f + 1.0 / 6.0
    p = p * f + 0.5
    p = p * f + 1.0
    p = p * f + 1.0
    bits = (np.float64(shifted).view(np.int64) + 1023) << 52
    return p * np.int64(bits).view(np.float64)


@inlined_kernel
def growth(x: float) -> float:
    """``exp(x)`` to rounding for |x| < 0.12."""
    p = 1.0 / 40320.0
    p = p * x + 1.0 / 5040.0
    p = p * x + 1.0 / 720.0
    p = p * x + 1.0 / 120.0
    p = p * x + 1.0 / 24.0
    p = p * x + 1.0 / 6.0
    p = p * x + 0.5
    p = p * x + 1.0
    return p * x + 1.0
