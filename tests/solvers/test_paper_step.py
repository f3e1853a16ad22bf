import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cellcrawl.numerics.cyclic import solve_cyclic_tridiagonal
from cellcrawl.solvers.paper.step import crank_nicolson
from cellcrawl.solvers.paper.tangent_angle import (
    centroid,
    curvature,
    enclosed_area,
    points,
    tangential_velocity,
)

TURN = 2.0 * math.pi


def diffuse(nodes, dt, time, k, diffusivity, length=TURN, r=0.0, r_on=0.0, slide=0.0):
    """Bound fraction after ``time`` from a wave of wavenumber k, by Crank-Nicolson steps."""
    s = length * np.arange(nodes) / nodes
    n = 0.4 + 0.2 * np.cos(k * TURN * s / length)
    full = np.ones(nodes)
    for _ in range(round(time / dt)):
        crank_nicolson(
            n,
            r_on - (r_on + r) * n,
            -(r_on + r) * full,
            slide * full,
            length / nodes,
            dt,
            diffusivity * full,
            np.empty((6, nodes)),
        )
    return s, n


def decay_error(nodes, dt, k=3, diffusivity=0.5, time=0.4):
    s, n = diffuse(nodes, dt, time, k, diffusivity)
    return np.abs(n - 0.4 - 0.2 * math.exp(-diffusivity * k**2 * time) * np.cos(k * s)).max()


def test_wave_on_a_fixed_circle_decays_as_theory_says():
    assert decay_error(512, 1e-3) < 1e-5


def test_decay_is_second_order_in_time():
    # on a fine grid, whose own error is far below
    errors = [decay_error(8192, dt, k=1, diffusivity=1.0) for dt in (0.1, 0.05, 0.025)]
    rates = [math.log2(a / b) for a, b in pairwise(errors)]
    assert rates == pytest.approx([2.0, 2.0], abs=0.02)


def test_decay_is_second_order_in_space():
    errors = [decay_error(nodes, 2e-4) for nodes in (32, 64, 128)]
    rates = [math.log2(a / b) for a, b in pairwise(errors)]
    assert rates == pytest.approx([2.0, 2.0], abs=0.05)


def test_decay_follows_the_schemes_own_factor_to_rounding():
    # (1 - z/2) / (1 + z/2) a step, z = 4 D dt sin^2(k ds / 2) / ds^2
    nodes, dt, steps, k, diffusivity = 64, 0.01, 25, 5, 0.3
    s, n = diffuse(nodes, dt, steps * dt, k, diffusivity)
    spacing = TURN / nodes
    z = 4.0 * diffusivity * dt * math.sin(0.5 * k * spacing) ** 2 / spacing**2
    factor = ((1.0 - 0.5 * z) / (1.0 + 0.5 * z)) ** steps
    np.testing.assert_allclose(n, 0.4 + 0.2 * factor * np.cos(k * s), rtol=0, atol=1e-14)


def test_diffusion_keeps_the_amount_of_linkers():
    _, n = diffuse(101, 0.01, 1.0, 4, 0.7)
    assert n.mean() == pytest.approx(0.4, rel=1e-14)


def test_binding_relaxes_to_its_steady_state_at_second_order():
    r_on, r, time = 25.0, 50.0, 0.02
    bound = r_on / (r_on + r)
    errors = []
    for dt in (2e-3, 1e-3):
        _, n = diffuse(32, dt, time, 0, 0.0, r=r, r_on=r_on)
        errors.append(abs(n[0] - bound - (0.6 - bound) * math.exp(-(r_on + r) * time)))
    assert math.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.02)
    _, n = diffuse(32, 1e-3, 1.0, 0, 0.0, r=r, r_on=r_on)
    np.testing.assert_allclose(n, bound, rtol=1e-13)


def test_grid_that_slides_ahead_reads_the_wave_from_ahead():
    # n_t = T n_s: the wave travels against T
    s, n = diffuse(2000, 1e-3, 0.5, 2, 0.0, slide=0.3)
    np.testing.assert_allclose(n, 0.4 + 0.2 * np.cos(2 * (s + 0.15)), rtol=0, atol=1e-5)


