"""Measures of a run's track, against tracks whose answers are known."""

from __future__ import annotations

import numpy as np
import pytest

from cellcrawl.simulation.track import Track
from cellcrawl.sweeps.measures import MEASURES, measured_columns
from cellcrawl.sweeps.periods import dominant_period

TIME = np.linspace(0.0, 100.0, 1001)


def track(time: np.ndarray = TIME, tension=900.0, **attributes) -> Track:
    """A unit circle that goes straight on at a speed of 0.2."""
    diagnostics = {"steps": 10, "wall_time": 0.5}
    said = {"status": "completed", "status_message": "reached", "end_time": time[-1]}
    return Track(
        time=time,
        centroid_x=0.12 * time + 7.0,
        centroid_y=0.16 * time,
        tension=np.broadcast_to(tension, time.shape),
        length=np.full(time.size, 2.0 * np.pi),
        area=np.full(time.size, np.pi),
        attributes={**said, "diagnostics": diagnostics, **attributes},
    )


def test_a_circle_that_goes_straight_on():
    row = measured_columns(track())
    assert row["mode"] == "gliding"
    assert row["speed"] == pytest.approx(0.2)
    assert row["x_c"] == pytest.approx(0.2 * (5.0 + 100.0) / 2.0)
    assert row["circularity"] == pytest.approx(1.0)
    assert (row["area"], row["length"]) == pytest.approx((np.pi, 2.0 * np.pi))
    assert row["tension"] == row["tension_low"] == row["tension_high"] == 900.0
    assert row["tension_period"] is None


def test_the_swing_of_the_tension_is_that_of_the_second_half():
    swing = np.where(TIME < 50.0, 300.0, 20.0)
    row = measured_columns(track(tension=900.0 + swing * np.sin(2.0 * np.pi * TIME / 8.0)))
    assert row["tension_low"] == pytest.approx(880.0, abs=0.2)
    assert row["tension_high"] == pytest.approx(920.0, abs=0.2)
    assert row["tension_period"] == pytest.approx(8.0, rel=2e-3)


def test_a_run_too_short_has_none_and_no_nan():
    row = measured_columns(track(TIME[:3]))
    assert all(row[name] is None for name in ("mode", "speed", "tension", "x_c"))
    assert set(MEASURES) < set(row)
    assert not any(isinstance(value, float) and np.isnan(value) for value in row.values())


def test_a_torn_cell_keeps_the_measures_of_the_time_before():
    row = measured_columns(track(TIME[:200], status="fragmented"))
    assert (row["mode"], row["confidence"]) == ("fragmented", 1.0)
    assert row["speed"] == pytest.approx(0.2)


@pytest.mark.parametrize("period", [1.3, 4.0, 13.3])
@pytest.mark.parametrize("shape", ["sine", "saw", "two bumps"])
def test_the_period_is_that_of_the_whole_pattern(period, shape):
    phase = TIME[500:] / period
    signal = {
        "sine": np.sin(2.0 * np.pi * phase),
        "saw": phase % 1.0,
        "two bumps": np.sin(2.0 * np.pi * phase) + np.sin(4.0 * np.pi * phase),
    }[shape]
    assert dominant_period(TIME[500:], 900.0 + 10.0 * signal) == pytest.approx(period, rel=0.02)


def test_what_does_not_repeat_has_no_period():
    rng = np.random.default_rng(1)
    late = TIME[500:]
    assert dominant_period(late, 900.0 + late) is None
    assert dominant_period(late, np.full(late.size, 900.0)) is None
    assert dominant_period(late, 900.0 + 10.0 * rng.standard_normal(late.size)) is None
    assert dominant_period(late, 900.0 + 10.0 * np.exp(-(late - 50.0))) is None
    assert dominant_period(late[:10], np.sin(late[:10])) is None
