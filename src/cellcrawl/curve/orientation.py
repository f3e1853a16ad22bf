"""The exact sign of the area of a triangle in floating point (after Shewchuk, 1997).

Exact as long as no product of two coordinates overflows or loses digits by underflow, so for
coordinates that are 0 or of a magnitude from 1e-130 to 1e130.
"""

from __future__ import annotations

import numpy as np

from cellcrawl.numerics.kernels import expanded_kernel, kernel

_FILTER = 3.3306690738754716e-16  # (3 + 16 u) u: above it the rounded determinant has the sign
_SPLIT = 134217729.0  # 2**27 + 1 splits a double into two halves


@kernel
def orientation(ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> int:
    """+1 if a, b, c turn left, -1 if they turn right, 0 if they lie on one line: always exact."""
    left = (ax - cx) * (by - cy)
    right = (ay - cy) * (bx - cx)
    rounded = left - right
    if abs(rounded) > _FILTER * (abs(left) + abs(right)):
        return 1 if rounded > 0.0 else -1
    return _exact_sign(ax, ay, bx, by, cx, cy)


@expanded_kernel
def _exact_sign(ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> int:
    expansion = np.zeros(12)
    size = 0
    for u, v in ((ax, by), (-ax, cy), (bx, cy), (-bx, ay), (cx, ay), (-cx, by)):
        high, low = _product(u, v)
        size = _grow(expansion, size, low)
        size = _grow(expansion, size, high)
    for i in range(size - 1, -1, -1):
        if expansion[i] != 0.0:
            return 1 if expansion[i] > 0.0 else -1
    return 0


@expanded_kernel
def _product(a: float, b: float) -> tuple[float, float]:
    """Return ``a * b`` rounded, and its exact error."""
    high = a * b
    c = _SPLIT * a
    a_high = c - (c - a)
    a_low = a - a_high
    c = _SPLIT * b
    b_high = c - (c - b)
    b_low = b - b_high
    low = ((a_high * b_high - high) + a_high * b_low + a_low * b_high) + a_low * b_low
    return high, low


@expanded_kernel
def _grow(expansion: np.ndarray, size: int, value: float) -> int:
    """Add ``value`` to a non-overlapping expansion in place; return its new size."""
    carry = value
    for i in range(size):
        total = carry + expansion[i]
        part = total - carry
        expansion[i] = (carry - (total - part)) + (expansion[i] - part)
        carry = total
    expansion[size] = carry
    return size + 1
