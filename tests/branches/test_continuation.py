import itertools

import numpy as np
import pytest
import xarray as xr

import cellcrawl as cc
from cellcrawl import branches

HIGH = cc.Parameters(r_on=56, zeta_1=560)


@pytest.fixture(scope="module")
def branch() -> branches.Branch:
    return branches.from_circle(HIGH).continue_in("r_on", 16.9)


def test_gliding_leaves_the_circle_where_the_closed_form_says():
    assert branches.onsets(HIGH, "r_on", 1, 200) == pytest.approx(
        [13.296270189, 57.379211156], abs=1e-9
    )
    assert branches.onset_slope(HIGH, near=13)[1] == pytest.approx(-153.488, abs=1e-3)
    assert branches.onset_slope(HIGH, near=57)[1] == pytest.approx(-441.859, abs=1e-3)


def test_gliding_loses_stability_where_an_independent_code_says(branch):
    assert branch.status == "completed"
    assert branch.values[-1] == 16.9
    first, last = branch.special_points[0], branch.special_points[-1]
    assert (first.kind, first.symmetry) == ("pitchfork", "antisymmetric")
    assert first.parameters.r_on == pytest.approx(54.817202, abs=1e-6)
    assert (last.kind, last.symmetry) == ("Hopf", "antisymmetric")
    assert last.parameters.r_on == pytest.approx(17.576447, abs=1e-6)
    assert last.frequency == pytest.approx(0.832108, abs=1e-6)
    assert branch[0].stable
    assert branch[-1].stable


def test_each_special_point_changes_the_number_of_growing_changes_by_its_own(branch):
    counts = [state.unstable_modes for state in branch]
    steps = sum(abs(after - before) for before, after in itertools.pairwise(counts))
    weight = {"Hopf": 2, "pitchfork": 1, "branch point": 1, "fold": 1}
    assert steps == sum(weight[point.kind] for point in branch.special_points)


def test_a_line_becomes_solid_at_the_special_point_itself(branch):
    lines = [line for line in cc.plot.branch(branch).lines if line.get_linestyle() == "-"]
    solid = [sorted((line.get_xdata()[0], line.get_xdata()[-1])) for line in lines]
    assert np.allclose(solid[0], (54.817202, branch.values[0]), atol=1e-6)
    assert np.allclose(solid[1], (16.9, 17.576447), atol=1e-6)
    assert len(solid) == 2


def test_turning_leaves_gliding_at_the_pitchfork_and_ends_at_a_hopf_point(branch):
    turner = branch.special_points[0].branch_off()
    assert turner.kind == "turning"
    turning = turner.continue_in("r_on", 44.0)
    (hopf,) = turning.points("Hopf")
    assert hopf.value == pytest.approx(44.330986, abs=1e-6)
    back = turning[1].continue_in("r_on", 60.0, spectra=False)
    assert back.status == "gliding"
    assert back.special_points[0].value == pytest.approx(54.817202, abs=1e-3)


def test_a_branch_ends_at_the_circle_and_says_so(branch):
    ended = branch[3].continue_in("r_on", 70)
    assert ended.status == "circle"
    assert ended.special_points[-1].value == pytest.approx(57.379211156, abs=1e-8)
    assert "met the resting circle" in ended.message


def test_a_branch_goes_round_a_fold():
    p = cc.Parameters(r_on=30, zeta_1=450)
    onset, slope = branches.onset_slope(p, "zeta_1")
    assert slope < 0.0  # gliding begins with a jump
    start = branches.from_circle(p, "zeta_1", speed=0.01)
    branch = start.continue_in("zeta_1", 440.0, most_states=14)
    (fold,) = branch.points("fold")
    assert fold.value < onset
    assert fold.value <= branch.values.min()
    assert branch.status == "states" or branch.values[-1] > fold.value
    before, after = branch[int(fold.position)], branch[int(fold.position) + 1]
    counts = [np.sum(s.eigenvalues_by_symmetry["symmetric"].real > 0) for s in (before, after)]
    assert abs(counts[0] - counts[1]) == 1


def test_a_branch_is_a_table_and_a_dataset(branch):
    table = branch.table()
    assert len(table) == len(branch)
    assert table["speed"].to_numpy() == pytest.approx([state.speed for state in branch])
    run = branch.dataset(nodes=512)
    assert isinstance(run, xr.Dataset)
    circularity = cc.observables.circularity(run).values
    assert circularity == pytest.approx(table["circularity"].to_numpy(), abs=1e-6)
    assert run["branch_r_on"].values == pytest.approx(branch.values)


def test_a_branch_that_was_stopped_goes_on_to_the_same_bits(tmp_path, branch):
    file = tmp_path / "branch.nc"
    start = branch[4]
    whole = start.continue_in("r_on", 46)
    part = start.continue_in("r_on", 46, output=file, most_states=3)
    assert part.status == "states"
    assert len(branches.open_branch(file)) == 3
    resumed = branches.resume_branch(file)
    assert resumed.status == "completed"
    assert np.array_equal(resumed.values, whole.values)
    assert np.array_equal(resumed[-1].unknowns, whole[-1].unknowns)
    again = branches.open_branch(file)
    kinds = [(point.kind, point.value) for point in whole.special_points]
    assert [(point.kind, point.value) for point in again.special_points] == kinds
    assert np.array_equal(again[-1].eigenvalues, whole[-1].eigenvalues)


def test_a_damaged_branch_is_refused(tmp_path, branch):
    file = tmp_path / "branch.nc"
    branch[0].continue_in("r_on", 57, output=file, spectra=False)
    content = bytearray(file.read_bytes())
    at = content.find(b'"rest_area": 3.14159')
    content[at + 16] = ord("7")
    file.write_bytes(content)
    with pytest.raises(cc.StorageError):
        branches.open_branch(file)
    with pytest.raises(cc.InputError, match="there is no branch"):
        branches.open_branch(tmp_path / "none.nc")


def test_a_parameter_of_a_law_can_be_followed():
    soft = branches.from_circle(HIGH, laws=cc.laws.Stiffness(chi=1.0)).continue_in("r_on", 56)
    branch = soft[-1].continue_in("chi", 0.9, spectra=False)
    assert branch.status == "circle"  # crawling stops on soft ground
    assert branch.special_points[-1].value == pytest.approx(0.984, abs=5e-4)


def test_what_cannot_be_followed_is_refused_in_one_line(branch):
    with pytest.raises(cc.InputError, match="there is no parameter"):
        branch[0].continue_in("r_onn", 20)
    with pytest.raises(cc.InputError, match="out of range"):
        branch[0].continue_in("r_on", 500)
    with pytest.raises(cc.InputError, match="already"):
        branch[0].continue_in("r_on", branch.values[0])
    with pytest.raises(cc.InputError, match="resting circle"):
        branches.circle(HIGH).continue_in("r_on", 20)
    with pytest.raises(cc.InputError, match="k_sigma = 0"):
        branches.gliding(HIGH.replace(k_sigma=0))
    with pytest.raises(cc.InputError, match="k_sigma = 0"):  # before anything is computed
        branch[0].continue_in("k_sigma", 0.0)


def test_turning_cells_go_on_from_where_gliding_ones_begin_to_turn():
    gliding = branches.gliding(cc.Parameters(r_on=55.2, zeta_1=560)).continue_in("r_on", 54.5)
    turning = gliding.points("pitchfork")[0].branch_off().continue_in("r_on", 52.0)
    assert turning.status == "completed"
    assert turning[-1].kind == "turning"
