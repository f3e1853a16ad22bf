import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cellcrawl.physics import laws
from tests.strategies import parameters

y_values = st.floats(0.0, 8.0)
fractions = st.floats(0.0, 1.0)


def law(name):
    return getattr(laws, name)


@given(y_values, fractions, st.floats(0.0, 2000.0))
def test_slope_and_bend_are_the_derivatives_of_friction(y, n, zeta_1):
    def friction(z):
        return law("friction")(z, math.exp(z), n, zeta_1)

    step = 1e-4
    slope = (friction(y + step) - friction(y - step)) / (2 * step)
    bend = (friction(y + step) - 2 * friction(y) + friction(y - step)) / step**2
    r = math.exp(y)
    assert law("friction_slope")(y, r, n, zeta_1) == pytest.approx(slope, rel=1e-6)
    assert law("friction_bend")(y, r) == pytest.approx(bend, rel=1e-3, abs=0.01)


@given(parameters)
def test_edge_of_the_resting_circle_does_not_move(p):
    y = math.log(p.r_p)
    assert law("edge_velocity")(y, p.r_p, p.v_p, p.epsilon) == pytest.approx(0.0, abs=1e-9)
    assert law("binding_rate")(p.n_bar, p.r_p, p.r_on) == pytest.approx(0.0, abs=1e-11)


@given(parameters, fractions)
def test_unstressed_edge_moves_at_the_polymerization_velocity(p, n):
    assert law("edge_velocity")(0.0, 1.0, p.v_p, p.epsilon) == p.epsilon * p.v_p
    assert law("friction")(0.0, 1.0, n, p.zeta_1) == 0.0


@given(fractions, st.floats(1.0, 200.0), st.floats(1.0, 200.0))
def test_kinetics_keep_the_bound_fraction_between_0_and_1(n, r, r_on):
    assert law("binding_rate")(0.0, r, r_on) > 0.0
    assert law("binding_rate")(1.0, r, r_on) < 0.0


def test_pull_on_a_straight_edge_has_no_curvature_term():
    assert law("driving_force")(900.0, 0.0, 100.0, 0.01) == 1000.0
    assert law("driving_force")(900.0, 1.0, 100.0, 0.01) == pytest.approx(1009.0)
