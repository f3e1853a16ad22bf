"""Crawling states, regimes, bistability and phase diagrams of two edges."""

from __future__ import annotations

import math

import numpy as np
import pytest
import xarray as xr

import cellcrawl as cc
from cellcrawl.one_dimensional import theory

od = cc.one_dimensional
P = cc.Parameters(r_on=25, zeta_1=600)
CONSISTENT = P.replace(elasticity="consistent")
BODY = od.Anchoring(stiffness=6280.0, relaxation=1.0)


def steady_force(p, r):
    return math.log(r) * (r + p.zeta_1 * p.r_on / (p.r_on + r))


@pytest.mark.parametrize("anchoring", [od.Anchoring(), od.Anchoring(stiffness=600, relaxation=10)])
@pytest.mark.parametrize(("r_on", "zeta_1"), [(25, 600), (10, 600), (60, 620), (40, 900)])
def test_crawling_states_solve_the_equations_of_a_steadily_moving_cell(r_on, zeta_1, anchoring):
    p = cc.Parameters(r_on=r_on, zeta_1=zeta_1)
    states = od.crawling_states(p, anchoring=anchoring)
    assert states
    for state in states:
        front, rear = state.off_rates
        v_front, v_rear = front * math.log(front), rear * math.log(rear)
        assert v_front + v_rear == pytest.approx(2 * p.v_p, rel=1e-12)
        assert p.epsilon * (v_rear - v_front) / 2 == pytest.approx(state.speed, rel=1e-9)
        assert state.bound_fractions[0] == pytest.approx(p.r_on / (p.r_on + front))
        imbalance = 0.0
        if anchoring.stiffness:
            imbalance = anchoring.stiffness * state.speed / anchoring.relaxation
        for r, side in ((front, 1.0), (rear, -1.0)):
            pull = p.sigma_c + state.tension + side * imbalance
            assert steady_force(p, r) == pytest.approx(pull, rel=1e-8)


def test_a_still_cell_that_is_unstable_has_a_crawling_state_and_a_free_stable_one_none():
    for r_on, zeta_1, count in ((25, 600, 1), (10, 600, 2), (4, 600, 0), (25, 300, 0)):
        p = cc.Parameters(r_on=r_on, zeta_1=zeta_1)
        assert len(od.crawling_states(p)) == count
        grows = od.growth_rates(p, "antisymmetric")[0].real > 0
        assert grows == (count == 1)
    assert od.crawling_states(P, anchoring=od.Anchoring(stiffness=1.0)) == []


@pytest.mark.parametrize("cell", [P, CONSISTENT])
def test_runs_settle_into_the_stable_crawling_state(cell):
    (state,) = od.crawling_states(cell)
    assert state.stable
    run = od.simulate_two_edges(cell, 30.0)
    assert run.tension[-1].item() == pytest.approx(state.tension, rel=1e-8)
    np.testing.assert_allclose(run.bound_fraction[-1], state.bound_fractions, rtol=1e-8)
    assert od.regime(run).speed == pytest.approx(state.speed, rel=1e-6)
    assert od.regime(run).name == "crawling"


def test_a_crawling_state_that_theory_calls_unstable_is_left_for_steps():
    (steady,) = od.crawling_states(P.replace(r_on=40, zeta_1=700))
    (shaken,) = od.crawling_states(P.replace(r_on=44, zeta_1=700))
    assert steady.growth_rate < 0.0 < shaken.growth_rate
    at_rest = {"front": shaken.bound_fractions[0], "rear": shaken.bound_fractions[1] + 1e-3}
    start = od.TwoEdges(**at_rest, tension=shaken.tension)
    run = od.simulate_two_edges(P.replace(r_on=44, zeta_1=700), 60.0, start=start)
    assert od.regime(run).name == "stepping"
    run = od.simulate_two_edges(P.replace(r_on=40, zeta_1=700), 60.0)
    assert od.regime(run).name == "crawling"


