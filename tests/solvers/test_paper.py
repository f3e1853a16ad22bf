"""The paper's scheme: its orders, its invariants, its symmetries, its targets."""

from __future__ import annotations

import math

import numpy as np
import pytest
import xarray as xr

import cellcrawl as cc
from cellcrawl.verification import agreement, invariants, orders
from cellcrawl.verification.agreement import CONVERGED, disagreement, summary
from tests.conftest import Given, check_start, reflected, rotated, shifted


def last(parameters: cc.Parameters, nodes: int, dt: float, t_end: float = 2.0) -> xr.Dataset:
    return agreement.last(parameters, t_end, "paper", nodes=nodes, dt=dt)


@pytest.mark.parametrize(
    ("nodes", "dt", "within"),
    [(2000, 1e-3, 3e-3), pytest.param(4000, 1e-4, 3e-4, marks=pytest.mark.slow)],
)
def test_check_start_agrees_with_the_converged_values(zigzag_parameters, nodes, dt, within):
    found = summary(last(zigzag_parameters, nodes, dt))
    assert disagreement(found, CONVERGED) < within


def test_first_order_in_time(zigzag_parameters):
    steps = [{"nodes": 400, "dt": dt} for dt in orders.STEPS]
    order = orders.ratio_orders(zigzag_parameters, 2.0, "paper", steps)
    # The y of the centroid changes too little with the step to show an order.
    assert np.all(np.abs(order[:4] - 1.0) < 0.1)


def test_second_order_in_space(zigzag_parameters):
    grids = [{"nodes": nodes, "dt": 5e-4} for nodes in orders.NODES]
    order = orders.ratio_orders(zigzag_parameters, 2.0, "paper", grids)
    assert np.all(np.abs(order - 2.0) < 0.1)


def test_extrapolation_in_time_and_space_reaches_the_converged_values(zigzag_parameters):
    first, second, third = (summary(last(zigzag_parameters, 1000, dt)) for dt in (8e-4, 4e-4, 2e-4))
    in_time = (first - 6.0 * second + 8.0 * third) / 3.0
    coarse, fine = (summary(last(zigzag_parameters, n, 4e-4)) for n in (500, 1000))
    extrapolated = in_time + (fine - coarse) / 3.0
    assert np.all(np.abs(extrapolated / CONVERGED - 1.0)[:3] < 3e-6)
    assert np.all(np.abs(extrapolated - CONVERGED)[3:] < 5e-6)


@pytest.mark.parametrize("elasticity", ["printed", "consistent"])
def test_uniform_circle_stays_uniform(elasticity):
    parameters = cc.Parameters(elasticity=elasticity)
    dataset = cc.simulate(parameters, 0.5, start=cc.PerturbedCircle(), solver="paper", nodes=200)
    assert np.ptp(dataset["bound_fraction"].values) < 1e-9
    assert np.abs(dataset["off_rate"].values - parameters.r_p).max() < 1e-6
    assert np.abs(dataset["tension"].values / parameters.sigma_bar - 1.0).max() < 1e-9


def test_tension_keeps_step_with_area(zigzag_parameters):
    dataset = cc.simulate(zigzag_parameters, 5.0, solver="paper", nodes=400)
    drift = zigzag_parameters.tension_rate * invariants.area_drift(dataset, zigzag_parameters)
    assert drift < 1e-9


def test_forces_balance_at_every_node(zigzag_parameters):
    ds = cc.simulate(zigzag_parameters, 5.0, solver="paper", nodes=400)
    p = zigzag_parameters
    r, n = ds["off_rate"].values, ds["bound_fraction"].values
    assert invariants.force_residual(ds, p) < 1e-10
    friction = (r + p.zeta_1 * n) * np.log(r)
    assert np.abs(ds["friction"].values - friction).max() < 1e-10
    speed = p.epsilon * (p.v_p - r * np.log(r))
    assert np.abs(ds["normal_velocity"].values - speed).max() < 1e-12
    assert r.min() >= 1.0


def test_bound_fraction_stays_a_fraction():
    for r_on, zeta_1 in [(16, 600), (200, 2000), (1, 0)]:
        dataset = cc.simulate(
            cc.Parameters(r_on=r_on, zeta_1=zeta_1), 3.0, solver="paper", nodes=200
        )
        assert invariants.outside_fraction(dataset) == 0.0


@pytest.mark.parametrize("angle", [0.7, math.pi / 2, 4.0])
def test_a_turned_start_gives_the_turned_run(zigzag_parameters, angle):
    state = check_start(zigzag_parameters).state(zigzag_parameters, 300)
    plain, turned = (run(zigzag_parameters, s) for s in (state, rotated(state, angle)))
    c, s = math.cos(angle), math.sin(angle)
    assert np.allclose(turned["x"], c * plain["x"] - s * plain["y"], atol=1e-9)
    assert np.allclose(turned["y"], s * plain["x"] + c * plain["y"], atol=1e-9)
    assert np.allclose(turned["bound_fraction"], plain["bound_fraction"], atol=1e-9)


def test_a_mirrored_start_gives_the_mirrored_run(zigzag_parameters):
    state = check_start(zigzag_parameters).state(zigzag_parameters, 300)
    plain, mirrored = (run(zigzag_parameters, s) for s in (state, reflected(state)))
    back = np.roll(np.arange(300)[::-1], 1)
    assert np.allclose(mirrored["x"].values, plain["x"].values[back], atol=1e-9)
    assert np.allclose(mirrored["y"].values, -plain["y"].values[back], atol=1e-9)
    assert np.allclose(mirrored["tension"], plain["tension"], atol=1e-6)


def test_the_choice_of_node_0_changes_the_run_only_within_the_scheme_error(zigzag_parameters):
    # Node 0 moves along its normal and carries the others, so a shift is an error of the scheme.
    differences = []
    for nodes in (200, 400):
        state = check_start(zigzag_parameters).state(zigzag_parameters, nodes)
        plain, moved = (run(zigzag_parameters, s) for s in (state, shifted(state, nodes // 3)))
        gap = np.hypot(
            plain["centroid_x"] - moved["centroid_x"], plain["centroid_y"] - moved["centroid_y"]
        )
        differences.append(float(gap) + abs(float(plain["length"] - moved["length"])))
    assert differences[1] < 1e-3
    assert differences[1] < differences[0]


def test_consistent_law_refuses_the_published_step_and_names_one_that_works():
    parameters = cc.Parameters(r_on=26, elasticity="consistent")
    with pytest.raises(cc.InputError, match=r"dt = 0.001 is unstable.*tension.*works") as caught:
        cc.simulate(parameters, 1.0, solver="paper", nodes=200, dt=1e-3)
    advised = float(str(caught.value).split("dt = ")[-1].split()[0])
    dataset = cc.simulate(parameters, 3.0, solver="paper", nodes=200, dt=advised)
    assert dataset.attrs["status"] == "completed"
    # The stiff tension mode decays instead of chattering: the tension is smooth from save to save.
    assert np.abs(np.diff(dataset["tension"].values, 2)).max() < 10.0


def test_too_long_a_step_for_the_nodes_is_refused(zigzag_parameters):
    with pytest.raises(cc.InputError, match=r"unstable.*shape on 8000 nodes.*works"):
        cc.simulate(zigzag_parameters, 1.0, solver="paper", nodes=8000, dt=1e-3)


def run(parameters: cc.Parameters, state: cc.CellState) -> xr.Dataset:
    nodes = state.curve.nodes
    return cc.simulate(
        parameters, 1.0, start=Given(state), solver="paper", nodes=nodes, dt=5e-4
    ).isel(time=-1)
