"""What compiled kernels call of the C library, for a machine that has none.

A page that borrowed sine or exponential from its browser would show another cell in another browser:
their last bits differ. These are compiled into the module; worst 1 unit in the last place.
"""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np

from cellcrawl.curve.sines import sine_and_cosine
from cellcrawl.physics.exponential import exponential

_LN2_HIGH: Final = 6.93147180369123816490e-01
_LN2_LOW: Final = 1.90821492927058770002e-10
_HALF: Final = math.sqrt(0.5)
_MANTISSA: Final = (1 << 52) - 1
_SPLIT: Final = 134217729.0  # 2**27 + 1: a product with it halves a number's digits


def sin(x: float) -> float:
    """Sine."""
    return sine_and_cosine(x)[0]


def cos(x: float) -> float:
    """Cosine."""
    return sine_and_cosine(x)[1]


def exp(x: float) -> float:
    """Exponential; larger arguments than 700 count as 700."""
    return exponential(x)


def log(x: float) -> float:
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


def log1p(x: float) -> float:
    """``log(1 + x)``."""
    u = 1.0 + x
    if u == 1.0:
        return x
    return log_(u) * (x / (u - 1.0))


def tanh(x: float) -> float:
    """Hyperbolic tangent."""
    a = abs(x)
    if a > 22.0:
        return math.copysign(1.0, x)
    if a < 0.3:
        z = x * x
        p = -929569.0 / 638512875.0 * z + 21844.0 / 6081075.0
        p = p * z - 1382.0 / 155925.0
        p = p * z + 62.0 / 2835.0
        p = p * z - 17.0 / 315.0
        p = p * z + 2.0 / 15.0
        p = p * z - 1.0 / 3.0
        return x + x * z * p
    grown = exponential(2.0 * a)
    return math.copysign(1.0 - 2.0 / (grown + 1.0), x)


def pow(x: float, y: float) -> float:
    """``x ** y`` for positive x, with the product ``y log x`` in two parts."""
    if y == 0.0 or x == 1.0:
        return 1.0
    if x == 0.0:
        return 0.0 if y > 0.0 else np.inf
    size = abs(x)
    high = log_(size)
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


def hypot(x: float, y: float) -> float:
    """Length of the hypotenuse."""
    a, b = max(abs(x), abs(y)), min(abs(x), abs(y))
    if a == 0.0 or a == np.inf:
        return a
    part = b / a
    return a * math.sqrt(1.0 + part * part)




log_: Any = log  # compiled by the builder, which other functions here call
FUNCTIONS: Final[dict[str, tuple[Any, int]]] = {
    "sin": (sin, 1),
    "cos": (cos, 1),
    "exp": (exp, 1),
    "log": (log, 1),
    "log1p": (log1p, 1),
    "tanh": (tanh, 1),
    "pow": (pow, 2),
    "hypot": (hypot, 2),
}
"""By name in C: the function and how many numbers it takes."""
