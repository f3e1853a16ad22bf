"""Runs of two edges: growth rates, invariants, symmetries, accuracy."""

from __future__ import annotations

import math

import numpy as np
import pytest

import cellcrawl as cc

od = cc.one_dimensional
P = cc.Parameters(r_on=25, zeta_1=600)
BODY = od.Anchoring(stiffness=6280.0, relaxation=1.0)


def still(p: cc.Parameters) -> tuple[float, float, float, float, float]:
    """n_bar, a, b, c, q of MODEL.md section 4 at k = 0, and their tension with curvature 0."""
    log_r, n = math.log(p.r_p), p.r_on / (p.r_on + p.r_p)
    return n, 1 + log_r + p.zeta_1 * n / p.r_p, p.zeta_1 * n * log_r, 1 + log_r, p.r_on + p.r_p


def tension_of_still(p: cc.Parameters) -> float:
    n, log_r = p.r_on / (p.r_on + p.r_p), math.log(p.r_p)
    return p.r_p * log_r + p.zeta_1 * n * log_r - p.sigma_c


@pytest.mark.parametrize("elasticity", ["printed", "consistent"])
@pytest.mark.parametrize(("r_on", "zeta_1"), [(25, 600), (16, 500), (60, 800), (10, 300)])
def test_symmetric_rates_are_those_of_the_quadratic(elasticity, r_on, zeta_1):
    p = cc.Parameters(r_on=r_on, zeta_1=zeta_1, elasticity=elasticity)
    _, a, b, c, q = still(p)
    gain = p.k_sigma if elasticity == "printed" else p.k_sigma / p.epsilon
    stiffness = 2 * math.pi * p.epsilon * gain
    for root in od.growth_rates(p, "symmetric"):
        terms = [a * root**2, (a * q + stiffness * c - b) * root, stiffness * c * q]
        assert abs(sum(terms)) <= 1e-9 * sum(abs(term) for term in terms)


def test_antisymmetric_rate_is_that_of_translation_without_diffusion():
    # MODEL.md 4: 12.74 at (25, 600) with D = 0.05, that is b/a - q_1; on a line q has no D
    rates = od.growth_rates(P, "antisymmetric")
    _, a, b, _, q = still(P)
    assert rates[0].real == pytest.approx(b / a - q, rel=1e-12)
    assert rates[0].real == pytest.approx(12.74 + P.D, abs=0.005)
    assert rates[1] == 0.0


def test_breathing_is_that_of_the_round_cell_but_for_curvature():
    # MODEL.md 4: -77 and -3408 (consistent), 4.65 +- 15.5i (printed); h = 0.01 is left out here
    consistent = od.growth_rates(P.replace(elasticity="consistent"), "symmetric")
    np.testing.assert_allclose(consistent, [-77, -3408 / 1.01], rtol=1e-3)
    assert od.growth_rates(P, "symmetric")[0] == pytest.approx(4.65 + 15.5j, rel=5e-3)
    flat = cc.linear.growth_rates(P.replace(h=0.0), 0)
    np.testing.assert_allclose(od.growth_rates(P, "symmetric"), flat, rtol=1e-12)


@pytest.mark.parametrize("elasticity", ["printed", "consistent"])
@pytest.mark.parametrize("anchoring", [od.Anchoring(), BODY, od.Anchoring(stiffness=3000.0)])
@pytest.mark.parametrize(("r_on", "zeta_1"), [(25, 600), (16, 460), (50, 700)])
def test_small_antisymmetric_perturbations_grow_as_theory_says(r_on, zeta_1, elasticity, anchoring):
    p = cc.Parameters(r_on=r_on, zeta_1=zeta_1, elasticity=elasticity)
    n, a, b, _, q = still(p)
    rates = od.growth_rates(p, "antisymmetric", anchoring=anchoring)
    size = 1e-5
    start = od.TwoEdges(front=n + size, rear=n - size)
    run = od.simulate_two_edges(p, 0.3, start=start, anchoring=anchoring, rtol=1e-11)
    found = run.bound_fraction.diff("edge").values.ravel() / (-2 * size)
    t = run.time.values
    if anchoring.stiffness == 0.0:
        rate = rates[np.argmax(np.abs(rates))].real  # the other root is 0, a shift
        expected = np.exp(rate * t)
    else:  # both roots: with no imbalance at first, n' = (b/a - q) n
        first, second = rates
        part = (b / a - q - second) / (first - second)
        expected = (part * np.exp(first * t) + (1 - part) * np.exp(second * t)).real
    np.testing.assert_allclose(found, expected, atol=2e-5 * np.abs(expected).max())


