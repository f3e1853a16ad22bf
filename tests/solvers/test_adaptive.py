"""The adaptive solver: what it computes, how well, and that it can be stopped and resumed."""

from __future__ import annotations

import math

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.curve import Curve, first_crossing
from cellcrawl.errors import InputError
from cellcrawl.parameters import CONSTANT, Schedule
from cellcrawl.solvers import Frame
from cellcrawl.solvers.adaptive import AdaptiveSolver
from cellcrawl.solvers.adaptive import state as layout
from cellcrawl.solvers.conditions import Conditions
from cellcrawl.verification import orders
from tests.conftest import check_start, reflected, rotated

ZIGZAG = cc.Parameters(r_on=26, zeta_1=600)
LAWS = ("printed", "consistent")


def solver(
    parameters: cc.Parameters = ZIGZAG,
    state: cc.CellState | None = None,
    schedule: Schedule = CONSTANT,
    **options: float,
) -> AdaptiveSolver:
    state = state or check_start(parameters).state(parameters, AdaptiveSolver.start_nodes(256))
    return AdaptiveSolver(state, Conditions(parameters, schedule), **options)


def frame_at(time: float, made: AdaptiveSolver) -> Frame:
    assert made.advance(time) is None
    return made.frame(time)


def error(found: Frame, true: Frame) -> float:
    """The larger of the relative error of the length and the error of the centroid."""
    shift = math.hypot(found.centroid_x - true.centroid_x, found.centroid_y - true.centroid_y)
    return max(abs(found.length / true.length - 1.0), shift)


@pytest.fixture(scope="module", params=LAWS)
def law(request: pytest.FixtureRequest) -> cc.Parameters:
    return ZIGZAG.replace(elasticity=request.param)


def test_reproduces_the_deterministic_check() -> None:
    frame = frame_at(2.0, solver(rtol=1e-8))
    assert frame.length == pytest.approx(6.609484, abs=1.5e-6)
    assert frame.tension == pytest.approx(912.998, abs=1.5e-3)
    assert frame.area == pytest.approx(3.165835, abs=1.5e-6)
    assert frame.centroid_x == pytest.approx(0.458285, abs=1.5e-6)
    assert frame.centroid_y == pytest.approx(0.030681, abs=1.5e-6)


def test_error_follows_the_tolerance(law: cc.Parameters) -> None:
    tolerances = np.array([1e-3, 1e-4, 1e-5, 1e-6])
    errors, slope = orders.error_against_tolerance(law, tolerances)
    assert np.all(errors <= 4.0 * tolerances)
    assert 0.6 < slope < 1.4


@pytest.mark.parametrize("point", [(24, 540), (36, 560), (16, 600), (56, 560)])
def test_default_tolerance_is_kept_in_every_mode(
    point: tuple[int, int], law: cc.Parameters
) -> None:
    parameters = law.replace(r_on=point[0], zeta_1=point[1])
    true = frame_at(5.0, solver(parameters, rtol=1e-6))
    assert error(frame_at(5.0, solver(parameters)), true) <= 1e-4


@pytest.mark.parametrize("rtol", [1e-5, 1e-7, 1e-10])
@pytest.mark.parametrize("start", [cc.PerturbedCircle(), cc.Eigenmode(1, 1e-4, "-")])
def test_a_start_of_hardly_more_than_rounding_is_taken_at_any_tolerance(
    start: cc.PerturbedCircle | cc.Eigenmode, rtol: float
) -> None:
    run = cc.simulate(ZIGZAG, 0.1, start=start, rtol=rtol)
    assert run.attrs["status"] == "completed"
    assert np.ptp(run["bound_fraction"].values) < 1e-6


def test_tenth_order_in_space_and_at_least_fourth_in_time(law: cc.Parameters) -> None:
    assert orders.adaptive_order_in_space(law) == pytest.approx(10.0, abs=0.6)
    assert orders.adaptive_order_in_time(law) > 4.0


