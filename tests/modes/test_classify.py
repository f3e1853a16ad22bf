"""The classifier names the form of a track, and nothing else about it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import cellcrawl as cc
from cellcrawl.modes.synthetic import RECIPES, synthetic_tracks
from tests.runs import circle_on_track, circling, straight
from tests.tracks import circle_track, moved, sine_track, straight_track

TRACKS = {
    "gliding": straight_track(),
    "rotational": circle_track(),
    "zigzag": sine_track(),
    "other": sine_track(swing=0.0)[:1]
    + tuple(np.random.default_rng(1).normal(size=(2, 1001)).cumsum(axis=1)),
}
SCALES = st.floats(1e-6, 1e6)


@pytest.mark.parametrize("mode", list(TRACKS))
@settings(max_examples=40)
@given(angle=st.floats(-math.pi, math.pi), length=SCALES, time=SCALES, mirror=st.booleans())
def test_mode_does_not_depend_on_units_place_orientation_or_side(mode, angle, length, time, mirror):
    plain = cc.classify_track(*TRACKS[mode])
    found = cc.classify_track(*moved(TRACKS[mode], angle, length, time, mirror))
    assert found.mode == plain.mode == mode
    assert found.confidence == pytest.approx(plain.confidence, abs=0.02)
    assert found.measures.speed * time / length == pytest.approx(plain.measures.speed, rel=1e-3)
    sense = -1.0 if mirror else 1.0
    if mode == "rotational":
        assert found.measures.turned == pytest.approx(sense * plain.measures.turned, rel=1e-6)


@pytest.mark.parametrize(("kind", "mode"), [(kind, mode) for kind, (mode, _) in RECIPES.items()])
def test_synthetic_tracks_are_named_right(kind, mode):
    results = [
        cc.classify_track(track.t, track.x, track.y) for track in synthetic_tracks(25, 5, (kind,))
    ]
    wrong = [result for result in results if result.mode != mode]
    assert len(wrong) <= 2
    assert all(result.confidence < 0.9 for result in wrong)


@pytest.mark.slow
def test_98_of_100_synthetic_tracks_are_right_and_no_mistake_is_sure():
    wrong = []
    tracks = list(synthetic_tracks(6000, 11))
    for track in tracks:
        result = cc.classify_track(track.t, track.x, track.y)
        if result.mode != track.mode:
            wrong.append(result.confidence)
    assert len(wrong) <= 0.02 * len(tracks)
    assert max(wrong, default=0.0) < 0.9


def test_turned_angle_period_and_swing_are_those_of_the_track():
    rotating = cc.classify_track(*circle_track(rate=-0.2))
    assert rotating.measures.turned == pytest.approx(-20.0, rel=1e-2)
    assert rotating.measures.period == pytest.approx(2.0 * math.pi / 0.2, rel=1e-3)
    assert rotating.measures.circling_radius == pytest.approx(2.0, rel=1e-3)
    zigzag = cc.classify_track(*sine_track(period=18.0, swing=1.4))
    assert zigzag.measures.period == pytest.approx(18.0, rel=1e-3)
    assert zigzag.measures.swing == pytest.approx(1.4, rel=1e-2)


def test_one_way_turns_with_straight_legs_between_are_rotation():
    t = np.linspace(0.0, 100.0, 1001)
    heading = (
        0.5
        * math.radians(72.0)
        * np.tanh((t[:, None] - np.arange(7.0, 100.0, 13.0)) / 0.8).sum(axis=1)
    )
    x, y = np.cumsum(np.cos(heading)), np.cumsum(np.sin(heading))
    assert cc.classify_track(t, x, y).mode == "rotational"


def test_a_zigzag_may_go_along_a_wide_arc():
    t = np.linspace(0.0, 100.0, 1001)
    heading = 1.0 * np.sin(0.6 * t) + math.pi * t / 100.0
    found = cc.classify_track(t, np.cumsum(np.cos(heading)), np.cumsum(np.sin(heading)))
    assert found.mode == "zigzag"


def test_swings_by_more_than_half_a_turn_are_no_zigzag():
    t = np.linspace(0.0, 100.0, 1001)
    for swing, mode in ((2.6, "zigzag"), (4.2, "other")):
        heading = 0.5 * swing * np.sin(0.6 * t)
        found = cc.classify_track(t, np.cumsum(np.cos(heading)), np.cumsum(np.sin(heading)))
        assert found.mode == mode


def test_a_first_turn_to_the_other_side_belongs_to_the_transient():
    t = np.linspace(0.0, 100.0, 1001)
    heading = np.where(t < 12.0, 0.3 * (12.0 - t), 0.3 * (t - 12.0))
    found = cc.classify_track(t, np.cumsum(np.cos(heading)), np.cumsum(np.sin(heading)))
    assert found.mode == "rotational"
    assert 10.0 < found.measures.start < 40.0


def test_one_turn_is_too_little_to_tell():
    t = np.linspace(0.0, 100.0, 1001)
    heading = np.where(t < 60.0, 0.0, 1.0)
    found = cc.classify_track(t, np.cumsum(np.cos(heading)), np.cumsum(np.sin(heading)))
    assert found.mode == "other"
    assert found.confidence < 0.6  # its cell may turn back, on, or anywhere
    assert "too few" in found.doubt


def test_noise_at_rest_is_stationary_and_so_is_a_cell_that_stopped():
    random = np.random.default_rng(2)
    t = np.arange(300.0)
    assert cc.classify_track(t, *random.normal(size=(2, 300))).mode == "stationary"
    assert cc.classify_track(t, 1.0 - np.exp(-t / 5.0), 0.0 * t).mode == "stationary"
    assert cc.classify_track(t, 0.0 * t + 3.0, 0.0 * t).mode == "stationary"
    creeping = cc.classify_track(t, 1e-6 * t, 0.0 * t)
    assert creeping.mode == "gliding"
    assert cc.classify_track(t, 1e-6 * t, 0.0 * t, cell_radius=1.0).mode == "stationary"


@pytest.mark.parametrize("mode", ["gliding", "rotational", "zigzag"])
@pytest.mark.parametrize("noise", [0.01, 0.05])
def test_noise_of_a_microscope_does_not_change_the_mode(mode, noise):
    t, x, y = TRACKS[mode]
    random = np.random.default_rng(3)
    found = cc.classify_track(
        t, x + noise * random.normal(size=t.size), y + noise * random.normal(size=t.size)
    )
    assert found.mode == mode
    assert found.measures.noise == pytest.approx(noise, rel=0.15)


def test_a_cell_that_spins_within_its_outline_does_not_rotate():
    t, x, y = circle_track(rate=0.5, radius=0.4)
    assert cc.classify_track(t, x, y).mode == "rotational"
    assert cc.classify_track(t, x, y, cell_radius=0.2).mode == "rotational"
    spinning = cc.classify_track(t, x, y, cell_radius=1.0)
    assert spinning.mode == "other"
    assert "spins within its own outline" in spinning.doubt


def test_a_run_is_named_as_its_track_with_its_size():
    wide, narrow = circling(0.4, radius=3.0), circling(0.4, radius=0.4)
    for run, mode in ((wide, "rotational"), (narrow, "other"), (straight(records=60), "gliding")):
        track = [run[name].values for name in ("time", "centroid_x", "centroid_y")]
        assert cc.classify(run) == cc.classify_track(*track, cell_radius=1.0)
        assert cc.classify(run).mode == mode
        assert cc.classify(run, use_size=False) == cc.classify_track(*track)


def test_a_torn_cell_is_fragmented_however_short_its_run():
    torn = straight(records=3).assign_attrs(status="fragmented")
    assert cc.classify(torn).mode == "fragmented"
    assert cc.classify_track([0.0], [0.0], [0.0], status="fragmented").mode == "fragmented"


def test_summary_says_what_was_seen():
    assert cc.classify_track(*circle_track()).summary() == "turns left only, once round in 31.4"
    assert cc.classify_track(*sine_track()).summary().endswith("left and right in 18")
    row = cc.classify_track(*straight_track()).as_row()
    assert row["mode"] == "gliding"
    assert row["turned"] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("track", "said"),
    [
        (([0.0, 1.0], [0.0, 1.0], [0.0, 1.0]), "2 records in time: at least 12 needed"),
        ((np.arange(20.0), np.zeros(19), np.zeros(20)), "x has 19 values and t has 20"),
        ((np.arange(20.0), np.full(20, np.nan), np.zeros(20)), r"x is not finite at index \(0,\)"),
        ((np.arange(20.0)[::-1], np.zeros(20), np.zeros(20)), "t must rise: t"),
        ((np.zeros(20), np.zeros(20), np.zeros(20)), "repeated times"),
        ((["a"] * 20, np.zeros(20), np.zeros(20)), "t must be an array of numbers"),
        ((np.arange(20.0), None, None), "a track needs times, x and y"),
        ((np.zeros((4, 5)), np.zeros(20), np.zeros(20)), "t has shape"),
    ],
)
def test_a_bad_track_is_refused_in_one_line(track, said):
    with pytest.raises(cc.InputError, match=said) as error:
        cc.classify_track(*track)
    assert "\n" not in str(error.value)


def test_a_bad_radius_or_run_is_refused_in_one_line():
    with pytest.raises(cc.InputError, match="cell_radius = 0"):
        cc.classify_track(*straight_track(), cell_radius=0)
    with pytest.raises(cc.InputError, match="dataset must be xarray's Dataset, not 3"):
        cc.classify(3)
    with pytest.raises(cc.InputError, match="5 records in time: at least 12 records needed"):
        cc.classify(straight(records=5))


@given(
    records=st.integers(12, 40),
    seed=st.integers(0, 2**32 - 1),
    scale=SCALES,
    steps=st.sampled_from([0.0, 1.0]),
)
def test_any_track_gets_a_mode_and_a_confidence(records, seed, scale, steps):
    random = np.random.default_rng(seed)
    t = np.cumsum(random.exponential(size=records) + 1e-3)
    path = random.normal(size=(2, records)) * random.choice([0.0, 1.0], size=(1, records))
    places = scale * (path.cumsum(axis=1) if steps else path)
    found = cc.classify_track(t, *places)
    assert found.mode in cc.modes.MODES
    assert 0.0 <= found.confidence <= 1.0


def test_a_cell_at_rest_in_a_dataset_is_stationary():
    run = circle_on_track(0.5 * np.arange(50), lambda t: ((1e-5 * t, 0.0), (1e-5, 0.0)))
    assert cc.classify(run).mode == "stationary"


def test_a_cell_that_turns_on_the_spot_is_other_with_the_detail_of_a_steady_spin():
    on_the_spot = circling(0.5, radius=0.4, records=1001)
    found = cc.classify(on_the_spot)
    assert (found.mode, found.detail) == ("other", "steady spin")
    assert "spins to the left on the spot, once round in 12.6" in found.summary()
    assert found.as_row()["detail"] == "steady spin"
    round_a_circle = cc.classify(circling(0.5, radius=3.0, records=1001))
    assert (round_a_circle.mode, round_a_circle.detail) == ("rotational", "")
    assert cc.classify(on_the_spot, use_size=False).mode == "rotational"


def test_a_spin_that_begins_after_turns_to_the_other_side_is_seen():
    """As at (44, 560): the cell wanders before it settles into its spin."""
    t = 0.1 * np.arange(1001)
    heading = np.where(t < 12.0, 0.5 * t, 6.0 - 0.5 * (t - 12.0))
    track = (t, *(0.02 * np.cumsum(f(heading)) for f in (np.cos, np.sin)))
    found = cc.classify_track(*track, cell_radius=1.0)
    assert (found.mode, found.detail) == ("other", "steady spin")
    assert found.measures.turning_rate == pytest.approx(-0.5, rel=0.05)


@pytest.mark.parametrize("status", ["out_of_range", "unresolved", "not_finite", "step_too_small"])
def test_a_run_that_a_failure_ended_says_so_and_is_not_sure(status):
    run = straight(records=90, step=1.0)
    assert cc.classify(run).confidence > 0.99
    found = cc.classify(run.assign_attrs(status=status))
    assert found.mode == "gliding"
    assert found.confidence <= 0.5
    assert f"the run ended {status} at t = 89" in found.summary()
    track = (run[name].values for name in ("time", "centroid_x", "centroid_y"))
    assert cc.classify_track(*track, status=status).confidence <= 0.5


@pytest.mark.slow
@pytest.mark.parametrize(
    ("point", "mode"),
    [
        ((16, 600), "gliding"),
        ((56, 560), "gliding"),
        ((24, 540), "rotational"),
        ((26, 600), "zigzag"),
        ((36, 560), "zigzag"),
        ((38, 580), "other"),
        ((40, 540), "other"),
        ((40, 600), "other"),
        ((44, 560), "other"),
    ],
)
def test_named_points_have_the_modes_of_the_paper(point, mode):
    """MODEL.md, section 6."""
    cell = cc.Parameters(r_on=point[0], zeta_1=point[1])
    runs = [
        cc.simulate(cell, 100.0, start=cc.RandomPerturbation(seed=seed), nodes=64)
        for seed in range(1, 6)
    ]
    assert cc.modes.combine(map(cc.classify, runs)).majority == mode
    early = [cc.classify(run.sel(time=slice(0.0, 50.0))) for run in runs]
    assert cc.modes.combine(early).majority == mode


def test_a_short_run_that_has_not_turned_yet_is_not_sure_to_glide():
    run = cc.simulate(cc.Parameters(r_on=26, zeta_1=600), 60.0, start=cc.RandomPerturbation(seed=1))
    assert cc.classify(run).mode == "zigzag"
    early = cc.classify(run.sel(time=slice(0.0, 8.0)))
    assert early.mode == "gliding"
    assert early.confidence <= 0.5
    assert early.doubt.startswith("it ends at t = 8, and turns may begin up to t = 50")
    si = cc.classify(cc.Scales().dataset(run.sel(time=slice(0.0, 8.0))))
    assert si.confidence <= 0.5
    assert si.doubt.startswith("it ends at t = 80, and turns may begin up to t = 500")