def test_still_and_crawling_are_both_stable_where_theory_says():
    p = P.replace(r_on=10)
    assert od.growth_rates(p, "antisymmetric")[0] == 0.0  # a shift; the other root decays
    assert od.growth_rates(p, "antisymmetric")[1].real < 0
    assert od.growth_rates(p, "symmetric")[0].real < 0
    saddle, crawling = od.crawling_states(p)
    assert crawling.stable
    assert not saddle.stable
    assert od.regime(od.simulate_two_edges(p, 20.0, start="small")).name == "still"
    moving = od.regime(od.simulate_two_edges(p, 20.0, start="large"))
    assert moving.name == "crawling"
    assert moving.speed == pytest.approx(crawling.speed, rel=1e-6)


def test_the_unstable_crawling_state_parts_still_from_crawling():
    p = P.replace(r_on=10)
    saddle, crawling = od.crawling_states(p)
    front, rear = saddle.bound_fractions
    for part, ends in ((0.95, 0.0), (1.05, crawling.speed)):
        middle, half = 0.5 * (front + rear), 0.5 * part * (front - rear)
        start = od.TwoEdges(front=middle + half, rear=middle - half, tension=saddle.tension)
        run = od.simulate_two_edges(p, 20.0, start=start)
        assert od.regime(run).speed == pytest.approx(ends, abs=1e-6)


@pytest.mark.parametrize(
    ("cell", "options", "name"),
    [
        (P.replace(zeta_1=400), {"start": "large"}, "still"),
        (P, {"start": "small"}, "crawling"),
        (P, {"start": "in_phase"}, "stick-slip"),
        (P.replace(r_on=60, zeta_1=800), {"start": "large"}, "stick-slip"),
        (P.replace(r_on=48, zeta_1=700), {}, "stepping"),
        (CONSISTENT, {"anchoring": BODY}, "bipedal"),
        (CONSISTENT, {"start": "in_phase"}, "crawling"),
    ],
)
def test_regimes_found_in_the_documentation(cell, options, name):
    found = od.regime(od.simulate_two_edges(cell, 60.0, rtol=1e-5, **options))
    assert found.name == name
    assert found.settled


def test_edges_that_take_turns_do_the_same_half_a_period_apart():
    run = od.simulate_two_edges(CONSISTENT, 30.0, anchoring=BODY, save_every=0.005)
    late = run.bound_fraction.sel(time=slice(20.0, None))
    front, rear = late.values.T
    crossings = np.flatnonzero(np.diff(np.sign(front - rear)))
    half_period = round(np.diff(crossings).mean())
    moved = np.abs(front[half_period:] - rear[:-half_period]).max()
    assert np.ptp(front) > 0.3
    assert moved < 0.05 * np.ptp(front)
    position = run.position.mean("edge").sel(time=slice(20.0, None))
    assert float(position.max() - position.min()) < 0.1


def run_of(front, rear, times=None):
    times = np.linspace(0, 10, len(front)) if times is None else times
    bound = np.column_stack([front, rear])
    return xr.Dataset(
        {"bound_fraction": (("time", "edge"), bound), "position": (("time", "edge"), 0 * bound)},
        {"time": times, "edge": ["front", "rear"]},
        {"model": "two edges", "status": "completed"},
    )


def test_the_rule_on_made_up_runs():
    t = np.linspace(0, 10, 2001)
    wave = 0.1 * np.sin(20 * t)
    flat = 0 * t
    for front, rear, name in (
        (flat + 0.3, flat + 0.3, "still"),
        (flat + 0.5, flat + 0.3, "crawling"),
        (0.3 + wave, 0.3 + wave, "stick-slip"),
        (0.6 + 0.3 * wave, 0.3 + wave, "stepping"),
        (0.3 + wave, 0.3 - wave, "bipedal"),
        (0.3 + wave, 0.3 + 0.1 * np.cos(20 * t), "bipedal"),
        (0.3 + 0.05 * wave, 0.3 + 0.05 * wave, "still"),
    ):
        found = od.regime(run_of(front, rear))
        assert found.name == name
        assert found.settled