def test_resting_circle_stays_a_circle_on_the_fewest_nodes(law: cc.Parameters) -> None:
    circle = Curve(math.pi / 2 + 2 * math.pi * np.arange(128) / 128, 2 * math.pi, np.array([1, 0]))
    state = cc.CellState(circle, np.full(128, law.n_bar), law.sigma_bar)
    made = solver(law, state)
    frame = frame_at(1.0, made)
    assert frame.length == pytest.approx(2 * math.pi, abs=1e-11)
    assert np.ptp(frame.bound_fraction) < 1e-9
    assert np.ptp(frame.curvature) < 1e-8
    assert made.diagnostics()["most_nodes"] == 64


def enclosed_area(frame: Frame) -> float:
    """Area inside points on a closed curve, by Fourier derivatives of the points alone."""
    z = frame.x + 1j * frame.y
    slope = np.fft.ifft(1j * np.fft.fftfreq(z.size, 1.0 / z.size) * np.fft.fft(z))
    return float(math.pi * np.mean(np.imag(np.conj(z) * slope)))


@pytest.mark.parametrize("rtol", [1e-2, 1e-4])
@pytest.mark.parametrize("point", [(26, 600), (16, 600)])
def test_the_edge_closes_around_the_area_of_its_tension(
    point: tuple[int, int], rtol: float, law: cc.Parameters
) -> None:
    parameters = law.replace(r_on=point[0], zeta_1=point[1])
    made = solver(parameters, rtol=rtol, nodes=1024)
    first = made.frame(0.0)
    for time in (3.0, 60.0, 200.0):
        last = frame_at(time, made)
        stretched = (last.tension - first.tension) / parameters.tension_rate
        assert last.area - first.area == pytest.approx(stretched, abs=1e-9)
        assert enclosed_area(last) == pytest.approx(last.area, abs=1e-6)
        step = last.length / 1024
        assert np.abs(np.diff(last.x, append=last.x[:1])).max() < 1.01 * step


@pytest.mark.parametrize("point", [(16, 600), (26, 600), (24, 540)])
def test_errors_stay_within_ten_tolerances_to_t_100(
    point: tuple[int, int], law: cc.Parameters
) -> None:
    parameters = law.replace(r_on=point[0], zeta_1=point[1])
    fine, coarse = solver(parameters, rtol=1e-6), solver(parameters, rtol=1e-4)
    for time in (50.0, 75.0, 100.0):
        assert error(frame_at(time, coarse), frame_at(time, fine)) <= 1e-3


def test_nodes_gather_where_the_edge_bends() -> None:
    made = solver(cc.Parameters(r_on=16, zeta_1=600))
    frame = frame_at(60.0, made)
    state = made.checkpoint()["differences"][0]
    density = layout.density(state)
    assert density.mean() == pytest.approx(1.0, abs=1e-12)
    assert density.min() < 0.5
    # where the curvature is largest, the nodes are closest
    places = (np.cumsum(density) - 0.5 * density) / density.size
    sharpest = np.argmax(frame.curvature) / frame.curvature.size
    assert abs((places[np.argmin(density)] - sharpest + 0.5) % 1.0 - 0.5) < 0.05


def test_a_resting_circle_keeps_its_nodes_even() -> None:
    made = solver(cc.Parameters(r_on=60, zeta_1=500))
    made.advance(30.0)
    assert np.ptp(layout.density(made.checkpoint()["differences"][0])) < 1e-6


def test_rotating_the_start_rotates_the_run() -> None:
    state = check_start(ZIGZAG).state(ZIGZAG, 512)
    straight = frame_at(2.0, solver(state=state))
    turned = frame_at(2.0, solver(state=rotated(state, 0.7)))
    z = (straight.x + 1j * straight.y) * np.exp(0.7j)
    np.testing.assert_allclose(turned.x + 1j * turned.y, z, atol=1e-8)
    np.testing.assert_allclose(turned.bound_fraction, straight.bound_fraction, atol=1e-8)


