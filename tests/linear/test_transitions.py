"""Onset of oscillation (the paper's "Hopf") and Hopf points, told apart."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import cellcrawl as cc
from tests.strategies import TABLE, parameters

linear = cc.linear
P = cc.Parameters(r_on=25, zeta_1=600)


def test_first_pair_and_cutoff_of_model_md():
    first, last = linear.oscillation_onset(P, k=(1, 100))
    assert 7 < first.value < 8  # first complex pair: k = 8
    assert (first.along, first.rising, last.rising) == ("k", True, False)
    (hopf,) = linear.hopf_points(P, k=(1, 100))
    assert 15 < hopf.value < 16  # highest unstable: k = 15
    assert (hopf.growth_rate, hopf.rising) == (0.0, False)
    assert hopf.value == pytest.approx(float(linear.cutoff_wavenumber(P)), rel=1e-12)


def test_onset_is_where_the_triangle_of_theory_is_flat():
    # sqrt(b) = sqrt(a q) + sqrt(S c), or differs from sqrt(S c) by sqrt(a q)
    base = linear.base_state(P)
    for t in linear.oscillation_onset(P, k=(1, 100)):
        q = P.r_on + P.r_p + P.D * t.value**2
        s = P.epsilon * P.h * P.sigma_bar * (t.value**2 - 1)
        sides = np.sort(np.sqrt([base.a * q, s * base.c, base.b]))
        assert sides[2] == pytest.approx(sides[0] + sides[1], rel=1e-10)


@settings(max_examples=40)
@given(parameters, st.integers(0, 20), st.sampled_from(list(TABLE)))
def test_roots_change_kind_where_they_are_said_to(p, k, name):
    low, high = TABLE[name][1:]
    step = 1e-6 * (high - low)
    for t in linear.oscillation_onset(p, k, **{name: (low, high)}):
        if low + step < t.value < high - step:
            below, above = (
                linear.growth_rates(p.replace(**{name: t.value + way}), k)[0].imag > 0
                for way in (-step, step)
            )
            assert below != above or _twice(p, k, name, t, step)
            pair = linear.growth_rates(p.replace(**{name: t.value}), k)
            assert np.abs(pair - t.growth_rate).max() <= 1e-4 * (1 + np.abs(pair).max())
    for t in linear.hopf_points(p, k, **{name: (low, high)}):
        pair = linear.growth_rates(p.replace(**{name: t.value}), k)
        assert np.abs(pair.real).max() <= 1e-9 * (1 + p.zeta_1 + p.k_sigma)
        assert pair[0].imag == pytest.approx(t.frequency, rel=1e-6, abs=1e-9)
        assert t.frequency > 0.0


def _twice(p, k, name, t, step):
    """Two onsets closer than the step with which they are checked."""
    values = [u.value for u in linear.oscillation_onset(p, k, **{name: TABLE[name][1:]})]
    return sum(abs(value - t.value) < 2 * step for value in values) > 1


def test_translation_never_oscillates():
    for name in ("r_on", "zeta_1", "D", "sigma_c"):
        assert linear.oscillation_onset(P, 1, **{name: TABLE[name][1:]}) == []
        assert linear.hopf_points(P, 1, **{name: TABLE[name][1:]}) == []


def test_breathing_mode_has_hopf_points_with_the_printed_law_alone():
    lower, upper = linear.hopf_points(P, 0, r_on=(1, 200))
    assert lower.value < 25 < upper.value  # unstable at (25, 600): 4.65 +- 15.5i
    assert (lower.rising, upper.rising) == (True, False)
    assert linear.hopf_points(P.replace(elasticity="consistent"), 0, r_on=(1, 200)) == []


def test_the_two_kinds_are_apart():
    # oscillation begins while the mode grows; it stops growing only much later
    (onset, _), (hopf,) = linear.oscillation_onset(P, k=(1, 100)), linear.hopf_points(P, k=(1, 100))
    assert onset.growth_rate > 4.0
    assert onset.frequency == 0.0
    assert hopf.frequency > 9.0
    assert hopf.value - onset.value > 7.0


@pytest.mark.parametrize("find", [linear.oscillation_onset, linear.hopf_points])
@pytest.mark.parametrize(
    ("k", "ranges", "says"),
    [
        (8, {}, "not 0"),
        ((1, 20), {"r_on": (1, 20)}, "not 2"),
        (8, {"r_on": (20, 1)}, "lower one first"),
        (8, {"r_on": 20}, "range of two"),
        (8, {"r_on": (0.5, 20)}, "r_on = 0.5"),
        (8, {"zeta1": (1, 20)}, "did you mean 'zeta_1'"),
        ((0, 20), {}, "k = 0"),
        (-3, {"r_on": (1, 20)}, "k = -3"),
        ("x", {"r_on": (1, 20)}, "k must be"),
        ((1, math.inf), {}, "k is not finite"),
    ],
)
def test_mistakes_are_one_line(find, k, ranges, says):
    with pytest.raises(cc.InputError, match=says) as error:
        find(P, k, **ranges)
    assert "\n" not in str(error.value)
