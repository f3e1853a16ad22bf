"""A frame of output from the adaptive solver's state, as accurate as the state itself.

Positions, area and centroid come from the tangent angle on the solver's own grid; values at the
output nodes are those of the trigonometric interpolant.
"""

from __future__ import annotations

import math

import numpy as np

from cellcrawl.parameters import EDGE_ROWS
from cellcrawl.physics.force_balance import SOLVED, balance, solve_off_rate
from cellcrawl.solvers import adaptive_state as layout
from cellcrawl.solvers.adaptive_rates import LENGTH, ORIGIN_X, ORIGIN_Y, TENSION
from cellcrawl.solvers.base import Frame, pointwise_velocity_and_friction

_ROWS = {name: row for row, name in enumerate(EDGE_ROWS)}


def sampled(waves: np.ndarray, nodes: int) -> np.ndarray:
    """Values at ``nodes`` equal steps of the series ``sum waves[k] exp(i k phi)``; k as in the FFT.

    Waves too short for the nodes are folded, so these are values of the series, not a smoothing.
    """
    count = waves.shape[-1]
    half = count // 2
    periods = -(-(count + 1) // nodes)
    padded = np.zeros((*waves.shape[:-1], periods * nodes), complex)
    padded[..., : half + 1] = waves[..., : half + 1]
    padded[..., -half:] = waves[..., half:]
    padded[..., half] *= 0.5  # the sawtooth is shared between +half and -half
    padded[..., -half] *= 0.5
    folded = padded.reshape(*waves.shape[:-1], periods, nodes).sum(axis=-2)
    return np.asarray(np.fft.ifft(folded, norm="forward"))


def frame(
    time: float, state: np.ndarray, log_rate: np.ndarray, edge: np.ndarray
) -> tuple[Frame, float]:
    """Return the cell on ``edge.shape[1]`` nodes, and its closure error over the length.

    ``log_rate`` is any guess of ``log r`` at the solver's midpoints.
    """
    nodes, count = edge.shape[1], layout.nodes_of(state)
    scalars = layout.scalars(state)
    length, tension = float(scalars[LENGTH]), float(scalars[TENSION])
    k = np.fft.fftfreq(count, 1.0 / count)
    k_odd = k.copy()
    k_odd[count // 2] = 0.0  # the sawtooth has no derivative or integral on its own nodes

    angle = layout.angle(state)
    tangent = np.exp(1j * (angle + layout.winding(count)))
    waves = np.fft.fft(np.stack([angle, layout.bound(state), tangent]), norm="forward")
    waves[1] *= np.exp((-1j * math.pi / count) * k)
    gap = waves[2, 0]
    waves[2] *= np.where(k_odd != 0.0, length / (2j * math.pi * np.where(k_odd, k_odd, 1.0)), 0.0)
    waves[2, 0] = -waves[2].sum()  # node 0 is the origin of the arms
    arms = np.fft.ifft(waves[2], norm="forward")
    support = (arms * tangent.conj()).imag  # arm . outward normal, negated
    spacing = length / count
    area = -0.5 * spacing * float(support.sum())
    center = -spacing / (3.0 * area) * complex((arms * support).sum())
    origin = complex(scalars[ORIGIN_X], scalars[ORIGIN_Y])

    bend = waves[0] * (2j * math.pi / length) * k_odd
    wobble, bound, path, bending = sampled(np.stack([waves[0], waves[1], waves[2], bend]), nodes)
    kappa = 2.0 * math.pi / length + bending.real
    n = np.ascontiguousarray(bound.real)
    y = log_rate[(np.arange(nodes) * count) // nodes]
    row = {name: edge[index] for name, index in _ROWS.items()}
    failed = solve_off_rate(y, n, tension, kappa, row["zeta_1"], row["sigma_c"], row["h"])
    if failed != SOLVED:  # the edge left the model's range between the solver's midpoints
        pull = tension * (1.0 + kappa * row["h"]) + row["sigma_c"]
        rest = slice(failed, None)
        y[rest] = [
            max(balance(*values), 0.0)
            for values in zip(
                y[rest], n[rest], row["zeta_1"][rest], pull[rest].clip(0.0), strict=True
            )
        ]
    off_rate = np.exp(y)
    velocity, friction = pointwise_velocity_and_friction(off_rate, n, edge)
    made = Frame(
        time=time,
        x=path.real + origin.real,
        y=path.imag + origin.imag,
        theta=wobble.real + layout.winding(nodes),
        curvature=kappa,
        bound_fraction=n,
        off_rate=off_rate,
        normal_velocity=velocity,
        friction=friction,
        tension=tension,
        length=length,
        area=area,
        centroid_x=center.real + origin.real,
        centroid_y=center.imag + origin.imag,
    )
    return made, abs(gap)
