import math
from concurrent.futures import Executor

import pytest

import cellcrawl as cc
from cellcrawl import branches
from cellcrawl.linear import growth_rates

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


def test_an_early_end_keeps_the_rate_of_an_orbit_and_is_exact_for_a_steady_cell(glider):
    p = cc.Parameters(r_on=24, zeta_1=540)
    found = branches.lyapunov_exponent(p, t_end=1000, nodes=192, early=True)
    assert 120.0 <= found.time < 1000.0
    assert found.value == pytest.approx(math.log(0.506) / 12.9350, abs=max(found.error, 3e-3))
    assert found.label == "periodic"
    start = cc.PerturbedCircle(bound_fraction={1: (0.01, 0.0)})
    steady = branches.lyapunov_exponent(HIGH, start=start, settle=40, early=True)
    assert steady.value == pytest.approx(glider.eigenvalues[0].real, abs=1e-7)
    assert (steady.error, steady.time, steady.label) == (0.0, 0.0, "steady glide")


def test_a_map_goes_on_from_its_file_and_holds_exponents_and_labels(tmp_path):
    p, file = cc.Parameters(zeta_1=400), tmp_path / "map.nc"
    asked = {"r_on": [50.0, 60.0], "zeta_1": [400.0, 420.0], "t_end": 40.0}
    asked_of = []

    class Stopped(Exception):
        pass

    class Pool(Executor):  # one cell after the other, and no more than three
        def map(self, function, tasks):
            for task in tasks:
                if len(asked_of) == 3:
                    raise Stopped
                asked_of.append(task)
                yield function(task)

    whole = branches.lyapunov_map(p, **asked)
    assert whole["exponent"].dims == ("zeta_1", "r_on")
    round_one = p.replace(r_on=50)
    rates = [growth_rates(round_one, k).real.max() for k in (0, *range(2, 9))]
    rates.append(growth_rates(round_one, 1).real.min())  # the other is 0: a shift
    assert whole["exponent"].values[0, 0] == pytest.approx(max(rates), abs=1e-8)
    assert set(whole["label"].values.ravel()) == {"at rest"}
    with pytest.raises(Stopped):
        branches.lyapunov_map(p, **asked, output=file, executor=Pool())
    asked_of.clear()
    again = branches.lyapunov_map(p, **asked, output=file, executor=Pool())
    assert len(asked_of) < 4
    assert again.identical(whole)
    assert branches.open_lyapunov_map(file).identical(whole)
    assert cc.plot.lyapunov_map(whole).get_legend().get_texts()[0].get_text() == "at rest (4)"
    with pytest.raises(cc.InputError, match="other cells"):
        branches.lyapunov_map(p, **{**asked, "t_end": 50.0}, output=file)


def test_what_cannot_be_measured_is_refused_in_a_sentence():
    with pytest.raises(cc.InputError, match="t_end"):
        branches.lyapunov_exponent(HIGH, t_end=1.0)
    with pytest.raises(cc.InputError, match="multiple of 8"):
        branches.lyapunov_exponent(HIGH, nodes=100)
