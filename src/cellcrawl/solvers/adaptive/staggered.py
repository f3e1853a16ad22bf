"""Tenth-order stencils on a staggered periodic grid.

The tangent angle lives at the nodes, everything that moves the edge (curvature, bound fraction,
velocity) at the midpoints between them. A staggered first derivative sees every wave a grid can
hold, so no sawtooth hides from the curvature, and its error is some thirty times smaller than a
central one's. Arrays carry a halo of `HALO` entries at both ends: entry ``HALO + i`` is node ``i``,
or the midpoint half a spacing after it. Indices are unsigned, which lets the loops vectorise.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from cellcrawl.numerics.kernels import inlined_kernel, kernel

HALO: Final = 8
_0, _1, _2, _3, _4, _5 = (np.uint64(k) for k in range(6))

_S1, _S2, _S3, _S4, _S5 = (
    19845.0 / 16384.0,
    -735.0 / 8192.0,
    567.0 / 40960.0,
    -405.0 / 229376.0,
    35.0 / 294912.0,
)
_M1, _M2, _M3, _M4, _M5 = (
    19845.0 / 32768.0,
    -2205.0 / 16384.0,
    567.0 / 16384.0,
    -405.0 / 65536.0,
    35.0 / 65536.0,
)
_C1, _C2, _C3, _C4, _C5 = 5.0 / 6.0, -5.0 / 21.0, 5.0 / 84.0, -5.0 / 504.0, 1.0 / 1260.0
_D0, _D1, _D2, _D3, _D4, _D5 = (
    -5269.0 / 1800.0,
    5.0 / 3.0,
    -5.0 / 21.0,
    5.0 / 126.0,
    -5.0 / 1008.0,
    1.0 / 3150.0,
)
_I0, _I1, _I2, _I3, _I4 = (
    41208059.0 / 46448640.0,
    3629953.0 / 58060800.0,
    -801973.0 / 116121600.0,
    49879.0 / 58060800.0,
    -27859.0 / 464486400.0,
)


@inlined_kernel
def difference_ahead(a: np.ndarray, i: np.uint64) -> float:
    """First difference half a spacing after entry ``i``: from nodes to midpoints."""
    value: float = (
        _S1 * (a[i + _1] - a[i])
        + _S2 * (a[i + _2] - a[i - _1])
        + _S3 * (a[i + _3] - a[i - _2])
        + _S4 * (a[i + _4] - a[i - _3])
        + _S5 * (a[i + _5] - a[i - _4])
    )
    return value


@inlined_kernel
def difference_behind(a: np.ndarray, i: np.uint64) -> float:
    """First difference half a spacing before entry ``i``: from midpoints to nodes."""
    value: float = (
        _S1 * (a[i] - a[i - _1])
        + _S2 * (a[i + _1] - a[i - _2])
        + _S3 * (a[i + _2] - a[i - _3])
        + _S4 * (a[i + _3] - a[i - _4])
        + _S5 * (a[i + _4] - a[i - _5])
    )
    return value


@inlined_kernel
def mean_ahead(a: np.ndarray, i: np.uint64) -> float:
    """Value half a spacing after entry ``i``: from nodes to midpoints."""
    value: float = (
        _M1 * (a[i + _1] + a[i])
        + _M2 * (a[i + _2] + a[i - _1])
        + _M3 * (a[i + _3] + a[i - _2])
        + _M4 * (a[i + _4] + a[i - _3])
        + _M5 * (a[i + _5] + a[i - _4])
    )
    return value


@inlined_kernel
def mean_behind(a: np.ndarray, i: np.uint64) -> float:
    """Value half a spacing before entry ``i``: from midpoints to nodes."""
    value: float = (
        _M1 * (a[i] + a[i - _1])
        + _M2 * (a[i + _1] + a[i - _2])
        + _M3 * (a[i + _2] + a[i - _3])
        + _M4 * (a[i + _3] + a[i - _4])
        + _M5 * (a[i + _4] + a[i - _5])
    )
    return value


@inlined_kernel
def central_difference(a: np.ndarray, i: np.uint64) -> float:
    """First difference at entry ``i`` itself."""
    value: float = (
        _C1 * (a[i + _1] - a[i - _1])
        + _C2 * (a[i + _2] - a[i - _2])
        + _C3 * (a[i + _3] - a[i - _3])
        + _C4 * (a[i + _4] - a[i - _4])
        + _C5 * (a[i + _5] - a[i - _5])
    )
    return value


@inlined_kernel
def second_difference(a: np.ndarray, i: np.uint64) -> float:
    """Second difference at entry ``i``."""
    value: float = (
        _D0 * a[i]
        + _D1 * (a[i + _1] + a[i - _1])
        + _D2 * (a[i + _2] + a[i - _2])
        + _D3 * (a[i + _3] + a[i - _3])
        + _D4 * (a[i + _4] + a[i - _4])
        + _D5 * (a[i + _5] + a[i - _5])
    )
    return value


@inlined_kernel
def cell_mean(a: np.ndarray, i: np.uint64) -> float:
    """Mean over the cell around midpoint ``i``, from node ``i`` to the next."""
    value: float = (
        _I0 * a[i]
        + _I1 * (a[i + _1] + a[i - _1])
        + _I2 * (a[i + _2] + a[i - _2])
        + _I3 * (a[i + _3] + a[i - _3])
        + _I4 * (a[i + _4] + a[i - _4])
    )
    return value


@kernel
def fill_halo(a: np.ndarray, nodes: int) -> None:
    """Repeat a periodic array of ``nodes`` entries into its halo."""
    for k in range(HALO):
        a[k] = a[nodes + k]
        a[HALO + nodes + k] = a[HALO + k]


@kernel
def total(a: np.ndarray, nodes: int) -> float:
    """Sum over the nodes, in eight interleaved parts; ``nodes`` is a multiple of 8."""
    s0 = s1 = s2 = s3 = s4 = s5 = s6 = s7 = 0.0
    for i in range(HALO, HALO + nodes, 8):
        s0 += a[i]
        s1 += a[i + 1]
        s2 += a[i + 2]
        s3 += a[i + 3]
        s4 += a[i + 4]
        s5 += a[i + 5]
        s6 += a[i + 6]
        s7 += a[i + 7]
    return ((s0 + s1) + (s2 + s3)) + ((s4 + s5) + (s6 + s7))


@kernel
def dot(a: np.ndarray, b: np.ndarray) -> float:
    """Sum of products of arrays without halos, like `total`."""
    s0 = s1 = s2 = s3 = s4 = s5 = s6 = s7 = 0.0
    for i in range(0, a.size, 8):
        s0 += a[i] * b[i]
        s1 += a[i + 1] * b[i + 1]
        s2 += a[i + 2] * b[i + 2]
        s3 += a[i + 3] * b[i + 3]
        s4 += a[i + 4] * b[i + 4]
        s5 += a[i + 5] * b[i + 5]
        s6 += a[i + 6] * b[i + 6]
        s7 += a[i + 7] * b[i + 7]
    return ((s0 + s1) + (s2 + s3)) + ((s4 + s5) + (s6 + s7))


@kernel
def sum_of_squares(a: np.ndarray, nodes: int) -> float:
    """Sum of squares over the nodes."""
    inner = a[HALO : HALO + nodes]
    return dot(inner, inner)


@kernel
def running_sum(a: np.ndarray, nodes: int) -> None:
    """Replace every entry by the sum of those before it, in four parts at once."""
    part = nodes // 4
    s0 = s1 = s2 = s3 = 0.0
    for i in range(HALO, HALO + part):
        step0, step1, step2, step3 = a[i], a[i + part], a[i + 2 * part], a[i + 3 * part]
        a[i], a[i + part], a[i + 2 * part], a[i + 3 * part] = s0, s1, s2, s3
        s0 += step0
        s1 += step1
        s2 += step2
        s3 += step3
    for quarter in range(1, 4):
        before = s0 if quarter == 1 else s0 + s1 if quarter == 2 else s0 + s1 + s2
        first = HALO + quarter * part
        for i in range(part):
            a[first + i] += before
