"""The flat edge: dispersion, waves, fronts, symmetries, accuracy."""

from __future__ import annotations

import math

import numpy as np
import pytest
import xarray as xr

import cellcrawl as cc

od = cc.one_dimensional
P = cc.Parameters(r_on=25, zeta_1=600)
WAVY = P.replace(epsilon=0.01, h=0.1)  # complex rates from k = 1 on


def quadratic(p: cc.Parameters, k: float, springs: float = 0.0) -> tuple[float, float, float]:
    """The derivation of the documentation page, written out again."""
    log_r, n = math.log(p.r_p), p.r_on / (p.r_on + p.r_p)
    tension = p.r_p * log_r + p.zeta_1 * n * log_r - p.sigma_c
    a, b, c = 1 + log_r + p.zeta_1 * n / p.r_p, p.zeta_1 * n * log_r, 1 + log_r
    q, s = p.r_on + p.r_p + p.D * k**2, p.epsilon * (p.h * tension * k**2 + springs)
    return a, a * q + s * c - b, s * c * q


@pytest.mark.parametrize("springs", [0.0, 3000.0])
@pytest.mark.parametrize("cell", [P, WAVY])
def test_rates_solve_the_dispersion_relation(cell, springs):
    for k in (0, 1, 3, 8, 20):
        a, b, c = quadratic(cell, k, springs)
        for root in od.flat_growth_rates(cell, k, anchoring=springs):
            size = abs(a * root**2) + abs(b * root) + abs(c)
            assert abs(a * root**2 + b * root + c) <= 1e-10 * max(size, 1e-12)


def test_high_waves_are_those_of_the_round_cell():
    # k^2 in place of k^2 - 1, and no (1 + h) in the tension
    k = np.array([20.0, 40.0])
    flat, round_cell = od.flat_growth_rates(P, k), cc.linear.growth_rates(P, k)
    np.testing.assert_allclose(flat, round_cell, rtol=0.02)


@pytest.mark.parametrize(
    ("cell", "waves", "springs"),
    [(P, 1, 0.0), (P, 10, 0.0), (P, 20, 0.0), (WAVY, 3, 0.0), (WAVY, 8, 0.0), (P, 2, 3000.0)],
)
def test_small_waves_grow_and_travel_as_linear_theory_says(cell, waves, springs):
    rate = od.flat_growth_rates(cell, waves, anchoring=springs)[0]
    start = od.FlatWave(waves=waves, amplitude=1e-6)
    run = od.simulate_flat_edge(
        cell, 0.05, start=start, anchoring=springs, rtol=1e-10, save_every=1e-3, nodes=256
    )
    mode = np.fft.rfft(run.bound_fraction.values, axis=1)[:, waves]
    found = np.log(mode[-1] / mode[0]) / 0.05
    assert found.real == pytest.approx(rate.real, rel=1e-4, abs=1e-3)
    assert -found.imag == pytest.approx(rate.imag, rel=1e-4, abs=1e-3)
    velocity = od.wave_velocity(run).velocity.values
    np.testing.assert_allclose(velocity, rate.imag / waves, rtol=1e-3, atol=1e-5)


def test_waves_at_onset_travel_at_the_frequency_over_the_wavenumber():
    # where growth changes sign the pair is imaginary: lambda^2 = -S c q / a
    hopf = WAVY
    low, high = 300.0, 900.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        hopf = WAVY.replace(zeta_1=middle)
        low, high = (low, middle) if quadratic(hopf, 4)[1] < 0 else (middle, high)
    a, _, c = quadratic(hopf, 4)
    start = od.FlatWave(waves=4, amplitude=1e-5, direction=-1)
    run = od.simulate_flat_edge(hopf, 0.3, start=start, rtol=1e-9, save_every=2e-3, nodes=256)
    moving = od.wave_velocity(run)
    np.testing.assert_allclose(moving.velocity, -math.sqrt(c / a) / 4, rtol=1e-3)
    assert float(moving.coherence.min()) > 0.99
    swing = np.ptp(run.bound_fraction.values, axis=1)
    np.testing.assert_allclose(swing, swing[0], rtol=2e-3)


