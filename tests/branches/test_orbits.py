import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl import branches


def ended(r_on: float, zeta_1: float, t_end: float = 100.0):
    p = cc.Parameters(r_on=r_on, zeta_1=zeta_1)
    return cc.simulate(p, t_end=t_end, start=cc.RandomPerturbation(seed=1), save_every=0.5)


@pytest.fixture(scope="module")
def zigzag() -> branches.Orbit:
    return branches.orbit(ended(26, 600), nodes=256)


@pytest.fixture(scope="module")
def rotation() -> branches.Orbit:
    return branches.orbit(ended(24, 540), nodes=256)


def test_a_zigzag_comes_back_as_its_mirror_image_with_the_numbers_of_an_independent_code(zigzag):
    assert zigzag.kind == "zigzag"
    assert zigzag.reflected
    assert zigzag.period == pytest.approx(8.78882, abs=5e-4)
    assert zigzag.cycle == 2.0 * zigzag.period
    assert zigzag.multipliers[0] == pytest.approx(-0.867, abs=5e-3)
    assert zigzag.stable
    assert zigzag.tension_range == pytest.approx([886, 929], abs=0.5)
    assert zigzag.turning_rate == 0.0


def test_a_rotation_has_the_numbers_of_an_independent_code(rotation):
    assert rotation.kind == "rotation"
    assert rotation.period == pytest.approx(12.9350, abs=5e-5)
    assert abs(rotation.turn) == pytest.approx(1.2225, abs=5e-5)
    assert rotation.multipliers[0] == pytest.approx(-0.506, abs=5e-4)
    assert rotation.tension_range[0] == pytest.approx(776.43, abs=5e-3)
    assert 0.87 < rotation.circularity_range[0] < 0.92


def test_a_shift_in_time_neither_grows_nor_decays(zigzag, rotation):
    for orbit in (zigzag, rotation):
        assert orbit.neutral_multipliers == pytest.approx([1.0], abs=1e-3)


def test_a_run_from_an_orbit_comes_back_with_its_period(rotation):
    p, period = rotation.parameters, rotation.period
    run = cc.simulate(p, t_end=period, start=rotation, rtol=1e-6, save_every=period)
    assert run["tension"].values[1] == pytest.approx(run["tension"].values[0], rel=1e-4)
    for name in ("length", "area"):
        assert run[name].values[1] == pytest.approx(run[name].values[0], rel=1e-4)
    whole = rotation.dataset(nodes=128, records=9)
    for name in ("centroid_x", "centroid_y"):
        moved = run[name].values[1] - run[name].values[0]
        assert np.hypot(whole[name].values[-1], 0) < 3.0
        assert np.isfinite(moved)
    far = [
        np.hypot(*(np.ptp(d[n].values[[0, -1]]) for n in ("centroid_x", "centroid_y")))
        for d in (run, whole)
    ]
    assert far[0] == pytest.approx(far[1], abs=1e-4)


def test_small_orbits_leave_a_hopf_point_with_its_period_and_as_a_parabola():
    gliding = branches.from_circle(cc.Parameters(r_on=56, zeta_1=560)).continue_in("r_on", 54)
    turning = gliding.points("pitchfork")[0].branch_off()
    (wobble,) = turning.continue_in("r_on", 44.2).points("Hopf")
    assert wobble.value == pytest.approx(44.330986, abs=1e-6)  # of an independent code
    small, smaller = (branches.from_hopf(wobble, amplitude=a, nodes=256) for a in (0.01, 0.005))
    assert small.kind == "rotation"
    assert small.stable  # on the side where the steady turn is not: the wobble sets in gently
    assert small.parameters.r_on < wobble.value
    # both change with the square of the amplitude: carried on to none they are the point's own
    period = (4.0 * smaller.period - small.period) / 3.0
    r_on = (4.0 * smaller.parameters.r_on - small.parameters.r_on) / 3.0
    assert period == pytest.approx(2.0 * np.pi / wobble.frequency, rel=5e-4)
    assert r_on == pytest.approx(wobble.value, rel=5e-5)
    assert wobble.value - small.parameters.r_on > 0.02
    with pytest.raises(cc.InputError, match="born at a Hopf point"):
        branches.from_hopf(gliding.points("pitchfork")[0])


def test_extremes_of_a_rotation_lie_about_its_means(rotation):
    low, high = rotation.speed_range
    assert low < rotation.speed < high
    turning = rotation.turning_rate_range
    assert turning[0] < rotation.turning_rate < turning[1]
    p = rotation.parameters
    run = cc.simulate(p, t_end=rotation.period, start=rotation, rtol=1e-6, save_every=0.02)
    moved = np.hypot(*(np.diff(run[n].values) for n in ("centroid_x", "centroid_y"))) / 0.02
    assert (moved.min(), moved.max()) == pytest.approx((low, high), rel=0.01)
    assert run["tension"].max() == pytest.approx(rotation.tension_range[1], abs=5e-3)


def test_a_branch_of_orbits_goes_on_from_its_file_to_the_same_bits(tmp_path, rotation):
    file = tmp_path / "orbits.nc"
    options = {"nodes": 256, "spectra": False}
    whole = rotation.continue_in("r_on", 24.6, most_orbits=3, **options)
    part = rotation.continue_in("r_on", 24.6, most_orbits=2, output=file, **options)
    assert part.status == "orbits"
    resumed = branches.resume_orbits(file, most_orbits=3)
    assert np.array_equal(resumed.values, whole.values)
    assert np.array_equal(resumed[-1].shape, whole[-1].shape)
    assert len(branches.open_orbits(file).table()) == len(whole)
    run = branches.orbit(ended(whole[-1].parameters.r_on, 540), nodes=256)
    assert whole[-1].period == pytest.approx(run.period, abs=1e-4)


def test_what_is_no_orbit_is_refused_in_a_sentence():
    glider = cc.branches.from_circle(cc.Parameters(r_on=56, zeta_1=560)).continue_in(
        "r_on", 57.2, spectra=False
    )[-1]
    run = cc.simulate(glider.parameters, t_end=1.0, start=glider)
    with pytest.raises(cc.InputError, match="steady at its end"):
        branches.orbit(run)
    with pytest.raises(cc.InputError, match="ended as 'fragmented'"):
        branches.orbit(run.assign_attrs(status="fragmented"))
    with pytest.raises(cc.InputError, match="multiple of 8"):
        branches.orbit(run, nodes=100)
    breathing = cc.simulate(
        cc.Parameters(r_on=26, zeta_1=600), t_end=4, start=branches.Swollen(0.1, front=1e-9)
    )
    with pytest.raises(cc.InputError, match="round at the end"):
        branches.orbit(breathing)
