import cmath
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import cellcrawl as cc
from tests.strategies import parameters

wavenumbers = st.integers(0, 60)


def quadratic(p, k):
    """Coefficients of MODEL.md section 4, written out again."""
    log_r = math.log(p.r_p)
    n = p.r_on / (p.r_on + p.r_p)
    sigma = (p.r_p * log_r + p.zeta_1 * n * log_r - p.sigma_c) / (1 + p.h)
    a, b, c = 1 + log_r + p.zeta_1 * n / p.r_p, p.zeta_1 * n * log_r, 1 + log_r
    q = p.r_on + p.r_p + p.D * k**2
    gain = p.k_sigma if p.elasticity == "printed" else p.k_sigma / p.epsilon
    s = p.epsilon * p.h * sigma * (k**2 - 1)
    if k == 0:
        s = p.epsilon * (2 * math.pi * (1 + p.h) * gain - p.h * sigma)
    return a, a * q + s * c - b, s * c * q


@pytest.mark.parametrize(
    ("r_on", "zeta_1", "rate"),
    [
        (16, 600, 6.70),
        (24, 540, 7.37),
        (25, 600, 12.74),
        (26, 600, 13.00),
        (36, 560, 9.47),
        (56, 560, 0.83),
    ],
)
def test_translation_grows_as_model_md_says(r_on, zeta_1, rate):
    rates = cc.linear.growth_rates(cc.Parameters(r_on=r_on, zeta_1=zeta_1), 1)
    assert rates[0].real == pytest.approx(rate, abs=0.005)
    assert rates[0].imag == 0.0
    assert rates[1] == 0.0


def test_breathing_mode_of_both_readings():
    p = cc.Parameters(r_on=25, zeta_1=600)
    consistent = cc.linear.growth_rates(p.replace(elasticity="consistent"), 0)
    np.testing.assert_allclose(consistent, [-77, -3408], rtol=5e-3)
    printed = cc.linear.growth_rates(p, 0)
    assert printed[0] == pytest.approx(4.65 + 15.5j, rel=5e-3)
    assert printed[1] == printed[0].conjugate()


def test_highest_unstable_wavenumber_and_first_pair_at_25_600():
    rates = cc.linear.growth_rates(cc.Parameters(r_on=25, zeta_1=600), np.arange(1, 60))
    unstable = 1 + np.flatnonzero(rates[:, 0].real > 0)
    complex_pairs = 1 + np.flatnonzero(rates[:, 0].imag > 0)
    assert unstable.max() == 15
    assert np.array_equal(unstable, np.arange(1, 16))
    assert complex_pairs.min() == 8


@given(parameters, wavenumbers)
def test_rates_solve_the_quadratic(p, k):
    a, b, c = quadratic(p, k)
    pair = cc.linear.growth_rates(p, k)
    size = max(abs(b / a), math.sqrt(abs(c / a)))
    assert pair.sum() == pytest.approx(-b / a, rel=1e-12, abs=1e-12 * size)
    assert pair.prod() == pytest.approx(c / a, rel=1e-9, abs=1e-12 * size**2)
    for root in pair:
        scale = abs(a * root**2) + abs(b * root) + abs(c)
        assert abs(a * root**2 + b * root + c) <= 1e-9 * scale


@given(parameters, st.lists(wavenumbers, min_size=1, max_size=30))
def test_roots_are_ordered_and_pairs_conjugate(p, k):
    first, second = cc.linear.growth_rates(p, k).T
    real = first.imag == 0.0
    assert np.all(second[real].imag == 0.0)
    assert np.all(first[real].real >= second[real].real)
    assert np.all(first[~real].imag > 0.0)
    assert np.array_equal(second[~real], first[~real].conj())


@given(parameters, st.lists(wavenumbers, min_size=1, max_size=12))
def test_arrays_give_the_bits_of_single_wavenumbers(p, k):
    together = cc.linear.growth_rates(p, k)
    assert together.shape == (len(k), 2)
    assert all(
        np.array_equal(row, cc.linear.growth_rates(p, i))
        for i, row in zip(k, together, strict=True)
    )
    square = cc.linear.growth_rates(p, np.array([k, k]))
    assert square.shape == (2, len(k), 2)
    assert cc.linear.growth_rates(p, k[0]).shape == (2,)


@given(parameters)
def test_translation_has_a_rate_of_zero(p):
    assert 0.0 in cc.linear.growth_rates(p, 1)


@given(parameters)
def test_without_adhesion_everything_but_breathing_decays(p):
    free = p.replace(zeta_1=0.0)
    if free.sigma_bar > 0:
        rates = cc.linear.growth_rates(free, np.arange(1, 30))
        assert np.all(rates.real <= 1e-12)


def test_small_root_keeps_its_digits():
    # S_k c q / (a q - b) for the slow root where S_k is tiny: no cancellation
    p = cc.Parameters(epsilon=1e-5, h=1e-9, r_on=100.0, zeta_1=10.0)
    a, b, c = quadratic(p, 2)
    slow = cc.linear.growth_rates(p, 2)[0].real
    assert slow == pytest.approx(-c / b * (1 + a * c / b**2), rel=1e-13)


def test_rates_match_a_library_square_root():
    a, b, c = quadratic(cc.Parameters(), 8)
    root = cmath.sqrt(b * b - 4 * a * c)
    np.testing.assert_allclose(
        cc.linear.growth_rates(cc.Parameters(), 8),
        [(-b + root) / (2 * a), (-b - root) / (2 * a)],
        rtol=1e-12,
    )


def test_base_state_is_that_of_model_md():
    p = cc.Parameters(r_on=25, zeta_1=600)
    base = cc.linear.base_state(p)
    log_r = math.log(50)
    assert (base.off_rate, base.tension) == (50.0, p.sigma_bar)
    assert base.bound_fraction == pytest.approx(1 / 3)
    assert base.a == pytest.approx(1 + log_r + 4)
    assert base.b == pytest.approx(200 * log_r)
    assert base.c == pytest.approx(1 + log_r)


@pytest.mark.parametrize("k", ["1", None, math.nan, math.inf, [1, [2]], 1e9, [1j], True])
def test_wavenumbers_that_are_none_are_one_line(k):
    with pytest.raises(cc.InputError, match=r"^k "):
        cc.linear.growth_rates(cc.Parameters(), k)
