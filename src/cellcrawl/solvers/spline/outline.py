"""The cell's outline: a periodic cubic spline through markers that need not be evenly spaced.

The parameter ``u`` counts the markers, so that uneven spacing is the spline's own speed
``g = ds/du``. Whole-outline integrals are sums over the markers, which for smooth periodic
integrands is as exact as the integrand.
"""

from __future__ import annotations

import math

import numpy as np

from cellcrawl.numerics.kernels import kernel
from cellcrawl.solvers.spline.periodic import derivatives

X, Y, N, LOG_R = range(4)  # rows of `fields`
XU, YU, XUU, YUU, SPEED, PACE, KAPPA, SEGMENT, SCRATCH = range(9)  # rows of a `shape` array
SHAPE_ROWS = 9


@kernel
def copy(source: np.ndarray, target: np.ndarray) -> None:
    """``target[:] = source``, which would take Numba seconds to compile."""
    for row in range(source.shape[0]):
        for i in range(source.shape[1]):
            target[row, i] = source[row, i]


@kernel
def measure(fields: np.ndarray, shape: np.ndarray) -> None:
    """Fill ``shape`` from the markers, the first two rows of ``fields``.

    Its rows: derivatives of x and y, speed ``g``, ``dg/du`` (`PACE`), curvature, and the arclength
    from each marker to the next (`SEGMENT`, trapezoid with end correction); all of fourth order.
    The outward normal is ``(y_u, -x_u) / g``.
    """
    markers = fields.shape[1]
    xu, yu, xuu, yuu = shape[XU], shape[YU], shape[XUU], shape[YUU]
    speed, pace, kappa, segment = shape[SPEED], shape[PACE], shape[KAPPA], shape[SEGMENT]
    derivatives(fields[X], xu, xuu, shape[SCRATCH])
    derivatives(fields[Y], yu, yuu, shape[SCRATCH])
    for i in range(markers):
        squared = xu[i] * xu[i] + yu[i] * yu[i]
        speed[i] = math.sqrt(squared)
        pace[i] = (xu[i] * xuu[i] + yu[i] * yuu[i]) / speed[i]
        kappa[i] = (xu[i] * yuu[i] - yu[i] * xuu[i]) / (squared * speed[i])
    for i in range(markers - 1):
        segment[i] = 0.5 * (speed[i] + speed[i + 1]) - (pace[i + 1] - pace[i]) / 12.0
    last = markers - 1
    segment[last] = 0.5 * (speed[last] + speed[0]) - (pace[0] - pace[last]) / 12.0


@kernel
def area(fields: np.ndarray, shape: np.ndarray) -> float:
    """Enclosed area, half the integral of ``x dy - y dx``.

    Its rate of change when the markers move along their normals at ``U`` is exactly the sum
    of ``U g``, as it is for the curve itself.
    """
    x, y = fields[X], fields[Y]
    result = 0.0
    for i in range(x.size):
        result += (x[i] - x[0]) * shape[YU, i] - (y[i] - y[0]) * shape[XU, i]
    return 0.5 * result


@kernel
def centroid(fields: np.ndarray, shape: np.ndarray) -> tuple[float, float]:
    """Centroid of the enclosed area."""
    x, y = fields[X], fields[Y]
    moment_x = moment_y = 0.0
    for i in range(x.size):
        moment_x += (x[i] - x[0]) ** 2 * shape[YU, i]
        moment_y -= (y[i] - y[0]) ** 2 * shape[XU, i]
    scale = 0.5 / area(fields, shape)
    return x[0] + scale * moment_x, y[0] + scale * moment_y


@kernel
def enclose(wanted: float, fields: np.ndarray, shape: np.ndarray) -> None:
    """Scale the outline about its centroid, in place, to enclose the area ``wanted``.

    ``shape`` is its `measure` before and after: made anew, so that a step has the same bits whether
    it follows another in the same call or not.
    """
    x, y = fields[X], fields[Y]
    center_x, center_y = centroid(fields, shape)
    scale = math.sqrt(wanted / area(fields, shape))
    for i in range(x.size):
        x[i] = center_x + scale * (x[i] - center_x)
        y[i] = center_y + scale * (y[i] - center_y)
    measure(fields, shape)


@kernel
def unevenness(shape: np.ndarray) -> float:
    """Largest over smallest spacing of the markers."""
    least = most = shape[SPEED, 0]
    for i in range(shape.shape[1]):
        least, most = min(least, shape[SPEED, i]), max(most, shape[SPEED, i])
    return float(most / least)


@kernel
def sharpest_turn(shape: np.ndarray) -> tuple[float, int]:
    """Largest angle the outline turns through from marker to marker, and at which marker."""
    largest, where = 0.0, 0
    for i in range(shape.shape[1]):
        turn = abs(shape[KAPPA, i]) * shape[SPEED, i]
        if turn > largest:
            largest, where = turn, i
    return largest, where
