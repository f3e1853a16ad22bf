import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import cellcrawl as cc
from cellcrawl.parameters import Conditions

P = cc.Parameters()


def test_value_is_held_outside_and_linear_between():
    ramp = cc.Schedule({"r_on": [(25.0, 16.0), (35.0, 30.0)]})
    assert [ramp.at(P, t).r_on for t in (-math.inf, 0, 25, 30, 35, 1e9)] == [16, 16, 16, 23, 30, 30]


def test_repeated_time_is_a_jump():
    jump = cc.Schedule({"zeta_1": [(10, 500), (10, 600)]})
    assert [jump.at(P, t).zeta_1 for t in (9.999, 10, 10.001)] == [500, 600, 600]
    assert [jump.before(P, t).zeta_1 for t in (9.999, 10, 10.001)] == [500, 500, 600]


def test_ramp_may_begin_and_end_with_a_jump():
    both = cc.Schedule({"r_on": [(0, 10), (0, 20), (4, 40), (4, 50)]})
    assert [both.before(P, t).r_on for t in (0, 2, 4, 5)] == [10, 30, 40, 50]
    assert [both.at(P, t).r_on for t in (0, 2, 4, 5)] == [20, 30, 50, 50]


def test_single_point_is_a_constant():
    assert cc.Schedule({"D": [(3, 0.1)]}).at(P, 0.0).D == 0.1


def test_other_parameters_stay():
    assert cc.Schedule({"r_on": [(0, 30)]}).at(P, 1.0) == P.replace(r_on=30)


def test_empty_schedule_is_no_schedule():
    assert cc.Schedule({}).at(P, 3.0) is P
    assert cc.Schedule({}).next_break(0.0) == math.inf


def test_breaks_are_all_times_once_in_order():
    both = cc.Schedule({"r_on": [(5, 20), (9, 30)], "D": [(1, 0.1), (5, 0.2), (5, 0.3)]})
    assert both.breaks == (1, 5, 9)
    assert [both.next_break(t) for t in (-1, 1, 4, 5, 9)] == [1, 5, 5, 9, math.inf]


def test_varies_only_where_a_value_ramps():
    s = cc.Schedule({"r_on": [(1, 20), (2, 20), (2, 25), (4, 30)]})
    assert [s.varies(a, a + 0.5) for a in (0, 1, 2, 3.6, 4)] == [False, False, True, True, False]


times = st.lists(st.floats(-1e3, 1e3), min_size=1, max_size=6).map(sorted)


@st.composite
def schedules(draw):
    limits = {"r_on": (1, 200), "h": (0, 0.2), "epsilon": (1e-5, 0.1)}
    changes = {}
    for name in draw(st.sets(st.sampled_from(sorted(limits)))):
        at = sorted(set(draw(times)))
        at = sorted(at + at[: draw(st.integers(0, len(at)))])  # some are jumps
        values = st.one_of(st.floats(*limits[name]), st.sampled_from(limits[name]))
        changes[name] = [(t, draw(values)) for t in at]
    return cc.Schedule(changes)


@given(schedules(), st.floats(0, 1), st.integers(0, 10))
def test_values_never_leave_the_range_of_their_neighbours(schedule, part, which):
    # linear interpolation in floating point can overshoot its ends by a rounding
    for name, points in schedule.to_dict().items():
        pairs = list(pairwise(points)) or [(points[0], points[0])]
        (t0, v0), (t1, v1) = pairs[which % len(pairs)]
        for t in (t0 + part * (t1 - t0), t0, t1):
            value = getattr(schedule.before(P, t), name)
            assert min(p[1] for p in points) <= value <= max(p[1] for p in points)
        if t0 < t1:
            assert getattr(schedule.before(P, t1), name) == v1
            assert getattr(schedule.at(P, t0), name) == v0


@given(schedules())
def test_round_trip_by_plain_lists_is_exact(schedule):
    assert cc.Schedule(schedule.to_dict()) == schedule
    assert hash(cc.Schedule(schedule.to_dict())) == hash(schedule)


@given(schedules(), st.floats(-1e3, 1e3))
def test_before_and_at_agree_except_at_breaks(schedule, time):
    if time not in schedule.breaks:
        assert schedule.at(P, time) == schedule.before(P, time)


def test_changing_the_list_given_changes_nothing():
    points = [(0.0, 20.0), (1.0, 30.0)]
    schedule = cc.Schedule({"r_on": points})
    points[0] = (0.0, 99.0)
    assert schedule.at(P, 0.0).r_on == 20.0


def test_numpy_points_are_taken():
    assert cc.Schedule({"r_on": np.array([[0, 20], [2, 30]])}).at(P, 1).r_on == 25.0


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"ron": [(0, 1)]}, "did you mean 'r_on'"),
        ({"elasticity": [(0, "printed")]}, "has no 'elasticity'"),
        ({"r_on": []}, "empty"),
        ({"r_on": 5}, "list of \\(time, value\\) pairs"),
        ({"r_on": "12"}, "list of \\(time, value\\) pairs"),
        ({"r_on": {0: 1}}, "list of \\(time, value\\) pairs"),
        ({"r_on": {(0, 25): 1}}, "list of \\(time, value\\) pairs"),
        ({"r_on": ["ab"]}, "wrong type"),
        ({"r_on": [(0, 1, 2)]}, "list of \\(time, value\\) pairs"),
        ({"r_on": [(0, 0.5)]}, "at t = 0 = 0.5 is out of range"),
        ({"r_on": [(math.nan, 5)]}, "time = nan"),
        ({"r_on": [(math.inf, 5)]}, "time = inf"),
        pytest.param({"r_on": [(10**5000, 5)]}, "too large", id="digits"),
        ({"r_on": [(0, math.nan)]}, "= nan is out of range"),
        ({"r_on": [(1, 5), (0, 5)]}, "out of order: 0 after 1"),
        ({"r_on": [(1, 5), (1, 6), (1, 7)]}, "three times"),
        ([("r_on", [(0, 1)])], "must be a table"),
        (None, "must be a table"),
    ],
)
def test_wrong_schedules_are_one_line(changes, says):
    with pytest.raises(cc.InputError, match=says) as caught:
        cc.Schedule(changes)
    assert len(str(caught.value).splitlines()) == 1


def test_long_schedule_is_checked_quickly():
    many = [(float(i), 20.0 + i % 2) for i in range(50_000)]
    assert len(cc.Schedule({"r_on": many}).breaks) == 50_000


def test_edge_rows_before_a_jump_are_the_old_ones():
    conditions = Conditions(P, cc.Schedule({"r_on": [(1, 20), (1, 30)]}))
    assert np.all(conditions.edge(1.0, 5, before=True)[0] == 20)
    assert np.all(conditions.edge(1.0, 5)[0] == 30)
    assert conditions.edge(1.0, 5).shape == (8, 5)


def test_extremes_hold_both_sides_of_every_jump():
    conditions = Conditions(P, cc.Schedule({"r_on": [(1, 20), (1, 30), (2, 40)]}))
    assert {p.r_on for p in conditions.extremes()} == {20, 30, 40}
