"""Eigenmode starts against the equations in polar angle, written out here once more.

In polar angle phi: ``R_t = U J / R`` with ``J = sqrt(R**2 + R'**2)``, and
``n_t = r_on (1 - n) - r n + D n_ss + T n_s`` with ``T = U R' / R``, the velocity of points at fixed
phi along the tangent relative to material points.
"""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest

import cellcrawl as cc

SAMPLES = 512
PHI = 2.0 * np.pi * np.arange(SAMPLES) / SAMPLES
CELL = cc.Parameters(r_on=25, zeta_1=600)
STIFF = CELL.replace(elasticity="consistent")
# cell, k, branch, largest amplitude of the radius
MODES = [
    (CELL, 1, "+", 2e-4),
    (CELL, 3, "+", 1e-4),
    (CELL, 3, "-", 1e-2),
    (CELL, 10, "+", 1e-3),
    (CELL, 10, "-", 1e-3),
    (CELL, 20, "-", 1e-3),
    (STIFF, 2, "+", 1e-4),
    (CELL.replace(r_on=56, zeta_1=560), 2, "+", 1e-3),
]
BREATHING = [(STIFF, "+", 1e-5), (STIFF, "-", 1e-5), (STIFF.replace(zeta_1=200.0), "-", 1e-5)]


def slope(f, order=1):
    waves = (1j * np.fft.fftfreq(SAMPLES, 1.0 / SAMPLES)) ** order * np.fft.fft(f)
    return np.fft.ifft(waves).real


def fields(state, k):
    """Radius and bound fraction at equal steps of the polar angle."""
    x, y = state.curve.points.T
    angle = np.arctan2(y, x)
    modes = range(1) if k == 0 else range(0, 5 * k, k)

    def waves(at):
        parts = [t(m * at) for m in modes for t in ((np.cos, np.sin) if m else (np.cos,))]
        return np.column_stack(parts)

    def on_circle(values):
        return waves(PHI) @ np.linalg.lstsq(waves(angle), values, rcond=None)[0]

    return on_circle(np.hypot(x, y)), on_circle(state.bound_fraction)


def off_rate(p, radius, bound, tension):
    r1, r2 = slope(radius), slope(radius, 2)
    curvature = (radius**2 + 2.0 * r1**2 - radius * r2) / (radius**2 + r1**2) ** 1.5
    pull = p.sigma_c + tension * (1.0 + p.h * curvature)
    y = np.full(SAMPLES, math.log(p.r_p))
    for _ in range(50):
        force = y * (np.exp(y) + p.zeta_1 * bound)
        y -= (force - pull) / (np.exp(y) * (1.0 + y) + p.zeta_1 * bound)
    return np.exp(y)


def rates_of_change(p, radius, bound, tension):
    r = off_rate(p, radius, bound, tension)
    r1 = slope(radius)
    stretch = np.sqrt(radius**2 + r1**2)
    velocity = p.epsilon * (p.v_p - r * np.log(r))
    along = velocity * r1 / radius * slope(bound) / stretch
    spread = p.D * slope(slope(bound) / stretch) / stretch
    return velocity * stretch / radius, p.r_on * (1.0 - bound) - r * bound + spread + along


def wave(f, m):
    """Complex amplitude of ``Re a exp(i m phi)``."""
    return np.mean(f * np.exp(-1j * m * PHI)) * (1.0 if m == 0 else 2.0)


def orders(errors):
    """Orders of errors at a, a / 2, a / 4."""
    first, second, third = errors
    return math.log2(first / second), math.log2(second / third)


@pytest.mark.parametrize(("p", "k", "branch", "largest"), MODES)
def test_state_differs_from_base_and_linear_mode_at_second_order(p, k, branch, largest):
    lam = complex(cc.linear.growth_rates(p, k)["+-".index(branch)])
    base = cc.linear.base_state(p)
    q = p.r_on + p.r_p + p.D * k**2
    ratio_r = -lam / (p.epsilon * base.c)  # lam R = -eps c r
    ratio_n = -p.n_bar * ratio_r / (lam + q)  # (lam + q) n = -n_bar r
    errors = []
    for amplitude in (largest, largest / 2, largest / 4):
        state = cc.Eigenmode(k, amplitude, branch).state(p, 256)
        radius, bound = fields(state, k)
        r = off_rate(p, radius, bound, state.tension)
        turn = np.exp(1j * k * PHI)
        errors.append(
            [
                np.abs(radius - 1.0 - (amplitude * turn).real).max(),
                np.abs(bound - p.n_bar - (ratio_n * amplitude * turn).real).max(),
                np.abs(r - p.r_p - (ratio_r * amplitude * turn).real).max(),
                abs(state.tension - p.sigma_bar),
                abs(state.curve.length - 2.0 * math.pi),
            ]
        )
    for of_field in np.array(errors).T:
        assert orders(of_field) == pytest.approx((2.0, 2.0), abs=0.1)


@pytest.mark.parametrize(("p", "k", "branch", "largest"), MODES)
def test_state_grows_as_the_mode_up_to_third_order(p, k, branch, largest):
    # the wave at lam, its second harmonic at 2 lam, the mean at 2 Re lam
    lam = complex(cc.linear.growth_rates(p, k)["+-".index(branch)])
    errors = []
    for amplitude in (largest, largest / 2, largest / 4):
        state = cc.Eigenmode(k, amplitude, branch).state(p, 256)
        radius, bound = fields(state, k)
        changes = rates_of_change(p, radius, bound, state.tension)
        for m, rate in ((k, lam), (2 * k, 2.0 * lam), (0, 2.0 * lam.real)):
            for f, change in zip((radius - 1.0, bound - p.n_bar), changes, strict=True):
                errors.append(abs(wave(change, m) - rate * wave(f, m)))
    errors = np.array(errors).reshape(3, 3, 2)
    for wave_errors in errors[:, 0].T:
        assert orders(wave_errors) == pytest.approx((3.0, 3.0), abs=0.1)
    second = errors[:, 1:].reshape(3, 4).T
    noise = 1e-13 * abs(lam)
    assert all(min(orders(e)) > 3.5 for e in second if e[2] > noise)
    assert np.any(second[:, 2] > noise)


