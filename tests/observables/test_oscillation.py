"""Period and amplitude of known waves."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import cellcrawl as cc
from tests.runs import straight
from tests.tracks import moved, sine_track


@given(
    period=st.floats(2.0, 20.0),
    phase=st.floats(0.0, 6.3),
    amplitude=st.floats(1e-6, 1e6),
    trend=st.floats(-1.0, 1.0),
)
def test_sine_has_its_period_and_amplitude(period, phase, amplitude, trend):
    t = np.linspace(0.0, 100.0, 2001)
    wave = amplitude * (np.sin(2.0 * np.pi * t / period + phase) + trend + 0.002 * trend * t)
    found = cc.observables.oscillation(t, wave)
    assert found.period == pytest.approx(period, rel=2e-2)
    assert found.amplitude == pytest.approx(amplitude, rel=5e-2)
    assert found.irregularity < 0.05 or math.isnan(found.irregularity)


def test_ripples_on_a_wave_do_not_count():
    t = np.linspace(0.0, 100.0, 5001)
    wave = np.sin(2.0 * np.pi * t / 10.0) + 0.2 * np.sin(2.0 * np.pi * t / 1.3)
    assert cc.observables.oscillation(t, wave).period == pytest.approx(10.0, rel=2e-2)


def test_transient_is_left_out():
    t = np.linspace(0.0, 100.0, 2001)
    wave = np.sin(2.0 * np.pi * t / 8.0) + 50.0 * np.exp(-t)
    found = cc.observables.oscillation(t, wave)
    assert found.period == pytest.approx(8.0, rel=1e-2)
    assert found.amplitude == pytest.approx(1.0, rel=2e-2)
    late = cc.observables.oscillation(t, wave, after=80.0)
    assert late.cycles == pytest.approx(20.0 / 8.0, rel=2e-2)


def test_nothing_that_swings_has_no_period():
    t = np.arange(100.0)
    for values in (0.0 * t + 3.0, 2.0 * t, t**2):
        assert math.isnan(cc.observables.oscillation(t, values).period)


def test_tension_of_a_run_is_measured():
    run = straight(records=401, step=0.1)
    run["tension"] = run["tension"] * 0.0 + 900.0 + 20.0 * np.sin(2.0 * np.pi * run["time"] / 5.0)
    found = cc.observables.tension_oscillation(run)
    assert found.period == pytest.approx(5.0, rel=1e-2)
    assert found.amplitude == pytest.approx(20.0, rel=1e-2)


@pytest.mark.parametrize("angle", [0.0, 2.0])
def test_lateral_swing_is_measured_across_the_way_ahead(angle):
    t, x, y = sine_track(period=18.0, swing=1.4)
    found = cc.observables.lateral_oscillation(*moved((t, x, y), angle, 3.0, 2.0, False))
    assert found.period == pytest.approx(36.0, rel=1e-2)
    assert found.amplitude == pytest.approx(
        3.0 * 0.2 * math.tan(0.7) * 18.0 / (2.0 * math.pi), rel=2e-2
    )


def test_lateral_swing_on_an_arc_is_measured_across_the_arc():
    t = np.linspace(0.0, 100.0, 2001)
    heading = 0.3 * np.sin(2.0 * np.pi * t / 10.0) + 0.02 * t
    step = 0.05
    found = cc.observables.lateral_oscillation(
        t, step * np.cumsum(np.cos(heading)), step * np.cumsum(np.sin(heading))
    )
    assert found.period == pytest.approx(10.0, rel=1e-2)
    # across = integral of sin(0.3 sin): about J1(0.3) * 2 / rate
    assert found.amplitude == pytest.approx(2.0 * 0.14832 * 10.0 / (2.0 * math.pi), rel=3e-2)


def test_mistakes_are_one_line():
    with pytest.raises(cc.InputError, match="at least 8 needed"):
        cc.observables.oscillation(np.arange(5.0), np.arange(5.0))
    with pytest.raises(cc.InputError, match="x has 4 values and t has 5"):
        cc.observables.oscillation(np.arange(5.0), np.arange(4.0))


@pytest.mark.slow
def test_zigzag_of_the_paper_has_its_periods_and_swing(zigzag_parameters):
    """MODEL.md, sections 6 and 7: tension every 8.9, left-right 18, swing about 1.1 R_0."""
    run = cc.simulate(zigzag_parameters, 100.0, start=cc.RandomPerturbation(seed=1), nodes=64)
    assert cc.observables.tension_oscillation(run).period == pytest.approx(8.9, abs=0.15)
    lateral = cc.observables.lateral_oscillation(run)
    assert lateral.period == pytest.approx(18.0, abs=0.5)
    assert 2.0 * lateral.amplitude == pytest.approx(1.1, abs=0.1)
