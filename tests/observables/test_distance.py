"""Straightness and mean distance of tracks with known answers."""

from __future__ import annotations

import math

import numpy as np
import pytest

import cellcrawl as cc
from tests.runs import circling, straight
from tests.tracks import straight_track


def test_straightness_is_net_over_path():
    assert cc.observables.straightness(*straight_track()) == pytest.approx(1.0)
    t = np.linspace(0.0, math.pi, 2001)
    half_circle = cc.observables.straightness(t, np.cos(t), np.sin(t))
    assert half_circle == pytest.approx(2.0 / math.pi, rel=1e-5)
    closed = cc.observables.straightness(2.0 * t, np.cos(2.0 * t), np.sin(2.0 * t))
    assert closed == pytest.approx(0.0, abs=1e-12)
    assert math.isnan(cc.observables.straightness(t, 0.0 * t, 0.0 * t))


def test_mean_distance_is_the_time_mean_from_the_first_position():
    """MODEL.md, section 8: of a straight line, half the way; of a circle, 4 R / pi."""
    assert cc.observables.mean_distance(*straight_track(speed=0.2)) == pytest.approx(10.0)
    run = circling(0.4, radius=3.0, records=2001, step=2.0 * math.pi / 0.4 / 2000)
    assert cc.observables.mean_distance(run) == pytest.approx(12.0 / math.pi, rel=1e-5)


def test_mean_distance_after_a_time_still_starts_at_the_first_position():
    found = cc.observables.mean_distance(*straight_track(speed=0.2), after=5.0)
    assert found == pytest.approx(0.2 * 0.5 * (5.0 + 100.0))


def test_mean_distance_weighs_time_not_records():
    t = np.concatenate([np.linspace(0.0, 1.0, 1001), np.linspace(1.1, 10.0, 90)])
    assert cc.observables.mean_distance(t, t, 0.0 * t) == pytest.approx(5.0)


def test_mistakes_are_one_line():
    with pytest.raises(cc.InputError, match="fewer than two records"):
        cc.observables.mean_distance(straight(), after=50.0)
    with pytest.raises(cc.InputError, match="t must rise"):
        cc.observables.straightness([1.0, 0.0], [0, 0], [0, 0])