@pytest.mark.parametrize("elasticity", ["printed", "consistent"])
@pytest.mark.parametrize(("r_on", "zeta_1"), [(25, 600), (16, 460), (60, 800)])
def test_small_symmetric_perturbations_grow_as_theory_says(r_on, zeta_1, elasticity):
    p = cc.Parameters(r_on=r_on, zeta_1=zeta_1, elasticity=elasticity)
    n, a, b, _, q = still(p)
    first, second = od.growth_rates(p, "symmetric")
    size = 1e-7
    start = od.TwoEdges(front=n + size, rear=n + size)
    run = od.simulate_two_edges(p, 0.3, start=start, rtol=1e-11, save_every=0.01)
    found = (run.bound_fraction.mean("edge").values - n) / size
    t = run.time.values
    part = (b / a - q - second) / (first - second)
    expected = (part * np.exp(first * t) + (1 - part) * np.exp(second * t)).real
    np.testing.assert_allclose(found, expected, atol=2e-5 * np.abs(expected).max())


@pytest.mark.parametrize("elasticity", ["printed", "consistent"])
@pytest.mark.parametrize("anchoring", [od.Anchoring(), BODY])
def test_tension_follows_the_length_to_rounding_and_n_stays_a_fraction(elasticity, anchoring):
    p = cc.Parameters(r_on=50, zeta_1=700, elasticity=elasticity)
    run = od.simulate_two_edges(p, 20.0, start="large", anchoring=anchoring)
    gain = p.k_sigma if elasticity == "printed" else p.k_sigma / p.epsilon
    stiffness = math.pi * gain + 0.5 * anchoring.stiffness
    drift = run.tension - stiffness * run.length
    assert float(drift.max() - drift.min()) <= 1e-13 * stiffness * 100
    assert float(run.tension.max() - run.tension.min()) > 10.0
    assert float(run.bound_fraction.min()) >= 0.0
    assert float(run.bound_fraction.max()) <= 1.0
    assert float(run.off_rate.min()) >= 1.0


def test_force_balance_and_velocity_hold_at_every_record():
    run = od.simulate_two_edges(P, 3.0, start="large", anchoring=BODY, save_every=1e-3)
    r, n, y = run.off_rate, run.bound_fraction, np.log(run.off_rate)
    side = np.array([1.0, -1.0])
    pull = P.sigma_c + run.tension + side * run.imbalance.expand_dims(edge=2, axis=1)
    np.testing.assert_allclose(y * (r + P.zeta_1 * n), pull, rtol=1e-12)
    np.testing.assert_allclose(run.friction, pull, rtol=1e-12)
    np.testing.assert_allclose(run.velocity, P.epsilon * (P.v_p - r * y), atol=1e-12)
    steps = run.position.diff("time") / run.time.diff("time")
    middle = 0.5 * (run.velocity[1:].values + run.velocity[:-1].values) * side
    late = run.time.values[1:] > 1.0
    np.testing.assert_allclose(steps.values[late], middle[late], atol=1e-4)


@pytest.mark.parametrize("anchoring", [od.Anchoring(), BODY])
def test_exchanging_the_edges_mirrors_the_run(anchoring):
    p = P.replace(elasticity="consistent")
    one = od.simulate_two_edges(p, 8.0, start=od.TwoEdges(front=0.5, rear=0.2), anchoring=anchoring)
    other = od.simulate_two_edges(
        p, 8.0, start=od.TwoEdges(front=0.2, rear=0.5), anchoring=anchoring
    )
    np.testing.assert_allclose(
        one.bound_fraction.values, other.bound_fraction.values[:, ::-1], atol=1e-10
    )
    np.testing.assert_allclose(one.position.values, -other.position.values[:, ::-1], atol=1e-10)
    np.testing.assert_allclose(one.tension, other.tension, rtol=1e-10)


