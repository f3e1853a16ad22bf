"""Answers with confidence p are right in p of the cases, and say why they are not sure."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.bench import confidence
from cellcrawl.modes.mixture import mixture

RESULTS = Path(__file__).resolve().parents[2] / "benchmarks" / "results"


def answers(count: int, seed: int, **lengths: int) -> tuple[np.ndarray, np.ndarray]:
    rows = []
    for track in mixture(count, seed, **lengths):
        found = cc.classify_track(track.t, track.x, track.y)
        rows.append((found.confidence, found.mode == track.mode))
    said, right = np.array(rows, dtype=float).T
    return said, right


@pytest.mark.parametrize(("fewest", "most"), [(12, 40), (41, 300)])
def test_as_many_answers_are_right_as_their_confidence_says(fewest, most):
    said, right = answers(300, 99, fewest=fewest, most=most)
    assert abs(right.mean() - said.mean()) < 0.05
    sure = said >= 0.9
    assert right[sure].mean() > 0.93
    assert right[~sure].mean() < 0.8


@pytest.mark.slow
def test_confidence_holds_bin_by_bin():
    from cellcrawl.bench.confidence import WITHIN, largest_gap, measure

    together, apart = measure()
    assert largest_gap(together) < WITHIN
    # of forty intervals of 95 percent two miss by chance
    assert sum(not row.agrees for row in apart) <= 2


def test_the_recorded_calibration_holds_to_five_hundredths():
    recorded = json.loads((RESULTS / "confidence.json").read_text("utf-8"))["confidence"]
    rows = [confidence.Reliability(**row) for row in recorded]
    together = [row for row in rows if row.records == "all"]
    assert sum(row.answers for row in together) >= 40_000
    assert all(row.can_be_told for row in together)
    assert confidence.largest_gap(together) < confidence.WITHIN
    assert sum(not row.agrees for row in rows) <= 2


def brownian(records: int, count: int = 60):
    for seed in range(count):
        steps = np.random.default_rng(seed).normal(size=(2, records))
        yield cc.classify_track(np.arange(records), *steps.cumsum(axis=1))


@pytest.mark.parametrize("records", [12, 16, 40])
def test_brownian_motion_is_seldom_named_a_mode_and_never_surely(records):
    found = list(brownian(records))
    named = [one for one in found if one.mode in ("gliding", "rotational", "zigzag")]
    assert len(named) <= 6
    assert sum(one.confidence >= 0.8 for one in named) <= 1
    assert sum(one.mode == "stationary" for one in found) <= 4
    assert all(one.confidence < 0.7 for one in found if one.mode == "stationary")


def test_three_records_a_period_are_too_few_and_said_to_be():
    t = np.arange(90.0)
    x, y = 2.0 * t, 1.5 * np.sin(2.0 * np.pi * t / 3.0 + 0.4)
    found = cc.classify_track(t, x, y)
    assert found.mode == "zigzag" or found.confidence < 0.6
    assert found.doubt


def test_noise_and_shortness_lower_the_confidence():
    random = np.random.default_rng(5)
    t = np.arange(400.0)
    x, y = 10.0 * np.sin(0.1 * t), 10.0 * np.cos(0.1 * t)
    noise = random.normal(size=(2, 400))
    clear = cc.classify_track(t, x + 0.05 * noise[0], y + 0.05 * noise[1])
    short = cc.classify_track(t[:14], x[:14] + 0.5 * noise[0, :14], y[:14] + 0.5 * noise[1, :14])
    assert clear.mode == "rotational"
    assert clear.confidence > 0.95
    assert short.confidence < clear.confidence
    assert short.doubt
