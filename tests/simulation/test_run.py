"""`simulate`: the Dataset it returns, its statuses, its refusals."""

from __future__ import annotations

import json
import math

import hypothesis
import numpy as np
import pytest
from hypothesis import event
from hypothesis import strategies as st

import cellcrawl as cc
from cellcrawl.data import STATUSES
from cellcrawl.parameters import DESCRIPTIONS
from cellcrawl.simulation.dataset import FIELDS, check_run
from cellcrawl.solvers import SOLVERS as SOLVER_TYPES
from tests.conftest import Given, check_start


def short(parameters: cc.Parameters | None = None, t_end: float = 0.3, **options):
    return cc.simulate(parameters, t_end, **{"solver": "paper", "nodes": 100, **options})


SOLVERS = pytest.mark.parametrize("solver", ["paper", "adaptive", "spline"])


def test_dataset_keeps_the_contract():
    dataset = check_run(short())
    assert set(dataset.data_vars) == set(FIELDS)
    assert all(dataset[name].attrs["units"] for name in (*FIELDS, "time"))
    assert dataset.attrs["status"] == "completed"
    assert dataset.attrs["end_time"] == 0.3
    assert dataset.attrs["seed"] == 1
    assert json.loads(dataset.attrs["parameters"]) == cc.Parameters().to_dict()
    assert json.loads(dataset.attrs["diagnostics"])["steps"] == 300


def test_edge_is_counter_clockwise_and_equally_spaced():
    dataset = short(nodes=400, t_end=3.0, save_every=1.0)
    x, y = dataset["x"].values, dataset["y"].values
    dx, dy = np.roll(x, -1, axis=1) - x, np.roll(y, -1, axis=1) - y
    spacing = np.hypot(dx, dy)
    assert np.all(np.sum(x * dy - y * dx, axis=1) > 0)
    arc = dataset["length"].values[:, None] / 400
    # A chord is shorter than its arc by (kappa ds)^2 / 24; the rest is the scheme's closure error.
    bend = (dataset["curvature"].values.max(axis=1, keepdims=True) * arc) ** 2 / 24
    assert np.all(np.abs(spacing / arc - 1.0) < 1.5 * bend + 1e-3)


@pytest.mark.parametrize(
    ("t_end", "save_every", "times"),
    [
        (0.3, 0.1, [0.0, 0.1, 0.2, 0.3]),
        (0.25, 0.1, [0.0, 0.1, 0.2, 0.25]),
        (0.1, 5.0, [0.0, 0.1]),
        (0.0, 0.1, [0.0]),
        (0.0035, 0.0007, [0.0, 0.0007, 0.0014, 0.0021, 0.0028, 0.0035]),
    ],
)
def test_records_are_multiples_of_save_every_and_the_end(t_end, save_every, times):
    assert np.allclose(short(t_end=t_end, save_every=save_every)["time"], times, atol=1e-12)


@SOLVERS
def test_saving_more_often_does_not_change_the_run(solver):
    seldom, often = (short(save_every=every, solver=solver) for every in (0.3, 0.015))
    for name in FIELDS:
        assert np.array_equal(seldom[name].values[-1], often[name].values[-1]) or name == "time"


def test_a_record_between_two_steps_lies_between_them():
    dataset = short(t_end=0.002, save_every=0.0005, dt=1e-3)
    length = dataset["length"].values
    assert math.isclose(length[1], 0.5 * (length[0] + length[2]), rel_tol=1e-12)


@SOLVERS
def test_same_seed_same_bits_and_another_seed_another_run(solver):
    first, again, other = (
        short(start=cc.RandomPerturbation(seed=s), solver=solver) for s in (5, 5, 6)
    )
    assert all(np.array_equal(first[name], again[name]) for name in FIELDS)
    assert not np.array_equal(first["x"], other["x"])


def test_jump_of_the_schedule_changes_nothing_before_it():
    jump = cc.Schedule({"r_on": [(0.1005, 25.0), (0.1005, 60.0)]})
    plain, changed = short(), short(schedule=jump)
    before = plain["time"] <= 0.1
    assert np.array_equal(plain["x"][before], changed["x"][before])


@SOLVERS
def test_jump_of_the_schedule_is_hit_between_steps(solver):
    jump = cc.Schedule({"r_on": [(0.1005, 25.0), (0.1005, 60.0)]})
    tight = {"solver": solver, **({"rtol": 1e-8} if solver == "adaptive" else {})}
    start = check_start(cc.Parameters())
    plain, changed = short(start=start, **tight), short(start=start, schedule=jump, **tight)
    assert not np.allclose(plain["bound_fraction"][-1], changed["bound_fraction"][-1])
    # From the jump on the cell is that of a new run with the new value, started from its state.
    nodes = SOLVER_TYPES[solver].start_nodes(100, **tight)
    first = short(t_end=0.1005, start=start, **{**tight, "nodes": nodes})
    state = cc.FromRun(first).state(cc.Parameters(), nodes)
    after = short(cc.Parameters(r_on=60), t_end=0.1995, start=Given(state), **tight)
    assert np.allclose(after["bound_fraction"][-1], changed["bound_fraction"][-1], atol=1e-6)