def test_a_drift_is_no_swing_and_is_not_settled():
    t = np.linspace(0, 10, 1001)
    drifting = od.regime(run_of(0.5 + 0.02 * t, 0.2 - 0.02 * t))
    assert drifting.name == "crawling"
    assert not drifting.settled
    growing = od.regime(run_of(0.3 + 0.005 * np.exp(0.4 * t) * np.sin(9 * t), 0.3 + 0 * t))
    assert not growing.settled


def test_a_diagram_labels_each_cell_as_a_run_of_its_own():
    diagram = od.phase_diagram(P, r_on=[10, 25, 48], zeta_1=[400, 600, 700])
    assert diagram.regime.dims == ("start", "r_on", "zeta_1")
    for start in ("small", "large", "in_phase"):
        for r_on in (10, 25, 48):
            cell = P.replace(r_on=r_on, zeta_1=700)
            code = int(diagram.regime.sel(start=start, r_on=r_on, zeta_1=700))
            run = od.simulate_two_edges(cell, 60.0, start=start, save_every=0.06, rtol=1e-6)
            assert od.REGIMES[code] == od.regime(run).name
    assert bool(diagram.bistable.sel(r_on=10, zeta_1=600))
    assert not bool(diagram.bistable.any("r_on").sel(zeta_1=400))
    assert diagram.speed.sel(start="large", r_on=10, zeta_1=600).item() == pytest.approx(
        od.crawling_states(P.replace(r_on=10))[-1].speed, rel=1e-4
    )


def test_a_run_that_cannot_go_on_is_named_and_keeps_what_it_has():
    # at few linkers and strong adhesion the springs pull an edge below no force at all
    p = cc.Parameters(r_on=2, zeta_1=1500, elasticity="consistent")
    run = od.simulate_two_edges(p, 20.0, start="large", anchoring=BODY)
    assert run.attrs["status"] == "out_of_range"
    assert run.sizes["time"] > 1
    assert bool(np.isfinite(run.bound_fraction).all())
    assert od.regime(run).name == "failed"
    diagram = od.phase_diagram(
        p, r_on=[2, 25], zeta_1=[600, 1500], starts="large", anchoring=BODY, t_end=20.0
    )
    codes = diagram.regime.values[0]
    assert od.REGIMES[codes[0, 1]] == "failed"
    assert od.REGIMES[codes[1, 0]] == "bipedal"


def test_boundaries_lie_where_growth_and_crawling_begin():
    plane = {"r_on": [4, 80], "zeta_1": [400, 900]}
    for symmetry in ("symmetric", "antisymmetric"):
        (curve,) = od.boundaries(P, symmetry, **plane)
        for r_on, zeta_1 in curve[::10]:
            rate = od.growth_rates(P.replace(r_on=r_on, zeta_1=zeta_1), symmetry)[0].real
            assert abs(rate) < 1e-6
    (curve,) = od.boundaries(P, "crawling", **plane)
    for r_on, zeta_1 in curve[2:-2:12]:
        below, above = (
            len(od.crawling_states(P.replace(r_on=r_on, zeta_1=zeta_1 + step)))
            for step in (-1.0, 1.0)
        )
        assert below == 0 < above