@pytest.mark.parametrize("elasticity", ["printed", "consistent"])
def test_elastic_tension_acts_on_the_mean_and_keeps_area(elasticity):
    p = P.replace(elasticity=elasticity)
    run = od.simulate_flat_edge(p, 0.5, tension_law="elastic", length=3.0, rtol=1e-7)
    gain = p.k_sigma if elasticity == "printed" else p.k_sigma / p.epsilon
    swept = 3.0 * run.height.mean("s")
    np.testing.assert_allclose(
        run.tension - run.tension[0], gain * (swept - swept[0]), atol=1e-9 * gain
    )
    a, b, _ = quadratic(p, 0)
    pair = od.flat_growth_rates(p, 0, tension_law="elastic", length=3.0)
    c = 1 + math.log(p.r_p)
    stiffness = p.epsilon * gain * 3.0
    assert pair.sum().real == pytest.approx(-(b + stiffness * c) / a, rel=1e-9)
    assert pair.prod().real == pytest.approx(stiffness * c * (p.r_on + p.r_p) / a, rel=1e-9)


def test_fronts_move_at_the_speed_of_the_shooting_problem():
    flat = P.replace(h=0.0)
    for tension in (880.0, 930.0):
        run = od.simulate_flat_edge(
            flat, 0.8, tension=tension, start=od.StuckPatch(), length=4.0, rtol=1e-6
        )
        grown = od.stuck_length(run).sel(time=slice(0.3, 0.7))
        measured = 0.5 * np.polyfit(grown.time.values, grown.values, 1)[0]
        assert measured == pytest.approx(od.front_speed(flat, tension), rel=2e-3)


def test_front_speed_of_a_cubic_like_balance_falls_with_the_tension():
    speeds = [od.front_speed(P, tension) for tension in np.linspace(875, 950, 6)]
    assert np.all(np.diff(speeds) < 0)
    assert speeds[0] > 0 > speeds[-1]


def test_uniform_states_balance_the_forces():
    for tension, count in ((400.0, 1), (900.0, 3), (1400.0, 1)):
        states = od.uniform_states(P, tension)
        assert states.size == count
        for r in states:
            pull = math.log(r) * (r + P.zeta_1 * P.r_on / (P.r_on + r))
            assert pull == pytest.approx(P.sigma_c + tension, rel=1e-12)
    np.testing.assert_allclose(od.uniform_states(P, od.still_tension(P))[1], 50.0, rtol=1e-12)


def test_a_wave_travels_round_the_edge_at_elastic_and_then_at_held_tension():
    cell = cc.Parameters(r_on=26, zeta_1=600, elasticity="consistent")
    free = od.simulate_flat_edge(cell, 12.0, tension_law="elastic", save_every=0.05, rtol=1e-4)
    moving = od.wave_velocity(free).sel(time=slice(10.0, None))
    velocity = float(moving.velocity.mean())
    assert abs(velocity) > 0.3
    assert float(moving.coherence.min()) > 0.98
    last = free.isel(time=-1)
    pattern = od.FlatFields(bound_fraction=last.bound_fraction.values, height=last.height.values)
    held = od.simulate_flat_edge(
        cell, 8.0, tension=float(last.tension), start=pattern, save_every=0.05, rtol=1e-4
    )
    assert np.all(held.tension == last.tension)
    after = od.wave_velocity(held)
    assert float(after.velocity.mean()) == pytest.approx(velocity, rel=0.1)
    assert float(after.coherence.mean()) > 0.98


def test_only_the_product_of_adhesion_length_and_height_matters():
    start = od.FlatNoise(seed=4)
    one = od.simulate_flat_edge(P, 0.5, start=start, rtol=1e-7)
    other = od.simulate_flat_edge(P.replace(epsilon=1e-4, h=0.1), 0.5, start=start, rtol=1e-7)
    np.testing.assert_allclose(one.bound_fraction, other.bound_fraction, atol=1e-5)
    np.testing.assert_allclose(one.height, 10 * other.height, atol=1e-5)
    assert other.attrs["largest_slope"] == pytest.approx(one.attrs["largest_slope"] / 10, rel=1e-3)


