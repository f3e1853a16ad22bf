"""Asymmetry of fields whose halves are known."""

from __future__ import annotations

import math

import numpy as np
import pytest

import cellcrawl as cc
from tests.runs import circle_on_track, straight

# A circle with n = 0.5 + 0.2 cos(angle to the front): the halves differ by 2 (2/pi) 0.2.
KNOWN = 0.2 * 2.0 / math.pi / 0.5


@pytest.mark.parametrize("velocity", [(0.2, 0.0), (-0.1, 0.3)])
def test_front_has_more_than_the_rear_and_left_as_much_as_right(velocity):
    run = straight(velocity, nodes=2048)
    front = cc.observables.front_rear_asymmetry(run)
    np.testing.assert_allclose(front, KNOWN, rtol=2e-3)
    np.testing.assert_allclose(cc.observables.left_right_asymmetry(run), 0.0, atol=1e-3)
    assert front.dims == ("time",)


def test_left_is_left_of_the_way_ahead():
    run = straight((0.2, 0.0), nodes=2048)
    angle = np.arctan2(run["y"] - run["centroid_y"], run["x"] - run["centroid_x"])
    linkers = (0.5 + 0.2 * np.sin(angle)).transpose("time", "node").values
    leaning = run.assign(bound_fraction=run["bound_fraction"].copy(data=linkers))
    np.testing.assert_allclose(cc.observables.left_right_asymmetry(leaning), KNOWN, rtol=2e-3)
    backwards = straight((-0.2, 0.0), nodes=2048).assign(bound_fraction=leaning["bound_fraction"])
    np.testing.assert_allclose(cc.observables.left_right_asymmetry(backwards), -KNOWN, rtol=2e-3)


def test_other_fields_can_be_asked_for():
    found = cc.observables.front_rear_asymmetry(straight(nodes=2048), "off_rate")
    np.testing.assert_allclose(found, -30.0 * 2.0 / math.pi / 50.0, rtol=2e-3)
    with pytest.raises(cc.InputError, match="did you mean 'off_rate'"):
        cc.observables.front_rear_asymmetry(straight(), "of_rate")


def test_a_cell_at_rest_has_no_front():
    run = circle_on_track(np.arange(3.0), lambda t: ((0.0, 0.0), (0.0, 0.0)))
    assert np.isnan(cc.observables.front_rear_asymmetry(run)).all()