def test_reflecting_the_start_reflects_the_run() -> None:
    state = check_start(ZIGZAG).state(ZIGZAG, 512)
    straight = frame_at(2.0, solver(state=state))
    mirrored = frame_at(2.0, solver(state=reflected(state)))
    assert mirrored.centroid_x == pytest.approx(straight.centroid_x, abs=1e-4)
    assert mirrored.centroid_y == pytest.approx(-straight.centroid_y, abs=1e-4)
    assert mirrored.tension == pytest.approx(straight.tension, rel=1e-4)


def test_restored_run_goes_on_to_the_same_bits(law: cc.Parameters) -> None:
    through = solver(law)
    through.advance(1.3)
    saved = through.checkpoint()
    resumed = AdaptiveSolver(None, Conditions(law))
    resumed.restore(saved)
    for name in ("x", "theta", "bound_fraction", "off_rate"):
        time = 1.3
        assert np.all(getattr(resumed.frame(time), name) == getattr(through.frame(time), name))
    for made in (through, resumed):
        assert made.advance(3.0) is None
    after, again = through.checkpoint(), resumed.checkpoint()
    assert all(np.array_equal(after[name], again[name]) for name in after if name != "tally")


def test_steps_do_not_depend_on_the_targets(law: cc.Parameters) -> None:
    once, often = solver(law), solver(law)
    once.advance(2.0)
    for target in np.linspace(0.0, 2.0, 173):
        often.advance(target)
    assert once.time == often.time
    assert np.array_equal(once.checkpoint()["differences"], often.checkpoint()["differences"])


def test_frames_between_steps_are_as_accurate_as_steps(law: cc.Parameters) -> None:
    coarse, fine = solver(law), solver(law, rtol=1e-7)
    for time in np.linspace(0.1, 2.0, 20):
        assert error(frame_at(time, coarse), frame_at(time, fine)) <= 2e-4


def test_frames_at_any_number_of_nodes_lie_on_one_curve() -> None:
    few, many = (frame_at(2.0, solver(nodes=nodes)) for nodes in (100, 700))
    for name in ("x", "curvature", "bound_fraction", "off_rate"):
        np.testing.assert_allclose(
            getattr(few, name), getattr(many, name)[::7], rtol=1e-9, atol=1e-9
        )


@pytest.mark.parametrize("law_name", LAWS)
def test_jumps_are_hit_exactly(law_name: str) -> None:
    jump = Schedule({"r_on": [(1.0, 26.0), (1.0, 40.0)]})
    parameters = ZIGZAG.replace(elasticity=law_name)
    made = solver(parameters, schedule=jump, rtol=1e-7)
    made.advance(1.0)
    assert made.time == 1.0
    before = solver(parameters, rtol=1e-7)
    before.advance(1.0)
    assert error(made.frame(1.0), before.frame(1.0)) <= 1e-6
    assert error(frame_at(1.5, made), frame_at(1.5, before)) > 1e-4


def test_ramps_are_followed_to_the_tolerance(law: cc.Parameters) -> None:
    ramp = Schedule({"r_on": [(0.2, 26.0), (1.2, 40.0)], "r_p": [(0.5, 50.0), (1.0, 55.0)]})
    true = frame_at(2.0, solver(law, schedule=ramp, rtol=1e-8))
    for rtol in (1e-4, 1e-6):
        assert error(frame_at(2.0, solver(law, schedule=ramp, rtol=rtol)), true) <= 4.0 * rtol


def test_nodes_follow_the_shape_up_and_down() -> None:
    gliding = cc.Parameters(r_on=16, zeta_1=600)
    start = cc.RandomPerturbation(seed=3)
    made = solver(gliding, start.state(gliding, AdaptiveSolver.start_nodes(256)))
    rough = made.checkpoint()["log_rate"].size
    made.advance(1.0)
    nearly_round = made.checkpoint()["log_rate"].size
    made.advance(4.0)
    assert rough > 400
    assert nearly_round < 160
    assert made.checkpoint()["log_rate"].size > nearly_round


