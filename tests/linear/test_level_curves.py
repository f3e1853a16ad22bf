"""Curves and roots of known functions."""

from __future__ import annotations

import math

import numpy as np
import pytest

from cellcrawl.linear.level_curves import level_curves
from cellcrawl.numerics.bracketing import all_roots, bracketed_roots

GRID = np.linspace(-2.0, 2.0, 41)


def area(curve):
    x, y = curve.T
    return 0.5 * np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])


def test_a_disc_is_one_closed_curve_counter_clockwise_on_the_circle():
    (curve,) = level_curves(lambda x, y: 1.0 - x**2 - y**2, GRID, GRID)
    assert np.array_equal(curve[0], curve[-1])
    np.testing.assert_allclose(np.hypot(*curve.T), 1.0, rtol=0, atol=1e-14)
    assert area(curve) == pytest.approx(math.pi, rel=5e-3)


def test_a_hole_is_clockwise():
    (curve,) = level_curves(lambda x, y: x**2 + y**2 - 1.0, GRID, GRID)
    assert area(curve) == pytest.approx(-math.pi, rel=5e-3)


def test_a_ring_has_two_branches():
    curves = level_curves(lambda x, y: 0.25 - (np.hypot(x, y) - 1.0) ** 2, GRID, GRID)
    areas = sorted(area(curve) for curve in curves)
    assert areas == pytest.approx([-0.25 * math.pi, 2.25 * math.pi], rel=0.02)


def test_branches_that_leave_the_box_end_on_its_border():
    curves = level_curves(lambda x, y: np.cos(math.pi * x) + 0.0 * y, GRID, GRID)
    assert len(curves) == 4
    for curve in curves:
        assert sorted((curve[0, 1], curve[-1, 1])) == [-2.0, 2.0]
        np.testing.assert_allclose(np.abs(curve[:, 0] % 1.0), 0.5, atol=1e-14)


@pytest.mark.parametrize("middle", [-0.01, 0.01])
def test_a_saddle_joins_the_corners_its_middle_says(middle):
    x = np.array([-1.0, 1.0])
    curves = level_curves(lambda u, v: u * v + middle, x, x)
    assert len(curves) == 2
    for curve in curves:
        assert np.prod(curve.mean(axis=0)) * middle < 0.0


def test_no_sign_change_no_curve():
    assert level_curves(lambda x, y: 1.0 + x**2 + 0.0 * y, GRID, GRID) == []
    assert level_curves(lambda x, y: 0.0 * x * y, GRID, GRID) == []


def test_roots_are_exact_to_rounding():
    low, high = np.array([0.0, 1.0, -3.0, 0.0]), np.array([2.0, 2.0, 1.0, 1.0])
    expected = np.array([math.sqrt(2), math.log(4), -1.0, 0.1])

    def function(x):
        return np.stack(
            [x[0] ** 2 - 2, np.exp(x[1]) - 4, (x[2] + 1) ** 3, np.tanh(1e6 * (x[3] - 0.1))]
        )

    np.testing.assert_allclose(
        bracketed_roots(function, low, high), expected, rtol=1e-15, atol=1e-5
    )
    np.testing.assert_allclose(
        bracketed_roots(function, low, high)[[0, 1, 3]], expected[[0, 1, 3]], rtol=4e-16
    )


def test_a_jump_counts_as_a_root():
    found = bracketed_roots(lambda x: np.where(x > 1 / 3, 1.0, -7.0), np.zeros(1), np.ones(1))
    assert found[0] == pytest.approx(1 / 3, rel=1e-15)


def test_two_roots_in_one_step_are_found():
    gap = 1e-7
    roots = all_roots(lambda x: (x - 0.30003) ** 2 - gap**2, 0.0, 1.0)
    np.testing.assert_allclose(roots, [0.30003 - gap, 0.30003 + gap], atol=1e-12)
