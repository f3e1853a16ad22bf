"""The equations of a cell that keeps its shape, and their exact derivatives.

Paper's letters: ``w = theta - pi/2 - alpha`` and ``n`` at the nodes, ``L`` the length, ``sigma``
the tension, ``kappa`` the curvature, ``U`` the normal velocity, ``T`` the tangential one that keeps
arclengths equal (of mean zero: another gauge adds a false mode), ``P`` the mean of ``kappa U``.
``c`` is a speed of relabelling along the edge and ``omega`` the turning rate.

The rates are those of `cellcrawl.solvers`, in the frame that turns with the cell.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from cellcrawl.branches.mesh import Mesh, Operators
from cellcrawl.branches.setting import Pointwise, Setting


class Fields(NamedTuple):
    """A shape on the nodes that are kept: all, or one half of a symmetric cell."""

    w: np.ndarray
    n: np.ndarray
    length: float
    sigma: float


class Rates(NamedTuple):
    """Rates of change of a shape and what they are made of."""

    w: np.ndarray
    n: np.ndarray
    length: float
    kappa: np.ndarray
    slide: np.ndarray
    """``T + c``."""
    bound_slope: np.ndarray
    """``n_s``."""
    at: Pointwise


class Linear(NamedTuple):
    """Derivatives of the rates by ``(w, n, L)``, shape (m, m), and by tension, c and omega (m,)."""

    matrix: np.ndarray
    by_sigma: np.ndarray
    by_slide: np.ndarray
    by_turn: np.ndarray


def rates(
    setting: Setting,
    ops: Operators,
    shape: Fields,
    phi: np.ndarray,
    slide: float = 0.0,
    turn: float = 0.0,
) -> Rates:
    """Return the rates of a shape in a frame that turns and relabels; phi is a guess."""
    w, n, length, sigma = shape
    per_length = 2.0 * math.pi / length
    kappa = per_length * (1.0 + ops.angle_slope @ w)
    at = setting.pointwise(phi, n, sigma, kappa)
    stretch = kappa * at.speed
    along = length * (ops.slide @ stretch) + slide
    bound_slope = per_length * (ops.bound_slope @ n)
    spread = setting.parameters.D * per_length**2 * (ops.bound_bend @ n)
    w_t = along * kappa - per_length * (ops.speed_slope @ at.speed) - turn
    n_t = at.binding + spread + along * bound_slope
    length_t = length * float(ops.mean @ stretch)
    return Rates(w_t, n_t, length_t, kappa, along, bound_slope, at)


def linear(setting: Setting, ops: Operators, shape: Fields, now: Rates) -> Linear:
    """Return the derivatives of the rates for perturbations of the parity of ``ops``."""
    _, n, length, _ = shape
    size = n.size
    per_length = 2.0 * math.pi / length
    kappa, along, n_s, at = now.kappa, now.slide, now.bound_slope, now.at
    speed_k, speed_n, speed_sigma = at.speed_by
    bind_k, bind_n, bind_sigma = at.binding_by
    stretch_k = at.speed + kappa * speed_k
    stretch_n, stretch_sigma = kappa * speed_n, kappa * speed_sigma
    bend = per_length * ops.angle_slope
    slope = per_length * ops.speed_slope
    slide = length * ops.slide
    slide_w = (slide * stretch_k) @ bend
    slide_n = slide * stretch_n
    diffusivity = setting.parameters.D * per_length**2
    matrix = np.empty((2 * size + 1, 2 * size + 1))
    w, b = slice(0, size), slice(size, 2 * size)
    matrix[w, w] = kappa[:, None] * slide_w + along[:, None] * bend - (slope * speed_k) @ bend
    matrix[w, b] = kappa[:, None] * slide_n - slope * speed_n
    matrix[b, w] = n_s[:, None] * slide_w + bind_k[:, None] * bend
    matrix[b, b] = n_s[:, None] * slide_n + diffusivity * ops.bound_bend
    matrix[b, b] += along[:, None] * (per_length * ops.bound_slope)
    matrix[b, b][np.diag_indices(size)] += bind_n
    mean_k = ops.mean * stretch_k
    matrix[-1, w] = length * (mean_k @ bend)
    matrix[-1, b] = length * (ops.mean * stretch_n)

    own = along - _relabelling(now, ops, length)  # T without c: it grows with the length
    dk = -kappa / length
    d_slide = own / length + slide @ (stretch_k * dk)
    matrix[w, -1] = kappa * d_slide + along * dk - slope @ (speed_k * dk)
    matrix[w, -1] += slope @ at.speed / length
    matrix[b, -1] = bind_k * dk + n_s * d_slide - along * n_s / length
    matrix[b, -1] -= 2.0 * diffusivity / length * (ops.bound_bend @ n)
    matrix[-1, -1] = float(ops.mean @ (kappa * at.speed)) + length * float(mean_k @ dk)

    d_slide = slide @ stretch_sigma
    by_sigma = np.empty(2 * size + 1)
    by_sigma[w] = kappa * d_slide - slope @ speed_sigma
    by_sigma[b] = bind_sigma + n_s * d_slide
    by_sigma[-1] = length * float(ops.mean @ stretch_sigma)
    nothing = np.zeros(size)
    by_slide = np.concatenate([kappa, n_s, [0.0]])
    by_turn = np.concatenate([nothing - 1.0, nothing, [0.0]])
    return Linear(matrix, by_sigma, by_slide, by_turn)


def _relabelling(now: Rates, ops: Operators, length: float) -> np.ndarray:
    """Return ``c`` in ``T + c``, the same at all nodes."""
    return np.asarray(now.slide - length * (ops.slide @ (now.kappa * now.at.speed)))


class Measured(NamedTuple):
    """Closure and area of a whole edge, with their derivatives by ``w``, shape (nodes,)."""

    closure: np.ndarray
    """Mean of the tangent, shape (2,): across and along the axis."""
    closure_by: np.ndarray
    """Shape (2, nodes)."""
    area: float
    area_by: np.ndarray
    x: np.ndarray
    y: np.ndarray
    """Positions about the mean over the grid."""


def measure(mesh: Mesh, w: np.ndarray, length: float) -> Measured:
    """Return closure and area of a whole edge; ``theta = pi/2 + alpha + w``."""
    theta = 0.5 * math.pi + mesh.alpha + w
    g = mesh.stretch
    cosine, sine = g * np.cos(theta), g * np.sin(theta)
    scale = length / (2.0 * math.pi)
    x, y = scale * (mesh.antiderivative @ cosine), scale * (mesh.antiderivative @ sine)
    per_node = length / mesh.nodes
    area = per_node * float(sine @ x)
    closure = np.array([cosine.mean(), sine.mean()])
    closure_by = np.array([-sine, cosine]) / mesh.nodes
    return Measured(closure, closure_by, area, per_node * (cosine * x + sine * y), x, y)
