import math

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl import branches
from cellcrawl.branches.equations import measure
from cellcrawl.branches.system import System

TURNING = cc.Parameters(r_on=50, zeta_1=560)


@pytest.fixture(scope="module")
def sharp() -> branches.SteadyState:
    return branches.gliding(cc.Parameters(r_on=16, zeta_1=600))


@pytest.fixture(scope="module")
def turner() -> branches.SteadyState:
    return branches.turning(TURNING)


def test_a_gliding_cell_with_corners_has_the_numbers_of_an_independent_code(sharp):
    assert sharp.speed == pytest.approx(0.1862907286, abs=2e-10)
    assert sharp.circularity == pytest.approx(0.725175835, abs=2e-9)
    assert sharp.tension == pytest.approx(669.308061, abs=2e-6)
    assert sharp.length == pytest.approx(7.391549802, abs=2e-9)
    assert sharp.largest_curvature == pytest.approx(15.9034, abs=1e-4)
    assert sharp.stable
    assert sharp.eigenvalues[0].real == pytest.approx(-0.0071, abs=5e-5)


def test_a_nearly_round_gliding_cell_has_the_numbers_of_an_independent_code():
    state = branches.gliding(cc.Parameters(r_on=56, zeta_1=560))
    assert state.speed == pytest.approx(0.05453426996, abs=2e-11)
    assert state.circularity == pytest.approx(0.9998130747, abs=2e-10)
    assert state.tension == pytest.approx(1240.327142, abs=2e-6)


def test_a_turning_cell_has_the_numbers_of_an_independent_code(turner):
    assert abs(turner.turning_rate) == pytest.approx(0.509857369, abs=2e-9)
    assert turner.speed == pytest.approx(0.136935152, abs=2e-9)
    assert turner.path_radius == pytest.approx(0.26857541, abs=2e-8)
    assert turner.kind == "turning"


def test_what_means_nothing_neither_grows_nor_decays(sharp, turner):
    assert np.abs(sharp.neutral_eigenvalues).max() < 1e-8
    spin = sorted(turner.neutral_eigenvalues.imag)
    assert spin == pytest.approx([-0.509857369, 0.0, 0.0, 0.509857369], abs=1e-8)
    assert np.abs(turner.neutral_eigenvalues.real).max() < 1e-8


@pytest.mark.parametrize("elasticity", ["printed", "consistent"])
@pytest.mark.parametrize("laws", [None, cc.laws.CatchSlip(catch=40.0, slip=0.6, slip_force=1.1)])
def test_the_spectrum_of_the_circle_is_that_of_the_quadratics(elasticity, laws):
    p = cc.Parameters(r_on=15, zeta_1=600, elasticity=elasticity)
    found = branches.circle(p, laws=laws).eigenvalues_by_symmetry
    for k in range(21):
        rates = cc.linear.growth_rates(p, k, laws=laws)
        wanted = rates[np.argmax(np.abs(rates))][None] if k == 1 else rates
        for symmetry, values in found.items():
            if k == 0 and symmetry == "antisymmetric":
                continue
            for rate in wanted:
                assert np.abs(values - rate).min() < 1e-10 * max(1.0, abs(rate))


@pytest.mark.parametrize("mirror", [True, False])
def test_the_jacobian_is_the_derivative_of_the_residual(turner, mirror):
    setting = turner.setting
    state = branches.gliding(TURNING) if mirror else turner
    system, y, phi = state.system, state.unknowns, state.phi
    reference = system.unpack(y)[0]
    _, now, whole = system.evaluate(setting, y, phi, reference)
    jacobian = system.jacobian(setting, y, now, whole, reference)
    smooth = np.cos(3.0 * np.arange(system.size)) / (1.0 + np.arange(system.size)) ** 2
    step = 1e-6
    up, down = (
        system.evaluate(setting, y + sign * step * smooth, phi, reference)[0] for sign in (1, -1)
    )
    slope = (up - down) / (2.0 * step)
    assert jacobian @ smooth == pytest.approx(slope, abs=1e-6 * np.abs(slope).max())


def test_half_a_cell_and_a_whole_cell_have_the_same_rates(sharp):
    whole = System(sharp.mesh, mirror=False)
    phi = sharp.mesh.unfolded(sharp.phi, 1.0)
    residual, _, _ = whole.evaluate(sharp.setting, whole.pack(sharp.fields), phi, sharp.fields)
    assert np.abs(residual).max() < 1e-8
    assert measure(sharp.mesh, sharp.fields.w, sharp.length).closure == pytest.approx([0, 0])


def test_a_run_from_a_state_keeps_its_speed(turner):
    run = cc.simulate(TURNING, t_end=2.0, start=turner, rtol=1e-7, save_every=0.05)
    assert run["tension"].values[-1] == pytest.approx(turner.tension, rel=1e-8)
    path = run["centroid_x"].values, run["centroid_y"].values
    chord = math.hypot(path[0][-1] - path[0][0], path[1][-1] - path[1][0])
    turn = abs(turner.turning_rate)
    assert chord == pytest.approx(2.0 * turner.speed / turn * math.sin(turn), abs=1e-7)


def test_a_perturbed_state_grows_as_its_eigenvalue_says():
    state = branches.gliding(cc.Parameters(r_on=54, zeta_1=560))  # turns: one growth rate above 0
    rate = state.eigenvalues[0]
    assert rate.real > 0.0
    assert rate.imag == 0.0

    class Perturbed:
        def state(self, parameters, nodes):
            return state.perturbed(0, 1e-4)

        def describe(self):
            return {"kind": "perturbed"}

    run = cc.simulate(state.parameters, t_end=6.0, start=Perturbed(), rtol=1e-8, save_every=3)
    bound = run["bound_fraction"].values
    waves = np.fft.rfft(bound, axis=1)
    lopsided = np.abs((waves[:, 2] / waves[:, 1] ** 2).imag)  # 0 with a mirror axis
    grown = math.log(lopsided[2] / lopsided[1]) / 3.0
    assert grown == pytest.approx(rate.real, rel=1e-3)


def test_from_run_finds_the_state_at_the_end_of_a_run():
    p = cc.Parameters(r_on=56, zeta_1=560)
    run = cc.simulate(p, t_end=60, start=cc.PerturbedCircle(bound_fraction={1: (0.01, 0.003)}))
    state = branches.from_run(run)
    assert state.speed == pytest.approx(0.05453426996, abs=1e-9)
    assert cc.observables.circularity(state.dataset()).item() == pytest.approx(state.circularity)


def test_a_run_that_is_not_steady_is_refused_in_a_sentence():
    run = cc.simulate(cc.Parameters(r_on=26, zeta_1=600), t_end=40, save_every=0.5)
    with pytest.raises(cc.InputError, match="not steady at its end"):
        branches.from_run(run)
    torn = run.assign_attrs(status="fragmented")
    with pytest.raises(cc.InputError, match="ended as 'fragmented'"):
        branches.from_run(torn)
