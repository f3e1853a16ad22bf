"""Periodic cubic splines whose parameter counts the markers: 0 at the first, 1 at the next.

With samples ``f`` at whole numbers the spline's second derivatives ``M`` obey
``M[i-1] + 4 M[i] + M[i+1] = 6 (f[i-1] - 2 f[i] + f[i+1])``. Its slopes at the samples are of
fourth order, its second derivatives of second; the average ``(M[i-1] + 10 M[i] + M[i+1]) / 12``
is of fourth (Lucas, SIAM J. Numer. Anal. 11, 569, 1974). That average still sees a zigzag from
sample to sample, at 8 of the pi^2 it should be.
"""

from __future__ import annotations

import math

import numpy as np

from cellcrawl.numerics.kernels import inlined_kernel, kernel

ZIGZAG = 8.0  # largest size of the corrected second derivative of a wave of height 1
_POLE = math.sqrt(3.0) - 2.0  # M is a two-way recursive filter with this pole
_MEMORY = 32  # _POLE ** _MEMORY is below rounding


@kernel
def bends(f: np.ndarray, out: np.ndarray) -> None:
    """Second derivatives ``M`` of the spline at the samples; arrays have shape (markers,)."""
    markers = f.size
    for i in range(1, markers - 1):
        out[i] = f[i - 1] - 2.0 * f[i] + f[i + 1]
    out[0] = f[markers - 1] - 2.0 * f[0] + f[1]
    out[markers - 1] = f[markers - 2] - 2.0 * f[markers - 1] + f[0]

    running = 0.0
    for back in range(_MEMORY, 0, -1):
        running = out[-back % markers] + _POLE * running
    for i in range(markers):
        running = out[i] + _POLE * running
        out[i] = running
    running = 0.0
    for ahead in range(_MEMORY - 1, -1, -1):
        running = _POLE * (running - out[ahead % markers])
    for i in range(markers - 1, -1, -1):
        running = _POLE * (running - out[i])
        out[i] = 6.0 * running


@kernel
def derivatives(f: np.ndarray, slope: np.ndarray, bend: np.ndarray, work: np.ndarray) -> None:
    """First and corrected second derivative at the samples, both of fourth order.

    Arrays have shape (markers,).
    """
    markers = f.size
    bends(f, work)
    for i in range(1, markers - 1):
        before, after = work[i - 1], work[i + 1]
        slope[i] = 0.5 * (f[i + 1] - f[i - 1]) - (after - before) / 12.0
        bend[i] = (before + 10.0 * work[i] + after) / 12.0
    for i in (0, markers - 1):
        j, k = (i - 1) % markers, (i + 1) % markers
        slope[i] = 0.5 * (f[k] - f[j]) - (work[k] - work[j]) / 12.0
        bend[i] = (work[j] + 10.0 * work[i] + work[k]) / 12.0


@inlined_kernel
def between(
    f0: float, slope0: float, bend0: float, f1: float, slope1: float, bend1: float, part: float
) -> float:
    """Value at ``part`` of the way between two samples, from both ends' derivatives (quintic)."""
    rest = 1.0 - part
    from_first = f0 + part * (slope0 + 3.0 * f0 + part * (0.5 * bend0 + 3.0 * slope0 + 6.0 * f0))
    from_second = f1 - rest * (slope1 - 3.0 * f1 - rest * (0.5 * bend1 - 3.0 * slope1 + 6.0 * f1))
    return rest * rest * rest * from_first + part * part * part * from_second
