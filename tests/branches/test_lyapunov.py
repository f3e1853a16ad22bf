import math

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl import branches

HIGH = cc.Parameters(r_on=56, zeta_1=560)


@pytest.fixture(scope="module")
def glider() -> branches.SteadyState:
    return branches.from_circle(HIGH).continue_in("r_on", 56, spectra=False)[-1]


@pytest.mark.parametrize("r_on", [56.0, 54.0])  # stable, and unstable to turning
def test_the_exponent_of_a_steady_cell_is_its_leading_growth_rate(glider, r_on):
    state = glider
    if r_on != 56.0:
        state = glider.continue_in("r_on", r_on, spectra=False)[-1]
    found = branches.lyapunov_exponent(state.parameters, start=state, t_end=60, nodes=128)
    assert found.value == pytest.approx(state.eigenvalues[0].real, abs=max(found.error, 2e-3))
    assert found.label == "steady glide"
    assert found.zeros == ("time", "direction", "place", "first node")


def test_the_exponent_of_an_orbit_is_that_of_its_multiplier():
    p = cc.Parameters(r_on=24, zeta_1=540)
    found = branches.lyapunov_exponent(p, t_end=104, nodes=192)
    rate = math.log(0.506) / 12.9350
    assert found.value == pytest.approx(rate, abs=3e-3)
    assert found.label == "periodic"


def test_a_map_holds_exponents_and_labels_over_its_grid():
    p = cc.Parameters(D=0.2)
    found = branches.lyapunov_map(p, r_on=[55.0, 120.0], zeta_1=[560.0], t_end=40)
    assert found["exponent"].dims == ("zeta_1", "r_on")
    assert set(found["label"].values.ravel()) <= set(branches.LABELS)
    assert np.all(found["exponent"].values < 0.0)


def test_what_cannot_be_measured_is_refused_in_a_sentence():
    with pytest.raises(cc.InputError, match="t_end"):
        branches.lyapunov_exponent(HIGH, t_end=1.0)
    with pytest.raises(cc.InputError, match="multiple of 8"):
        branches.lyapunov_exponent(HIGH, nodes=100)