@given(st.integers(3, 60), st.integers(0, 2**32), st.floats(0.0, 1.0))
def test_cyclic_systems_are_solved_as_dense_ones(nodes, seed, asymmetry):
    rng = np.random.default_rng(seed)
    lower, upper = rng.uniform(-1, 1, (2, nodes))
    upper = asymmetry * upper + (1.0 - asymmetry) * lower
    diagonal = np.abs(lower) + np.abs(upper) + rng.uniform(0.05, 2.0, nodes)
    diagonal *= rng.choice([-1.0, 1.0])
    right = rng.normal(size=nodes)
    dense = np.diag(diagonal)
    for i in range(nodes):
        dense[i, i - 1] += lower[i]
        dense[i, (i + 1) % nodes] += upper[i]
    solution = right.copy()
    solve_cyclic_tridiagonal(lower, diagonal, upper, solution, np.empty((2, nodes)))
    expected = np.linalg.solve(dense, right)
    size = np.abs(expected).max()
    np.testing.assert_allclose(solution, expected, rtol=0, atol=1e-12 * size)


def wavy(nodes):
    """Tangent angle, length, curvature and points of a bean by its exact formulas."""
    s = TURN * np.arange(nodes) / nodes
    theta = 0.5 * math.pi + s + 0.4 * np.sin(2 * s) + 0.1 * np.cos(3 * s)
    bend = 1.0 + 0.8 * np.cos(2 * s) - 0.3 * np.sin(3 * s)
    return theta, bend


def errors_of(measure):
    return [measure(nodes) for nodes in (64, 128, 256)]


def test_curvature_is_second_order():
    def error(nodes):
        theta, exact = wavy(nodes)
        kappa = np.empty(nodes)
        curvature(theta, TURN, kappa)
        return np.abs(kappa - exact).max()

    first, second, third = errors_of(error)
    assert math.log2(first / second) == pytest.approx(2.0, abs=0.05)
    assert math.log2(second / third) == pytest.approx(2.0, abs=0.02)


@pytest.mark.parametrize("nodes", [16, 64, 1001])
def test_circle_has_its_points_area_and_centroid(nodes):
    theta = 0.5 * math.pi + TURN * np.arange(nodes) / nodes
    kappa, x, y = np.empty((3, nodes))
    curvature(theta, TURN, kappa)
    np.testing.assert_allclose(kappa, 1.0, rtol=1e-12)
    cosine, sine = np.cos(theta), np.sin(theta)
    gap = points(TURN, cosine, sine, kappa, x, y)
    assert gap < 1e-14
    area = enclosed_area(TURN, cosine, sine, x, y)
    spacing = TURN / nodes
    assert area == pytest.approx(math.pi, rel=spacing**4 / 100 + 1e-13)
    center = centroid(TURN, area, cosine, sine, x, y)
    np.testing.assert_allclose(center, [-1.0, 0.0], atol=spacing**4 / 100 + 1e-13)


def test_end_correction_makes_the_points_fourth_order_but_for_the_curvature():
    # with the exact curvature the trapezoid with end correction is fourth order
    def error(nodes):
        fine, _ = wavy(nodes * 64)
        fine_step = TURN / fine.size
        path = np.exp(1j * fine)
        path = fine_step * np.concatenate([[0.0], np.cumsum(0.5 * (path[1:] + path[:-1]))])[::64]
        theta, bend = wavy(nodes)
        x, y = np.empty((2, nodes))
        gap = np.exp(1j * fine).mean()
        points(TURN, np.cos(theta), np.sin(theta), bend, x, y)
        s = TURN * np.arange(nodes) / nodes
        return np.abs(x + 1j * y - (path - gap * s)).max()

    first, second, _ = errors_of(error)
    assert math.log2(first / second) > 3.5


def test_tangential_velocity_keeps_the_nodes_equally_spaced():
    # T_s = <kappa U> - kappa U, for kappa U = 1 + cos s: T = -sin s, growth = 1
    nodes = 128
    s = TURN * np.arange(nodes) / nodes
    slide = np.empty(nodes)
    growth = tangential_velocity(np.ones(nodes), 1.0 + np.cos(s), TURN, slide, np.empty((2, nodes)))
    assert growth == pytest.approx(1.0, rel=1e-14)
    assert slide[0] == 0.0
    np.testing.assert_allclose(slide, -np.sin(s), rtol=0, atol=1e-6)


def test_circle_growing_evenly_needs_no_tangential_velocity():
    nodes = 64
    slide = np.empty(nodes)
    growth = tangential_velocity(
        np.ones(nodes), np.full(nodes, 0.3), TURN, slide, np.empty((2, nodes))
    )
    assert growth == pytest.approx(0.3, rel=1e-14)
    np.testing.assert_allclose(slide, 0.0, atol=1e-14)