def test_equal_edges_stay_equal_to_the_bit():
    run = od.simulate_two_edges(P, 20.0, start=od.TwoEdges(front=0.2, rear=0.2))
    front, rear = run.bound_fraction.values.T
    assert np.array_equal(front, rear)
    np.testing.assert_allclose(run.position.sum("edge"), 0.0, atol=1e-13)


@pytest.mark.parametrize("start", [(0.35, 0.3), (0.9, 0.02), (0.27, 0.269)])
@pytest.mark.parametrize(("r_on", "zeta_1"), [(48, 700), (25, 600), (60, 900)])
def test_under_one_tension_the_more_bound_edge_stays_so(r_on, zeta_1, start):
    # both obey one equation n' = g(n, sigma(t)), whose solutions cannot cross
    p = cc.Parameters(r_on=r_on, zeta_1=zeta_1)
    run = od.simulate_two_edges(p, 30.0, start=od.TwoEdges(front=start[0], rear=start[1]))
    difference = run.bound_fraction.sel(edge="front") - run.bound_fraction.sel(edge="rear")
    assert float(difference.min()) > -1e-6


def test_contraction_only_shifts_the_tension():
    one = od.simulate_two_edges(P, 5.0)
    other = od.simulate_two_edges(P.replace(sigma_c=400.0), 5.0)
    np.testing.assert_allclose(one.bound_fraction, other.bound_fraction, atol=1e-9)
    np.testing.assert_allclose(one.tension, other.tension + 300.0, rtol=1e-9)


def test_adhesion_length_and_stiffness_count_by_their_product():
    one = od.simulate_two_edges(P, 5.0)
    other = od.simulate_two_edges(P.replace(epsilon=1e-4, k_sigma=1e4), 5.0)
    np.testing.assert_allclose(one.bound_fraction, other.bound_fraction, atol=1e-9)


def error(p: cc.Parameters, rtol: float, reference: np.ndarray) -> float:
    run = od.simulate_two_edges(p, 2.0, start="large", rtol=rtol, save_every=2.0)
    return float(np.abs(run.position.values[-1] - reference).max())


@pytest.mark.parametrize(
    ("elasticity", "r_on", "zeta_1"),
    [("printed", 48, 700), ("printed", 60, 800), ("consistent", 25, 600)],
)
def test_errors_shrink_with_the_tolerance(elasticity, r_on, zeta_1):
    p = cc.Parameters(r_on=r_on, zeta_1=zeta_1, elasticity=elasticity)
    best = od.simulate_two_edges(p, 2.0, start="large", rtol=1e-12, save_every=2.0)
    errors = [error(p, rtol, best.position.values[-1]) for rtol in (1e-4, 1e-6, 1e-8)]
    assert errors[0] < 1e-3
    assert errors[1] < 2e-5
    assert errors[2] < 2e-7


def test_the_step_is_of_order_four_and_its_estimate_of_order_three():
    from cellcrawl.laws import PAPER
    from cellcrawl.one_dimensional import rosenbrock
    from cellcrawl.one_dimensional.cell import edge_of

    constants, edge = np.array([3e3, 500.0, 2.0]), edge_of(P, PAPER, 2)
    laws = PAPER.compiled
    begin = np.array([0.6, 0.25, tension_of_still(P), 15.0, 0.0, 0.0])

    def after(steps: int) -> tuple[np.ndarray, float]:
        state, y, h = begin.copy(), np.full(2, np.nan), 0.02 / steps
        rate, new, missed = np.empty(6), np.empty(6), np.empty(6)
        total = 0.0
        for _ in range(steps):
            assert rosenbrock.rates(laws, edge, state, constants, y, rate)
            assert rosenbrock.step(laws, edge, state, y, constants, h, new, missed)
            state, total = new.copy(), max(total, float(np.abs(missed[:2]).max()))
        return state, total

    exact, _ = after(512)
    results = [after(steps) for steps in (4, 8, 16)]
    errors = [float(np.abs(state[:2] - exact[:2]).max()) for state, _ in results]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(np.abs(orders - 4.0) < 0.4)
    estimates = [estimate for _, estimate in results]
    assert np.all(np.abs(np.log2(np.array(estimates[:-1]) / estimates[1:]) - 4.0) < 0.4)


