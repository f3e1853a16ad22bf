import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl import branches


@pytest.fixture(scope="module")
def pitchfork() -> branches.SpecialPoint:
    branch = branches.from_circle(cc.Parameters(r_on=56, zeta_1=560)).continue_in("r_on", 54)
    return branch.special_points[0]


def test_a_curve_passes_the_points_of_branches_at_other_parameters(pitchfork):
    curve = pitchfork.continue_in("zeta_1", within={"zeta_1": (555.0, 566.0)})
    assert curve.statuses == ("border", "border")
    assert len(curve) > 3
    for point in (curve.points[0], curve.points[-1]):
        r_on, zeta_1 = point.parameters.r_on, point.parameters.zeta_1
        start = branches.from_circle(cc.Parameters(r_on=57, zeta_1=zeta_1))
        (direct,) = start.continue_in("r_on", r_on - 0.5).points("pitchfork")
        assert direct.value == pytest.approx(r_on, abs=1e-7)
    assert curve.table()["zeta_1"].is_monotonic_increasing or (
        curve.table()["zeta_1"].is_monotonic_decreasing
    )


@pytest.mark.slow
def test_a_curve_of_folds_passes_the_folds_of_branches():
    p = cc.Parameters(r_on=30, zeta_1=450)
    start = branches.from_circle(p, "zeta_1", speed=0.01)
    (fold,) = start.continue_in("zeta_1", 440.0, most_states=14, spectra=False).points("fold")
    curve = fold.continue_in("r_on", within={"r_on": (29.5, 30.5)})
    assert curve.statuses == ("border", "border")
    other = curve.points[0].parameters
    start = branches.from_circle(other, "zeta_1", speed=0.01)
    (direct,) = start.continue_in("zeta_1", 440.0, most_states=14, spectra=False).points("fold")
    assert direct.value == pytest.approx(other.zeta_1, abs=1e-7)


def test_a_curve_is_refused_where_it_has_no_meaning(pitchfork):
    with pytest.raises(cc.InputError, match="already"):
        pitchfork.continue_in("r_on")
    with pytest.raises(cc.InputError, match="must be below"):
        pitchfork.continue_in("zeta_1", within={"zeta_1": (600, 500)})
    with pytest.raises(cc.InputError, match="there is no parameter"):
        pitchfork.continue_in("zeta")
    ended = pitchfork.state.continue_in("r_on", 70, spectra=False).special_points[-1]
    assert ended.kind == "circle"
    with pytest.raises(cc.InputError, match="closed form"):
        ended.continue_in("zeta_1")


def test_the_change_at_a_special_point_is_a_picture_of_the_cell(pitchfork):
    run = pitchfork.dataset(0.05)
    assert run.sizes["time"] == 3
    angle, bound, _ = pitchfork.eigenvector()
    assert np.abs(np.concatenate([angle, bound])).max() == pytest.approx(1.0)
    mirrored = np.roll(bound[::-1], 1)
    assert bound.real == pytest.approx(-mirrored.real, abs=1e-6)