def test_ramp_is_what_a_jump_at_every_step_gives():
    ramp = cc.Schedule({"zeta_1": [(0.0, 600.0), (0.3, 300.0)]})
    stairs = [(0.001 * step, 600.0 - step) for step in range(301)]
    jumps = [pair for t, value in stairs for pair in ((t, value + 1.0), (t, value))]
    ramped = short(schedule=ramp)
    stepped = short(schedule=cc.Schedule({"zeta_1": jumps}))
    assert np.allclose(ramped["tension"], stepped["tension"], rtol=1e-9)
    assert abs(float(ramped["tension"][-1] / short()["tension"][-1]) - 1.0) > 1e-3


def test_last_state_of_a_run_starts_another(tmp_path):
    path = tmp_path / "first.nc"
    first = short(t_end=1.0, output=path)
    second = short(t_end=0.1, start=cc.FromRun(path))
    for name in ("bound_fraction", "tension", "length"):
        assert np.allclose(second[name][0], first[name][-1], atol=1e-12)
    # The scheme leaves a gap of about 1e-4 at the end of its curve; a start is closed.
    for name in ("x", "y"):
        assert np.allclose(second[name][0], first[name][-1], atol=5e-4)


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"t_end": math.nan}, "t_end"),
        ({"t_end": -1.0}, "t_end"),
        ({"t_end": "10"}, "t_end"),
        ({"save_every": 0.0}, "save_every"),
        ({"nodes": 3}, "nodes"),
        ({"nodes": 100.5}, "nodes"),
        ({"dt": math.inf}, "dt"),
        ({"dt": -1e-3}, "dt"),
        ({"dtt": 1e-3}, "did you mean 'dt'"),
        ({"start": 3}, "start"),
        ({"schedule": {"r_on": [(0, 1)]}}, "schedule"),
        ({"output": "run.txt"}, "must end in .nc"),
        ({"output": 7}, "output"),
    ],
)
def test_mistakes_are_one_line_that_names_them(options, says):
    with pytest.raises(cc.InputError) as caught:
        short(**{"t_end": 0.1, **options})
    assert says in str(caught.value)
    assert "\n" not in str(caught.value)


def test_unknown_solver_is_answered_with_the_nearest():
    with pytest.raises(cc.InputError, match="did you mean 'paper'"):
        cc.simulate(t_end=0.1, solver="papper")


def test_a_start_that_crosses_itself_is_refused():
    angle = 2.0 * math.pi * np.arange(200) / 200
    eight = np.column_stack([np.sin(angle), np.sin(2.0 * angle)])
    with pytest.raises(cc.InputError, match="crosses or touches itself"):
        cc.FromOutline(eight)


def test_a_start_outside_the_model_is_refused():
    # A deep narrow notch under high tension: 1 + kappa h < 0 somewhere.
    start = cc.PerturbedCircle(radius={12: (0.1, 0.0)})
    with pytest.raises(cc.InputError, match="no off-rate"):
        short(cc.Parameters(h=0.2), start=start, nodes=600)


def test_leaving_the_model_is_a_status_with_time_and_place():
    # Strong contraction of the cell under a tension that falls below -sigma_c.
    parameters = cc.Parameters(sigma_c=0.0, zeta_1=0.0, r_on=1.0)
    state = cc.PerturbedCircle().state(parameters, 100)
    low = cc.CellState(state.curve, state.bound_fraction, 0.5)
    schedule = cc.Schedule({"r_p": [(0.0, 50.0), (0.05, 50.0), (0.05, 2.0)]})
    dataset = short(parameters, 3.0, start=Given(low), schedule=schedule)
    if dataset.attrs["status"] != "completed":
        assert dataset.attrs["status"] == "out_of_range"
        assert "at t = " in dataset.attrs["status_message"]
    assert all(np.isfinite(dataset[name]).all() for name in FIELDS)


numbers = {
    name: st.floats(described.low, described.high) for name, described in DESCRIPTIONS.items()
}


@hypothesis.settings(max_examples=100)
@hypothesis.given(
    solver=st.sampled_from(["paper", "adaptive", "spline"]),
    values=st.fixed_dictionaries({}, optional=numbers),
    elasticity=st.sampled_from(["printed", "consistent"]),
    seed=st.integers(0, 1000),
    amplitude=st.sampled_from([1e-4, 1e-2]),
)
def test_any_parameters_end_in_a_named_status_without_nan(
    solver, values, elasticity, seed, amplitude
):
    parameters = cc.Parameters(**values, elasticity=elasticity)
    start = cc.RandomPerturbation(seed=seed, amplitude=amplitude, modes=5)
    try:
        dataset = short(parameters, 0.02, nodes=48, start=start, save_every=0.01, solver=solver)
    except cc.InputError as refusal:
        event(f"refused: {str(refusal)[:30]}")
        return
    event(str(dataset.attrs["status"]))
    assert dataset.attrs["status"] in STATUSES
    assert all(np.isfinite(dataset[name]).all() for name in FIELDS)
