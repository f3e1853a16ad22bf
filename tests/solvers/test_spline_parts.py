"""The parts of the spline scheme: splines, outline, diffusion, tension, remeshing."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import cellcrawl as cc
from cellcrawl.laws.law import PAPER
from cellcrawl.parameters import Conditions
from cellcrawl.solvers.spline import balance, outline, periodic
from cellcrawl.solvers.spline.frames import measured
from cellcrawl.solvers.spline.linkers import LINKER_ROWS, second_derivative_after
from cellcrawl.solvers.spline.outline import LOG_R, N, X, Y
from cellcrawl.solvers.spline.remeshing import SPREAD_ROWS, remesh, spread_evenly

TURN = 2.0 * math.pi

modes = st.lists(st.tuples(st.floats(-1, 1), st.floats(-1, 1)), min_size=4, max_size=4)


def smooth_cell(markers, shape, bound, uneven=0.15):
    """Fields on unevenly spaced markers round a smooth closed curve, and the angle of each."""
    u = TURN * np.arange(markers) / markers
    phi = u + uneven * np.sin(u) + 0.05 * np.cos(2 * u)
    radius, n = np.ones(markers), np.full(markers, 0.4)
    for k, ((a, b), (c, d)) in enumerate(zip(shape, bound, strict=True), start=2):
        radius += 0.1 * (a * np.cos(k * phi) + b * np.sin(k * phi)) / k**2
        n += 0.1 * (c * np.cos((k - 1) * phi) + d * np.sin((k - 1) * phi)) / k
    return np.array([radius * np.cos(phi), radius * np.sin(phi), n, np.full(markers, 3.9)])


def amounts(fields):
    """Integral of n ds, area and length."""
    shape = measured(fields)
    speed = shape[outline.SPEED]
    return np.array([fields[N] @ speed, outline.area(fields, shape), speed.sum()])


def remeshed(fields):
    new, shape = fields.copy(), measured(fields)
    remesh(new, shape, np.empty((4 + SPREAD_ROWS, fields.shape[1])))
    return new, shape


@given(st.integers(16, 80), st.integers(0, 2**32))
def test_bends_are_those_of_the_periodic_spline(markers, seed):
    f = np.random.default_rng(seed).normal(size=markers)
    found = np.empty(markers)
    periodic.bends(f, found)
    left = np.roll(found, 1) + 4.0 * found + np.roll(found, -1)
    assert np.allclose(left, 6.0 * (np.roll(f, 1) - 2.0 * f + np.roll(f, -1)), atol=1e-12)


def test_both_derivatives_are_of_fourth_order():
    errors = []
    for markers in (32, 64, 128):
        u = TURN * np.arange(markers) / markers
        slope, bend, work = np.empty((3, markers))
        periodic.derivatives(np.exp(np.sin(u)), slope, bend, work)
        scale = markers / TURN
        wave = np.exp(np.sin(u))
        exact = np.cos(u) * wave, (np.cos(u) ** 2 - np.sin(u)) * wave
        errors.append(
            [np.abs(slope * scale - exact[0]).max(), np.abs(bend * scale**2 - exact[1]).max()]
        )
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    assert np.all(orders > 3.8)


def test_a_zigzag_bends_as_strongly_as_the_stability_bound_says():
    found, slope, work = np.empty((3, 64))
    periodic.derivatives((-1.0) ** np.arange(64), slope, found, work)
    assert np.abs(found).max() == pytest.approx(periodic.ZIGZAG, rel=1e-12)
    for k in range(32):
        periodic.derivatives(np.cos(TURN * k * np.arange(64) / 64), slope, found, work)
        assert np.abs(found).max() <= periodic.ZIGZAG


@given(st.floats(0.0, 1.0), st.lists(st.floats(-1, 1), min_size=6, max_size=6))
def test_values_between_samples_are_exact_for_quintics(part, coefficients):
    p = np.polynomial.Polynomial(coefficients)
    d, e = p.deriv(), p.deriv(2)
    found = periodic.between(p(0.0), d(0.0), e(0.0), p(1.0), d(1.0), e(1.0), part)
    assert found == pytest.approx(p(part), abs=1e-13)


def test_outline_of_an_ellipse_is_of_fourth_order_on_uneven_markers():
    errors = []
    for markers in (64, 128, 256):
        u = TURN * np.arange(markers) / markers
        phi = u + 0.3 * np.sin(u)
        fields = np.array([2.0 * np.cos(phi), np.sin(phi), 0 * u, 0 * u])
        shape = measured(fields)
        speed = np.sqrt(4.0 * np.sin(phi) ** 2 + np.cos(phi) ** 2)
        errors.append(
            [
                np.abs(shape[outline.KAPPA] * speed**3 / 2.0 - 1.0).max(),
                abs(outline.area(fields, shape) / TURN - 1.0),
                abs(shape[outline.SEGMENT].sum() / 9.688448220547675 - 1.0),
                math.hypot(*outline.centroid(fields + 3.0, shape)) - math.hypot(3.0, 3.0),
            ]
        )
    kappa = [e[0] for e in errors]
    assert math.log2(kappa[0] / kappa[1]) > 3.8
    assert math.log2(kappa[1] / kappa[2]) > 3.8
    assert np.abs(errors[2]).max() < 1e-4
    assert np.abs(errors[2][1:]).max() < 1e-8


@given(modes, modes)
def test_area_changes_by_exactly_what_its_normal_velocity_sweeps(shape_modes, velocity_modes):
    fields = smooth_cell(64, shape_modes, velocity_modes)
    shape = measured(fields)
    velocity, speed = fields[N], shape[outline.SPEED]
    areas = []
    for dt in (1e-3, -1e-3):
        moved = fields.copy()
        moved[X] += dt * velocity * shape[outline.YU] / speed
        moved[Y] -= dt * velocity * shape[outline.XU] / speed
        areas.append(outline.area(moved, measured(moved)))
    # the area is quadratic in the positions, so that the central difference is its derivative
    assert (areas[0] - areas[1]) / 2e-3 == pytest.approx(velocity @ speed, rel=1e-10)


def diffused(markers, step, uneven):
    """Largest error of n_ss (step = 0), or of one implicit step, of a wave round the circle."""
    u = TURN * np.arange(markers) / markers
    s = u + uneven * np.sin(u)
    fields = np.array([np.cos(s), np.sin(s), 0.4 + 0.2 * np.cos(3 * s), 0 * s])
    edge = np.full((7, markers), 0.5)
    w = np.empty(markers)
    second_derivative_after(
        fields, edge, step, measured(fields), w, np.empty((LINKER_ROWS, markers))
    )
    return np.abs(w + 1.8 * np.cos(3 * s) / (1.0 + 9.0 * 0.5 * step)).max()


@pytest.mark.parametrize("step", [0.0, 0.05])
@pytest.mark.parametrize("uneven", [0.0, 0.3])
def test_diffusion_is_of_fourth_order_on_uneven_markers(step, uneven):
    errors = [diffused(markers, step, uneven) for markers in (64, 128, 256)]
    assert math.log2(errors[0] / errors[1]) > 3.7
    assert math.log2(errors[1] / errors[2]) > 3.8


def test_implicit_diffusion_decays_every_wave_however_long_the_step():
    rng = np.random.default_rng(1)
    s = TURN * np.arange(64) / 64 + 0.3 * np.sin(TURN * np.arange(64) / 64)
    edge, w = np.full((7, 64), 1.0), np.empty(64)
    for step in (1e-3, 1.0, 1e6):
        fields = np.array([np.cos(s), np.sin(s), rng.normal(size=64), 0 * s])
        second_derivative_after(fields, edge, step, measured(fields), w, np.empty((5, 64)))
        assert np.abs(fields[N] + step * w).max() <= np.abs(fields[N]).max()


@given(modes, modes, st.sampled_from([0.0, 1e-3, 1.0, 500.0]))
def test_tension_solves_its_own_equation_however_stiff(shape_modes, bound_modes, weight):
    fields = smooth_cell(64, shape_modes, bound_modes)
    shape = measured(fields)
    edge = Conditions(cc.Parameters()).edge(0.0, 64)
    code, _, sigma = balance.solve_tension(
        PAPER.compiled, fields, 600.0, 900.0, weight, shape, edge
    )
    assert code == balance.BALANCED
    swept = balance.rates(PAPER.compiled, fields, sigma, shape, edge, np.empty((3, 64)))
    assert sigma == pytest.approx(900.0 + weight * swept, rel=1e-9)
    n, r = fields[N], np.exp(fields[LOG_R])
    pull = 100.0 + sigma * (1.0 + 0.01 * shape[outline.KAPPA])
    assert np.allclose((r + 600.0 * n) * fields[LOG_R], pull, rtol=1e-10)


@given(modes, modes)
def test_remeshing_conserves_linkers_area_and_length_to_its_order(shape_modes, bound_modes):
    lost = []
    for markers in (128, 256, 512):
        fields = smooth_cell(markers, shape_modes, bound_modes)
        new, _ = remeshed(fields)
        lost.append(np.abs(amounts(new) / amounts(fields) - 1.0).max())
    # falls at fourth order or better, or is as good as nothing
    assert lost[0] < 2e-6
    assert lost[1] < max(lost[0] / 10.0, 1e-8)
    assert lost[2] < 1e-9


@given(modes, modes)
def test_remeshed_markers_are_even_and_the_first_stays(shape_modes, bound_modes):
    fields = smooth_cell(256, shape_modes, bound_modes)
    new, shape = remeshed(fields)
    assert outline.unevenness(measured(fields)) > 1.2
    assert outline.unevenness(shape) < 1.0 + 1e-4
    assert np.array_equal(new[:, 0], fields[:, 0])
    assert np.array_equal(shape[:8], measured(new)[:8])


@given(modes, modes)
def test_remeshing_even_markers_changes_next_to_nothing(shape_modes, bound_modes):
    once, _ = remeshed(smooth_cell(256, shape_modes, bound_modes))
    twice, _ = remeshed(once)
    assert np.abs(twice - once)[:LOG_R].max() < 1e-6


def test_a_thousand_remeshings_neither_grow_noise_nor_shrink_the_cell():
    fields = smooth_cell(128, [(0.5, 0.2), (0.1, 0.3), (0.0, 0.2), (0.3, 0.0)], [(1.0, 0.0)] * 4)
    fields[:2] += 1e-5 * np.random.default_rng(0).normal(size=(2, 128))
    before, state = amounts(fields), fields
    for turn in range(1000):
        new = np.empty((4, 127 + turn % 2))
        spread_evenly(state, measured(state), new, np.empty((SPREAD_ROWS, state.shape[1])))
        state = new
    assert np.abs(amounts(state) / before - 1.0).max() < 1e-5
    assert np.abs(np.fft.rfft(state[X]))[50:].max() / 128 < 1e-5
