"""Elementary functions of which every machine computes the same bits.

Those of the C library differ in their last bits from one library, and one processor, to the next,
and a browser has none at all. A run's bits must not hang on either. Worst errors, in units of the
last place: 1 for sine, cosine and logarithm, 2 for powers, 3 for the others.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from cellcrawl.numerics.exponential import exponential
from cellcrawl.numerics.kernels import kernel

_LN2_HIGH: Final = 6.93147180369123816490e-01
_LN2_LOW: Final = 1.90821492927058770002e-10
_HALF: Final = math.sqrt(0.5)
_MANTISSA: Final = (1 << 52) - 1
_SHIFT: Final = 6755399441055744.0  # 1.5 * 2**52: adding it rounds to the nearest integer
_PER_QUARTER: Final = 6.36619772367581382433e-01
_QUARTER_1: Final = 1.57079632673412561417e00  # the first 33 bits of pi / 2 ...
_QUARTER_1_TAIL: Final = 6.07710050650619224932e-11  # ... and the rest
_SPLIT: Final = 134217729.0  # 2**27 + 1: a product with it halves a number's digits


@kernel
def _reduced(x: float) -> tuple[float, float, int]:
    """Return x less a multiple of pi / 2, in two parts, and the multiple by its rest of 4."""
    turns = (x * _PER_QUARTER + _SHIFT) - _SHIFT
    r = x - turns * _QUARTER_1
    w = turns * _QUARTER_1_TAIL
    high = r - w
    return high, (r - high) - w, int(turns) & 3


@kernel
def _sine(x: float, tail: float) -> float:
    z = x * x
    p = 1.58969099521155010221e-10
    p = p * z - 2.50507602534068634195e-08
    p = p * z + 2.75573137070700676789e-06
    p = p * z - 1.98412698298579493134e-04
    p = p * z + 8.33333333332248946124e-03
    v = z * x
    return x - ((z * (0.5 * tail - v * p) - tail) + v * 1.66666666666666324348e-01)


@kernel
def _cosine(x: float, tail: float) -> float:
    z = x * x
    p = -1.13596475577881948265e-11
    p = p * z + 2.08757232129817482790e-09
    p = p * z - 2.75573143513906633035e-07
    p = p * z + 2.48015872894767294178e-05
    p = p * z - 1.38888888888741095749e-03
    p = p * z + 4.16666666666666019037e-02
    half = 0.5 * z
    w = 1.0 - half
    return w + (((1.0 - w) - half) + (z * z * p - x * tail))


@kernel
def sine(x: float) -> float:
    """Sine of an angle of up to a million."""
    high, tail, quarter = _reduced(x)
    value = _sine(high, tail) if quarter % 2 == 0 else _cosine(high, tail)
    return value if quarter < 2 else -value


@kernel
def cosine(x: float) -> float:
    """Cosine of an angle of up to a million."""
    high, tail, quarter = _reduced(x)
    value = _cosine(high, tail) if quarter % 2 == 0 else _sine(high, tail)
    return value if quarter in (0, 3) else -value


@kernel
def natural_logarithm(x: float) -> float:
    """Natural logarithm; NaN below 0."""
    if not x > 0.0:
        return -np.inf if x == 0.0 else np.nan
    if x == np.inf:
        return x
    scale = 0
    if x < 2.2250738585072014e-308:
        x, scale = x * 18014398509481984.0, -54
    bits = np.float64(x).view(np.int64)
    whole = (bits >> 52) - 1023 + scale
    m = np.int64((bits & _MANTISSA) | (1023 << 52)).view(np.float64)
    if m > 2.0 * _HALF:
        m, whole = 0.5 * m, whole + 1
    f = m - 1.0
    s = f / (2.0 + f)
    z = s * s
    p = 2.0 / 23.0
    p = p * z + 2.0 / 21.0
    p = p * z + 2.0 / 19.0
    p = p * z + 2.0 / 17.0
    p = p * z + 2.0 / 15.0
    p = p * z + 2.0 / 13.0
    p = p * z + 2.0 / 11.0
    p = p * z + 2.0 / 9.0
    p = p * z + 2.0 / 7.0
    p = p * z + 2.0 / 5.0
    p = p * z + 2.0 / 3.0
    half = 0.5 * f * f
    rest = s * (half + z * p)
    k = float(whole)
    return k * _LN2_HIGH - ((half - (rest + k * _LN2_LOW)) - f)


@kernel
def logarithm_of_one_plus(x: float) -> float:
    """``log(1 + x)``."""
    u = 1.0 + x
    if u == 1.0:
        return x
    return natural_logarithm(u) * (x / (u - 1.0))


@kernel
def hyperbolic_tangent(x: float) -> float:
    """Hyperbolic tangent."""
    a = abs(x)
    if a > 22.0:
        return math.copysign(1.0, x)
    if a < 0.4:
        z = 2.0 * a
        p = 0.0
        for k in range(22, 1, -1):
            p = (p + 1.0) * z / k
        grown = z + z * p
        return math.copysign(grown / (grown + 2.0), x)
    return math.copysign(1.0 - 2.0 / (exponential(2.0 * a) + 1.0), x)


@kernel
def arc_tangent(x: float) -> float:
    """Arc tangent."""
    a = abs(x)
    turned = a > 1.0
    a = 1.0 / a if turned else a
    half = a / (1.0 + math.sqrt(1.0 + a * a))  # tangents of a half and a quarter of the angle
    quarter = half / (1.0 + math.sqrt(1.0 + half * half))
    z = quarter * quarter
    p = 0.0
    for k in range(27, 1, -2):
        p = 1.0 / k - z * p
    value = 4.0 * (quarter - quarter * z * p)
    return math.copysign(0.5 * math.pi - value if turned else value, x)


@kernel
def power(x: float, y: float) -> float:
    """``x ** y`` for positive x, with the product ``y log x`` in two parts."""
    if y == 0.0 or x == 1.0:
        return 1.0
    if x == 0.0:
        return 0.0 if y > 0.0 else np.inf
    size = abs(x)
    high = natural_logarithm(size)
    low = (size - exponential(high)) / size  # what the logarithm leaves out
    product = y * high
    a = _SPLIT * y
    a = a - (a - y)
    b = _SPLIT * high
    b = b - (b - high)
    rest = ((a * b - product) + a * (high - b) + (y - a) * b) + (y - a) * (high - b)
    value = exponential(product)
    value += value * (rest + y * low)
    odd = x < 0.0 and y == math.floor(y) and 0.5 * y != math.floor(0.5 * y)
    if x < 0.0 and y != math.floor(y):
        return np.nan
    return -value if odd else value


@kernel
def hypotenuse(x: float, y: float) -> float:
    """Length of the hypotenuse."""
    a, b = max(abs(x), abs(y)), min(abs(x), abs(y))
    if a == 0.0 or a == np.inf:
        return a
    part = b / a
    return a * math.sqrt(1.0 + part * part)