def test_a_uniform_edge_stays_uniform_and_does_what_one_edge_does():
    start = od.FlatFields(bound_fraction=np.full(32, 0.3))
    flat = od.simulate_flat_edge(P, 0.5, start=start, nodes=32, rtol=1e-9)
    assert float(flat.bound_fraction.std("s").max()) < 1e-12
    free = P.replace(k_sigma=0.0)
    edges = od.simulate_two_edges(free, 0.5, start=od.TwoEdges(front=0.3, rear=0.3), rtol=1e-9)
    np.testing.assert_allclose(
        flat.bound_fraction.mean("s"), edges.bound_fraction.sel(edge="front"), atol=1e-7
    )


def test_a_mirrored_start_gives_the_mirrored_run():
    nodes = 128
    s = 2 * math.pi / nodes * np.arange(nodes)
    n = P.n_bar + 0.05 * np.cos(s) + 0.04 * np.sin(3 * s)
    back = -np.arange(nodes) % nodes
    options = {"nodes": nodes, "tension_law": "elastic", "rtol": 1e-8}
    one = od.simulate_flat_edge(P, 1.0, start=od.FlatFields(bound_fraction=n), **options)
    other = od.simulate_flat_edge(P, 1.0, start=od.FlatFields(bound_fraction=n[back]), **options)
    np.testing.assert_allclose(
        one.bound_fraction.values, other.bound_fraction.values[:, back], atol=1e-6
    )


def test_waves_under_another_law_grow_as_its_slopes_say():
    laws, p = cc.laws.CatchSlip(catch=40.0, slip=0.6), P.replace(r_on=30.0)
    tension = od.still_tension(p, laws)
    (rate, _) = od.flat_growth_rates(p, 3.0, laws=laws)
    run = od.simulate_flat_edge(
        p, 0.05, start=od.FlatWave(waves=3, amplitude=1e-5), rtol=1e-10, save_every=0.01, laws=laws
    )
    wave = np.fft.fft(run.bound_fraction.values, axis=1)[:, 3]
    grown = np.log(np.abs(wave[-1] / wave[0])) / float(run.time[-1])
    assert grown == pytest.approx(rate.real, rel=1e-3, abs=1e-3)
    assert float(run.tension[0]) == pytest.approx(tension)
    assert "CatchSlip" in run.attrs["laws"]


def test_the_closed_quadratic_of_the_papers_law_is_what_its_slopes_make():
    k = np.arange(0.0, 8.0)
    for r_on, off_rate, springs in ((26.0, 50.0, 0.0), (40.0, 20.0, 100.0), (60.0, 80.0, 0.0)):
        p = P.replace(r_on=r_on)
        n, y = r_on / (r_on + off_rate), math.log(off_rate)
        a, b, c = 1.0 + y + p.zeta_1 * n / off_rate, p.zeta_1 * n * y, 1.0 + y
        q = r_on + off_rate + p.D * k**2
        stiffness = p.epsilon * (p.h * (y * (off_rate + p.zeta_1 * n) - p.sigma_c) * k**2 + springs)
        found = od.flat_growth_rates(p, k, off_rate=off_rate, anchoring=springs)
        for root in found.T:
            parts = a * root**2, (a * q + stiffness * c - b) * root, stiffness * c * q
            size = sum(np.abs(part) for part in parts) + 1e-9
            assert np.all(np.abs(sum(parts)) < 1e-12 * size)