def test_small_differences_of_the_edges_grow_by_the_slopes_of_any_law():
    # without springs their rate is that of a flat edge at k = 0 whose tension is held
    p = P.replace(r_on=26.0)
    laws = cc.laws.CatchSlip(catch=40.0, slip=0.6)
    rest = cc.laws.rest_state(p, laws, 0.0)
    rate = float(max(od.flat_growth_rates(p, 0.0, laws=laws).real, key=abs))
    start = od.TwoEdges(front=rest.bound_fraction + 1e-6, rear=rest.bound_fraction - 1e-6)
    time = min(1.0, 2.0 / abs(rate))
    run = od.simulate_two_edges(p, time, start=start, laws=laws, rtol=1e-11, save_every=time / 8)
    n = run.bound_fraction
    apart = (n.sel(edge="front") - n.sel(edge="rear")).values
    found = math.log(apart[-1] / apart[1]) / float(run.time[-1] - run.time[1])
    assert found == pytest.approx(rate, rel=1e-3)
    assert od.still_tension(p, laws) == pytest.approx(rest.tension)


def test_records_are_where_they_are_asked_for():
    run = od.simulate_two_edges(P, 1.05, save_every=0.1)
    np.testing.assert_allclose(run.time.values, [*np.arange(11) * 0.1, 1.05], atol=1e-12)
    assert run.attrs["status"] == "completed"
    assert run.attrs["end_time"] == 1.05


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: od.simulate_two_edges(P, -1.0), "t_end = -1"),
        (lambda: od.simulate_two_edges(P, 1.0, save_every=0.0), "save_every = 0"),
        (lambda: od.simulate_two_edges(P, 1e9, save_every=1e-3), "larger save_every"),
        (lambda: od.simulate_two_edges(P, 1.0, rtol=1.0), "rtol = 1"),
        (lambda: od.simulate_two_edges(P, 1.0, start="smal"), "did you mean 'small'"),
        (lambda: od.simulate_two_edges(P, 1.0, start=3), "TwoEdges"),
        (lambda: od.simulate_two_edges({}, 1.0), "parameters must be Parameters"),
        (lambda: od.simulate_two_edges(P, 1.0, anchoring=1.0), "anchoring must be an Anchoring"),
        (lambda: od.TwoEdges(front=1.5, rear=0.1), "front = 1.5"),
        (lambda: od.TwoEdges(front=0.5, rear=math.nan), "rear"),
        (lambda: od.Anchoring(stiffness=-1.0), "stiffness = -1"),
        (
            lambda: od.simulate_two_edges(
                P, 1.0, start=od.TwoEdges(front=0.5, rear=0.5, tension=-200.0)
            ),
            "higher tension",
        ),
        (lambda: od.growth_rates(P, "odd"), "symmetry = 'odd'"),
        (lambda: od.growth_rates(P, "symmetric", zeta1=3), "did you mean 'zeta_1'"),
        (lambda: od.growth_rates(P, "symmetric", r_on=[1, 2], D=[1, 0.1, 0.5]), "broadcast"),
    ],
)
def test_mistakes_are_one_line(make, said):
    with pytest.raises(cc.InputError, match=said) as mistake:
        make()
    assert "\n" not in str(mistake.value)


def test_no_linkers_or_all_bound_are_starts_too():
    for front, rear in ((0.0, 0.0), (1.0, 1.0), (1.0, 0.0)):
        run = od.simulate_two_edges(P, 2.0, start=od.TwoEdges(front=front, rear=rear))
        assert run.attrs["status"] == "completed"
        assert bool(np.isfinite(run.bound_fraction).all())
