import pytest

import cellcrawl as cc
from cellcrawl import branches
from cellcrawl.branches.basins import wilson

BELOW = cc.Parameters(r_on=11.5, zeta_1=600)  # the round cell is stable, and so is a glider


def test_a_kick_makes_a_round_cell_glide_for_good_where_an_independent_code_says():
    found = branches.threshold_kick(BELOW, within=0.02, t_end=100)
    assert (found.below, found.above) == ("stationary", "gliding")
    assert 0.002 < found.low < found.high < 0.005
    assert found.high - found.low <= 0.02 * 0.05


def test_a_swollen_cell_breathes_where_another_zigzags():
    p = cc.Parameters(r_on=26, zeta_1=600)
    found = branches.basins(p, [branches.Swollen(0.1), branches.Swollen(0.0)], t_end=80)
    assert {share.mode for share in found} == {"breathing at rest", "zigzag"}


def test_shares_add_up_and_lie_within_their_intervals():
    found = branches.basins(BELOW, 6, amplitude=0.002, t_end=60)
    assert sum(share.count for share in found) == 6
    assert sorted(k for share in found for k in share.starts) == list(range(6))
    assert all(share.low <= share.fraction <= share.high for share in found)


def test_the_interval_is_wilsons():
    assert wilson(15, 50) == pytest.approx((0.1910, 0.4375), abs=1e-4)  # from tables
    assert wilson(0, 10)[0] == 0.0
    assert wilson(10, 10)[1] == pytest.approx(1.0)


def test_kicks_to_the_same_motion_are_refused():
    with pytest.raises(cc.InputError, match="both lead to 'gliding'"):
        branches.threshold_kick(BELOW, low=0.02, high=0.04, t_end=60)
    with pytest.raises(cc.InputError, match="starts is empty"):
        branches.basins(BELOW, [])
