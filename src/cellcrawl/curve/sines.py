"""Sine and cosine together, written so that loops over an edge vectorise."""

from __future__ import annotations

from cellcrawl.numerics.kernels import inlined_kernel

_SHIFT = 6755399441055744.0  # 1.5 * 2**52: adding it rounds to the nearest integer
_PER_TURN = 0.15915494309189535
_TURN_HIGH = 6.283185307179586  # 2 pi to double precision, and what that leaves out
_TURN_LOW = 2.4492935982947064e-16


@inlined_kernel
def sine_and_cosine(angle: float) -> tuple[float, float]:
    """Sine and cosine to about 4e-16 for angles of up to a million turns.

    A quarter of the angle less its whole turns goes into two series, and is doubled twice.
    """
    turns = (angle * _PER_TURN + _SHIFT) - _SHIFT
    x = 0.25 * ((angle - turns * _TURN_HIGH) - turns * _TURN_LOW)
    z = x * x
    s = 1.0 / 355687428096000.0
    s = s * z - 1.0 / 1307674368000.0
    s = s * z + 1.0 / 6227020800.0
    s = s * z - 1.0 / 39916800.0
    s = s * z + 1.0 / 362880.0
    s = s * z - 1.0 / 5040.0
    s = s * z + 1.0 / 120.0
    s = s * z - 1.0 / 6.0
    sine = x + x * z * s
    c = 1.0 / 20922789888000.0  # 1 - cosine, which keeps its digits
    c = c * z - 1.0 / 87178291200.0
    c = c * z + 1.0 / 479001600.0
    c = c * z - 1.0 / 3628800.0
    c = c * z + 1.0 / 40320.0
    c = c * z - 1.0 / 720.0
    c = c * z + 1.0 / 24.0
    c = c * z - 0.5
    cosine = 1.0 + c * z
    twice = 2.0 * sine * cosine
    half = 1.0 - 2.0 * sine * sine
    return 2.0 * twice * half, 1.0 - 2.0 * twice * twice