def test_runs_converge_with_the_nodes():
    def run(nodes):
        made = od.simulate_flat_edge(
            P, 0.05, start=od.FlatNoise(seed=2, waves=6), nodes=nodes, rtol=1e-10, save_every=0.05
        )
        return made.bound_fraction.values[-1]

    fine = run(768)
    errors = [np.abs(run(nodes) - fine[:: 768 // nodes]).max() for nodes in (96, 192)]
    assert 6.5 < math.log2(errors[0] / errors[1]) < 8.5
    assert errors[1] < 1e-8


def test_the_second_derivative_is_of_order_eight():
    from cellcrawl.one_dimensional.runge_kutta import second_derivative

    errors = []
    for nodes in (32, 64):
        s = 2 * math.pi / nodes * np.arange(nodes)
        out = np.empty(nodes)
        second_derivative(np.exp(np.sin(s)), 2 * math.pi / nodes, out)
        exact = (np.cos(s) ** 2 - np.sin(s)) * np.exp(np.sin(s))
        errors.append(np.abs(out - exact).max())
    assert abs(math.log2(errors[0] / errors[1]) - 8.0) < 0.3


def test_errors_shrink_with_the_tolerance():
    def run(rtol):
        made = od.simulate_flat_edge(
            P, 1.0, start=od.FlatNoise(seed=2), nodes=64, rtol=rtol, save_every=1.0, length=3.0
        )
        return made.bound_fraction.values[-1]

    best = run(1e-10)
    assert np.abs(run(1e-4) - best).max() < 1e-3
    assert np.abs(run(1e-7) - best).max() < 1e-6


def test_velocity_of_a_shifted_pattern_is_its_shift():
    s = np.arange(200) * 0.02
    times = np.linspace(0.0, 1.0, 41)
    shape = 0.4 + 0.2 * np.tanh(3 * np.cos(2 * np.pi / 4 * (s - 0.7 * times[:, None])))
    made = xr.Dataset(
        {"bound_fraction": (("time", "s"), shape)},
        {"time": times, "s": s},
        {"model": "flat edge", "length": 4.0},
    )
    moving = od.wave_velocity(made)
    np.testing.assert_allclose(moving.velocity, 0.7, rtol=2e-3)
    assert float(moving.coherence.min()) > 0.999
    stuck = od.stuck_length(made, 0.4)
    np.testing.assert_allclose(stuck, 2.0, atol=2e-3)


def test_an_edge_too_concave_is_refused_or_ends_out_of_range():
    with pytest.raises(cc.InputError, match="gentler height"):
        od.simulate_flat_edge(P, 1.0, start=od.FlatFields(**dented(64, 1.0)), nodes=64)


def dented(nodes: int, depth: float) -> dict[str, np.ndarray]:
    s = 2 * math.pi / nodes * np.arange(nodes)
    return {"bound_fraction": np.full(nodes, 0.3), "height": -depth * np.cos(12 * s)}


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: od.simulate_flat_edge(P, 0.0), "t_end = 0"),
        (lambda: od.simulate_flat_edge(P, 1.0, tension=-101.0), "higher tension"),
        (lambda: od.simulate_flat_edge(P, 1.0, tension="high"), "tension must be a number"),
        (lambda: od.simulate_flat_edge(P, 1.0, tension_law="elastc"), "did you mean 'elastic'"),
        (lambda: od.simulate_flat_edge(P, 1.0, length=1e4), "shorter edge"),
        (lambda: od.simulate_flat_edge(P, 1.0, nodes=4), "nodes = 4"),
        (lambda: od.simulate_flat_edge(P, 1e6, save_every=1e-4), "larger save_every"),
        (lambda: od.simulate_flat_edge(P, 1.0, start="noise"), "FlatNoise"),
        (lambda: od.simulate_flat_edge(P, 1.0, tension=2000.0, start=od.StuckPatch()), "one unif"),
        (
            lambda: od.simulate_flat_edge(
                P, 1.0, nodes=32, start=od.FlatFields(bound_fraction=np.ones(31))
            ),
            "shape",
        ),
        (
            lambda: od.simulate_flat_edge(
                P, 1.0, nodes=32, start=od.FlatFields(bound_fraction=np.full(32, 2.0))
            ),
            "from 0 to 1",
        ),
        (lambda: od.FlatWave(direction=0), "direction = 0"),
        (lambda: od.StuckPatch(part=0.0), "part = 0"),
        (lambda: od.FlatNoise(waves=0), "waves = 0"),
        (lambda: od.front_speed(P, 300.0), "one uniform state"),
        (lambda: od.flat_growth_rates(P, math.nan), "k is not finite"),
        (lambda: od.wave_velocity(P), "must be xarray's Dataset"),
    ],
)
def test_mistakes_are_one_line(make, said):
    with pytest.raises(cc.InputError, match=said) as mistake:
        make()
    assert "\n" not in str(mistake.value)