def test_too_few_nodes_are_named() -> None:
    made = solver(cc.Parameters(r_on=16, zeta_1=600), max_nodes=64)
    breakdown = made.advance(20.0)
    assert breakdown is not None
    assert breakdown.status == "unresolved"
    assert "raise max_nodes or rtol" in breakdown.message
    assert np.all(np.isfinite(made.frame(made.time).off_rate))


def test_a_bend_that_leaves_the_model_is_the_cell_and_not_the_grid() -> None:
    p = cc.Parameters(r_on=16, zeta_1=600)
    start = cc.RandomPerturbation(seed=27)
    loose, tight = (cc.simulate(p, 3.0, start=start, nodes=2048, rtol=t) for t in (1e-4, 1e-7))
    assert loose.attrs["status"] == "out_of_range"
    assert tight.attrs["status"] == "unresolved"  # the bend is too sharp for 4096 nodes at 1e-7
    assert tight.attrs["status_message"].endswith("raise rtol")
    both = tight["time"].values[:-1]
    sharpest = [run["curvature"].sel(time=both).min("node").values for run in (loose, tight)]
    folded = sharpest[1] < -2.0
    assert sharpest[1].min() < -10.0
    np.testing.assert_allclose(sharpest[0][folded], sharpest[1][folded], rtol=0.05)
    # nothing balances the forces beyond this curvature, whatever the bound fraction
    limit = -(1.0 + p.sigma_c / float(loose["tension"][-1])) / p.h
    assert 1.15 * limit < float(loose["curvature"].min()) < 0.8 * limit


def test_leaving_the_model_is_named_and_keeps_the_last_state() -> None:
    soft = cc.Parameters(r_on=16, zeta_1=600)
    start = cc.RandomPerturbation(seed=1).state(soft, 1024)
    tense = cc.CellState(start.curve, start.bound_fraction, -150.0)
    with pytest.raises(InputError, match="off-rate"):
        solver(soft, tense)


def test_unresolved_start_is_refused() -> None:
    theta = 2 * math.pi * np.arange(64) / 64
    rough = Curve(theta + 0.05 * np.cos(31 * theta), 2 * math.pi)
    with pytest.raises(InputError, match="not resolved"):
        solver(state=cc.CellState(rough, np.full(64, 0.3), 800.0))


@pytest.mark.parametrize(
    "options", [{"rtol": 0.0}, {"rtol": 1.0}, {"max_nodes": 10}, {"nodes": 3}, {"min_nodes": 8192}]
)
def test_options_out_of_range_are_refused(options: dict[str, float]) -> None:
    with pytest.raises(InputError):
        solver(**options)


def test_an_instant_has_the_bits_of_its_frame_and_is_simple_when_it_says_so() -> None:
    conditions = Conditions(cc.Parameters(r_on=16))
    start = cc.RandomPerturbation(seed=6).state(conditions.parameters, 1024)  # this cell tears
    solver = AdaptiveSolver(start, conditions)
    doubtful = 0
    for time in np.arange(0.5, 15.0, 0.5):
        assert solver.advance(time) is None
        instant, frame = solver.instant(time), solver.frame(time)
        names = ("time", "tension", "length", "area", "centroid_x", "centroid_y")
        assert [getattr(instant, n) for n in names] == [getattr(frame, n) for n in names]
        doubtful += not instant.surely_simple
        if instant.surely_simple:
            assert first_crossing(frame.points) is None
        if first_crossing(frame.points) is not None:
            break
    assert 0 < doubtful < 29


@pytest.mark.parametrize("changes", [[(0.5, 26.0), (0.5, 40.0)], [(0.2, 26.0), (0.7, 40.0)]])
def test_many_instants_in_one_call_are_those_of_a_call_each(changes) -> None:
    schedule = cc.Schedule({"r_on": changes})
    times = [k / 10 for k in range(13)]
    together, each = solver(schedule=schedule), solver(schedule=schedule)
    seen, ended = together.instants(times)
    assert ended is None
    assert len(seen) == len(times)
    for time, found in zip(times, seen, strict=True):
        assert each.advance(time) is None
        assert vars(found) == vars(each.instant(time))
