"""What is measured of long runs, on runs whose answers are known."""

from __future__ import annotations

import math

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.bench import exact
from cellcrawl.bench.long import Row, _errors
from tests.runs import straight


@pytest.mark.parametrize("step", [0.1, 0.0973])
def test_the_period_of_a_wave_is_found_between_its_records(step):
    time = np.arange(0.0, 300.0, step)
    angle = 2.0 * np.pi * time / 8.78882
    wave = 900.0 + 20.0 * np.sin(angle + 0.7) + 5.0 * np.cos(2.0 * angle)
    assert exact.mean_period(time, wave) == pytest.approx(8.78882, rel=3e-6)


def test_a_wave_that_comes_once_has_no_period():
    time = np.linspace(0.0, 1.0, 50)
    assert math.isnan(exact.mean_period(time, np.sin(6.0 * time)))


def test_the_law_is_measured_on_the_points_whatever_the_recorded_area_says():
    p = cc.Parameters()
    run = straight()
    law = {"tension": run["tension"] * 0.0 + 900.0, "area": run["area"] * 0.0}
    assert exact.off_law(run.assign(law), p) < 1e-13
    grown = run.assign(law).assign({"tension": law["tension"] + 1e-2 * run["time"]})
    # tension 0.1 higher at the end, with G = 1000
    assert exact.off_law(grown, p) == pytest.approx(1e-4)


def test_a_gap_is_the_ends_distance_over_the_length():
    run = straight()
    assert exact.gap(run) < 1e-14
    # tangents turned by a wave no longer close: the mean of exp(i e sin(angle)) around a circle
    bent = run.assign({"theta": run["theta"] + 1e-3 * np.sin(run["theta"])})
    assert exact.gap(bent) == pytest.approx(0.5e-3, rel=1e-3)


def test_the_exact_states_are_those_of_the_continuation_and_hold_together():
    glide = exact.GLIDES[16, 600, "printed"]
    p = cc.Parameters(r_on=16, zeta_1=600)
    area = glide.circularity * glide.length**2 / (4.0 * math.pi)
    assert p.sigma_bar + p.tension_rate * (area - math.pi) == pytest.approx(glide.tension, abs=0.01)


def test_a_glider_and_a_period_are_measured_on_runs():
    glide = exact.glide((16, 600, "printed"), 60.0)  # not relaxed yet: its shape takes 140
    assert glide.speed == pytest.approx(0.1863, rel=0.01)
    assert 0.70 < glide.circularity < 0.78
    # 8.79 once settled
    assert exact.tension_period((26, 600), 60.0) == pytest.approx(8.79, rel=0.02)


def test_the_worst_error_of_a_cell_is_told_in_units_of_the_tolerance():
    rows = [
        Row("(26, 600) printed, D = 0.05", 1e-4, 2.0, 1.0, 1.0, miss, 1e-4 * miss, 0.1, 96)
        for miss in (3.0, 12.0)
    ]
    length, centroid = _errors(rows)
    assert (length.met, centroid.met) == (True, False)
    assert centroid.measured.startswith("12 rtol")