@pytest.mark.parametrize(("p", "branch", "largest"), BREATHING)
def test_breathing_state_grows_as_the_mode_up_to_third_order(p, branch, largest):
    # odd in the amplitude: first order, at lam; even: second order, at 2 lam
    lam = complex(cc.linear.growth_rates(p, 0)["+-".index(branch)]).real
    errors = []
    for amplitude in (largest, largest / 2, largest / 4):
        found = {}
        for sign in (1, -1):
            state = cc.Eigenmode(0, sign * amplitude, branch).state(p, 64)
            radius, bound = fields(state, 0)
            changes = rates_of_change(p, radius, bound, state.tension)
            found[sign] = [
                np.array([f.mean() for f in pair])
                for pair in ((radius - 1.0, bound - p.n_bar), changes)
            ]
        (up, change_up), (down, change_down) = found[1], found[-1]
        errors.append(np.abs(change_up - change_down - lam * (up - down)))
        errors.append(np.abs(change_up + change_down - 2.0 * lam * (up + down)))
    odd, even = np.array(errors).reshape(3, 2, 2).transpose(1, 2, 0)
    assert all(orders(e) == pytest.approx((3.0, 3.0), abs=0.15) for e in odd)
    assert all(min(orders(e)) > 3.5 for e in even if e[2] > 1e-11 * abs(lam))


def test_oscillating_breathing_mode_has_its_first_two_derivatives():
    # Re a (1, n, r) exp(lam t), amplitude so small that only the linear part shows
    p, a = CELL, 1e-7
    lam = complex(cc.linear.growth_rates(p, 0)[0])
    assert lam.imag > 0.0
    state = cc.Eigenmode(0, a).state(p, 64)
    radius, bound = fields(state, 0)
    shape, kinetics = rates_of_change(p, radius, bound, state.tension)
    q = p.r_on + p.r_p
    ratio_n = p.n_bar * lam / (p.epsilon * cc.linear.base_state(p).c * (lam + q))
    assert shape.mean() == pytest.approx(a * lam.real, rel=1e-3)
    assert kinetics.mean() == pytest.approx(a * (ratio_n * lam).real, rel=1e-3)


@pytest.mark.parametrize("elasticity", ["printed", "consistent"])
@pytest.mark.parametrize(("k", "branch"), [(0, "+"), (0, "-"), (1, "+"), (4, "-"), (12, "+")])
def test_tension_law_holds_between_rest_and_start(elasticity, k, branch):
    p = CELL.replace(elasticity=elasticity)
    state = cc.Eigenmode(k, 1e-4, branch).state(p, 256)
    grown = p.tension_rate * (state.curve.area - math.pi)
    assert state.tension - p.sigma_bar == pytest.approx(grown, rel=1e-6, abs=1e-14 * p.tension_rate)


def test_stiffness_holds_the_area_at_second_order():
    def change(k_sigma):
        p = STIFF.replace(k_sigma=k_sigma)
        return cc.Eigenmode(2, 1e-3).state(p, 128).curve.area - math.pi

    assert change(1e5) / change(1e4) == pytest.approx(0.1, rel=1e-2)


def test_shift_is_a_circle_of_radius_1_up_to_third_order():
    # branch "-" of k = 1 is a translation: R = a cos phi + sqrt(1 - a^2 sin^2 phi)
    errors = []
    for amplitude in (0.04, 0.02, 0.01):
        state = cc.Eigenmode(1, amplitude, "-").state(CELL, 128)
        x, y = state.curve.points.T
        errors.append(np.abs(np.hypot(x - amplitude, y) - 1.0).max())
        assert state.curve.area == pytest.approx(math.pi, abs=amplitude**4)
    assert min(orders(errors)) > 2.9


def test_pair_travels_one_way_on_each_branch():
    # R = Re a exp(i k phi + lam t): the crest moves at -Im lam / k
    for branch, way in (("+", -1.0), ("-", 1.0)):
        lam = complex(cc.linear.growth_rates(CELL, 10)["+-".index(branch)])
        state = cc.Eigenmode(10, 1e-5, branch).state(CELL, 256)
        radius, bound = fields(state, 10)
        change = rates_of_change(CELL, radius, bound, state.tension)[0]
        turning = wave(change, 10) / wave(radius - 1.0, 10)
        assert turning == pytest.approx(lam, rel=1e-4)
        assert math.copysign(1.0, -cmath.phase(turning)) == way


def test_amplitude_too_large_for_a_cell_is_one_line():
    with pytest.raises(cc.InputError, match=r"bound_fraction is|radius|amplitude") as error:
        cc.Eigenmode(0, -0.5, "-").state(STIFF, 64)
    assert "\n" not in str(error.value)


def test_harmonic_the_nodes_cannot_show_is_left_out():
    few, many = (cc.Eigenmode(9, 1e-3).state(CELL, nodes) for nodes in (20, 256))
    assert few.tension == pytest.approx(many.tension, rel=1e-12)