def test_rates_of_any_law_are_those_of_the_quadratics_under_the_papers():
    values = {"r_on": np.array([10.0, 25.0, 60.0])}
    for anchoring in (od.Anchoring(), BODY):
        for symmetry in ("symmetric", "antisymmetric"):
            if symmetry == "antisymmetric" and anchoring is BODY:
                continue  # three rates there, of which the quadratic keeps a pair
            matrices = theory._matrices(P, symmetry, anchoring, values, cc.laws.PAPER)
            found = np.sort_complex(np.linalg.eigvals(matrices))
            true = np.sort_complex(od.growth_rates(P, symmetry, anchoring=anchoring, **values))
            np.testing.assert_allclose(found, true, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize(
    ("laws", "cell"),
    [
        (cc.laws.CatchSlip(catch=2.0, slip=0.9), P),
        (cc.laws.PolymerizationUnderLoad(stall=6000.0), CONSISTENT),
    ],
)
def test_under_other_laws_runs_settle_into_the_stable_crawling_state(laws, cell):
    states = od.crawling_states(cell, laws=laws)
    assert [state.speed for state in states] == sorted(state.speed for state in states)
    state = states[-1]
    assert state.stable
    run = od.simulate_two_edges(cell, 40.0, start="large", laws=laws)
    assert run.tension[-1].item() == pytest.approx(state.tension, rel=1e-7)
    np.testing.assert_allclose(run.bound_fraction[-1], state.bound_fractions, rtol=1e-7)
    assert od.regime(run).speed == pytest.approx(state.speed, rel=1e-6)
    plane = {"r_on": [cell.r_on - 1.0, cell.r_on], "zeta_1": [cell.zeta_1 - 1.0, cell.zeta_1]}
    diagram = od.phase_diagram(cell, starts="large", laws=laws, **plane)
    assert od.REGIMES[int(diagram.regime[0, 1, 1])] == "crawling"
    assert float(diagram.speed[0, 1, 1]) == pytest.approx(state.speed, rel=1e-3)


def test_under_other_laws_the_still_cell_loses_its_symmetry_where_its_rate_is_nought():
    laws = cc.laws.CatchSlip(catch=2.0, slip=0.9)
    values = np.linspace(2.0, 60.0, 30)
    rates = od.growth_rates(P, "antisymmetric", laws=laws, r_on=values)
    assert rates.shape == (30, 2)
    assert np.all(np.abs(rates).min(axis=-1) < 1e-9)  # a shift
    (change,) = np.flatnonzero(np.diff(rates[:, 0].real > 1e-9))[:1]
    for r_on, ends in ((values[change], "still"), (values[change + 1], "crawling")):
        run = od.simulate_two_edges(P.replace(r_on=r_on), 60.0, laws=laws)
        assert od.regime(run).name == ends


def test_an_anchored_still_cell_starts_to_take_turns_at_a_hopf_point():
    (curve,) = od.boundaries(
        CONSISTENT, "antisymmetric", anchoring=BODY, r_on=[10, 70], zeta_1=[400, 900]
    )
    r_on, zeta_1 = curve[len(curve) // 2]
    cell = CONSISTENT.replace(r_on=r_on, zeta_1=zeta_1)
    pair = od.growth_rates(cell, "antisymmetric", anchoring=BODY)
    assert abs(pair[0].real) < 1e-6
    assert pair[0].imag > 5.0


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: od.phase_diagram(P, r_on=[1, 2]), "over two parameters, not 1"),
        (lambda: od.phase_diagram(P, r_on=[2, 1], zeta_1=[1, 2]), "increasing"),
        (lambda: od.phase_diagram(P, r_on=[1, 2], zeta=[1, 2]), "did you mean 'zeta_1'"),
        (lambda: od.phase_diagram(P, r_on=[1, 2], zeta_1=[1, 2], starts=["big"]), "no 'big'"),
        (lambda: od.phase_diagram(P, r_on=[1, 2], zeta_1=[1, 2], starts=[]), "starts is empty"),
        (lambda: od.phase_diagram(P, r_on=[1, 2], zeta_1=[1, 2], t_end=0.1), "t_end = 0.1"),
        (lambda: od.boundaries(P, "wave", r_on=[1, 2], zeta_1=[1, 2]), "which = 'wave'"),
        (lambda: od.regime(P), "must be xarray's Dataset"),
        (lambda: od.regime(od.simulate_two_edges(P, 0.1)), "eight are needed"),
        (lambda: od.regime(od.simulate_two_edges(P, 1.0), threshold=2.0), "threshold = 2"),
    ],
)
def test_mistakes_are_one_line(make, said):
    with pytest.raises(cc.InputError, match=said) as mistake:
        make()
    assert "\n" not in str(mistake.value)
