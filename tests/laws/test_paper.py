"""The paper's law set says what equations 3 and 5-8 say."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cellcrawl.laws import PAPER
from cellcrawl.laws.rest import local_values
from tests.strategies import parameters

fractions = st.floats(0.0, 1.0)


def law(what, p, **state):
    values = {"phi": 0.0, "r": 1.0, "n": 0.0, "sigma": 0.0, "kappa": 0.0}
    return PAPER.compiled.evaluate(what, {**values, **local_values(p, PAPER), **state})


@given(parameters)
def test_edge_of_the_resting_circle_does_not_move(p):
    state = {"phi": math.log(p.r_p), "r": p.r_p, "n": p.n_bar}
    assert law("velocity", p, **state) == pytest.approx(0.0, abs=1e-9)
    assert law("binding", p, **state) == pytest.approx(0.0, abs=1e-11)


@given(parameters, fractions)
def test_unstressed_edge_moves_at_the_polymerization_velocity(p, n):
    assert law("velocity", p, n=n) == p.epsilon * p.v_p
    assert law("friction", p, n=n) == 0.0


@given(parameters, st.floats(1.0, 200.0))
def test_kinetics_keep_the_bound_fraction_between_0_and_1(p, r):
    assert law("binding", p, n=0.0, r=r, phi=math.log(r)) > 0.0
    assert law("binding", p, n=1.0, r=r, phi=math.log(r)) < 0.0


@given(parameters, fractions, st.floats(0.0, 5.0), st.floats(-500.0, 2000.0), st.floats(-5.0, 5.0))
def test_the_balance_is_equation_8(p, n, y, sigma, kappa):
    r = math.exp(y)
    written = y * r + p.zeta_1 * n * y - p.sigma_c - sigma * (1.0 + kappa * p.h)
    size = y * r + p.zeta_1 * n * y + p.sigma_c + abs(sigma) * (1.0 + abs(kappa) * p.h)
    found = law("balance", p, phi=y, r=r, n=n, sigma=sigma, kappa=kappa)
    assert found == pytest.approx(written, abs=1e-14 * size)
    assert law("velocity", p, phi=y, r=r) == pytest.approx(
        p.epsilon * (p.v_p - r * y), abs=1e-14 * (p.v_p + r * y)
    )
