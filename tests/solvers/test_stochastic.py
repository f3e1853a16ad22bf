"""The stochastic solver: its random numbers, its kicks, the variances of theory, its restart."""

from __future__ import annotations

import itertools
import math
from statistics import NormalDist

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.solvers.stochastic.normals import fill_normals, philox
from cellcrawl.solvers.stochastic.step import CUT, TALLY, WEAKENED, kicked
from cellcrawl.sweeps.executors import InProcess
from cellcrawl.verification import noise
from cellcrawl.verification.restart import different_values, fixed_attributes
from tests.conftest import check_start

CELL = cc.Parameters(r_on=26, zeta_1=600)
HELD = cc.Parameters(r_on=26, zeta_1=0)  # the off-rate does not ask for the linkers
SMALL = {"solver": "stochastic", "nodes": 64}


def normals(seed: int, step: int, nodes: int) -> np.ndarray:
    out = np.empty(nodes)
    fill_normals(seed, step, out)
    return out


@pytest.mark.parametrize(
    ("counter", "key", "told"),
    [
        (
            (0, 0, 0, 0),
            (0, 0),
            "6627e8d5 e169c58d bc57ac4c 9b00dbd8",
        ),
        (
            (0xFFFFFFFF,) * 4,
            (0xFFFFFFFF,) * 2,
            "408f276d 41c83b0e a20bc7c6 6d5451fd",
        ),
        (
            (0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344),
            (0xA4093822, 0x299F31D0),
            "d16cfe09 94fdcceb 5001e420 24126ea1",
        ),
    ],
)
def test_random_words_are_those_of_the_published_generator(counter, key, told):
    # known answers of Random123, https://github.com/DEShawResearch/random123
    with np.errstate(over="ignore"):
        words = philox(*(np.uint64(word) for word in (*counter, *key)))
    assert " ".join(f"{int(word):08x}" for word in words) == told


def test_normals_are_normal_and_independent_between_steps_nodes_and_seeds():
    drawn = np.array([normals(7, step, 101) for step in range(2000)])
    error = 1.0 / math.sqrt(drawn.size)
    assert abs(drawn.mean()) < 4.0 * error
    assert abs(drawn.var() - 1.0) < 4.0 * math.sqrt(2.0) * error
    assert abs((drawn**4).mean() - 3.0) < 4.0 * math.sqrt(96.0) * error
    other = np.array([normals(8, step, 101) for step in range(2000)])
    for shifted in (np.roll(drawn, 1, 0), np.roll(drawn, 1, 1), np.roll(drawn, 2, 1), other):
        assert abs((drawn * shifted).mean()) < 4.0 * error
    assert np.array_equal(normals(7, 3, 101)[:64], normals(7, 3, 64))
    assert not np.array_equal(normals(2**62, 0, 8), normals(0, 0, 8))


@pytest.mark.parametrize(
    ("mean", "top", "variance"),
    [(0.4, 1.0, 1e-4), (0.02, 1.0, 1e-3), (0.02, 1.1, 0.01), (0.97, 1.0, 0.02), (0.5, 1.2, 0.3)],
)
def test_a_kick_keeps_its_mean_and_variance_and_stays_in_its_range(mean, top, variance):
    tally = np.zeros(TALLY, np.int64)
    even = (np.arange(20_000) + 0.5) / 20_000
    spread = [NormalDist().inv_cdf(u) for u in even]
    found = np.array([kicked(mean, top, variance, z, tally) for z in spread])
    assert found.min() >= 0.0
    assert found.max() <= top
    assert found.mean() == pytest.approx(mean, abs=2e-4)
    assert found.var() == pytest.approx(variance, rel=5e-3)
    assert tally[WEAKENED] == tally[CUT] == 0


@pytest.mark.parametrize(("nodes", "dt"), [(64, 1e-2), (128, 2e-3)])
def test_waves_of_linkers_have_the_power_of_theory_on_any_grid_and_step(nodes, dt):
    found = noise.wave_ratio(HELD, 200.0, 8, 20.0, nodes=nodes, dt=dt)
    assert abs(found.value - 1.0) < 4.0 * found.error + 0.005
    assert found.error < 0.02


def test_the_mean_over_an_arc_varies_as_theory_says_where_bonds_are_few():
    # a scheme that cuts n off at 0 and 1 loses nine parts in a hundred here
    sharp = HELD.replace(D=0.001)
    found = noise.arc_ratio(sharp, 200.0, 16, 40.0, nodes=128, dt=2e-3)
    assert abs(found.value - 1.0) < 4.0 * found.error + 0.005
    assert found.error < 0.012


def test_the_bound_fraction_stays_between_0_and_1_without_a_bias():
    run = cc.simulate(HELD, 40.0, start=cc.PerturbedCircle(), bonds=40.0, **SMALL)
    n = run["bound_fraction"].values[10:]
    assert n.min() >= 0.0
    assert n.max() <= 1.0
    assert n.mean() == pytest.approx(HELD.n_bar, rel=0.01)


def test_a_noisy_cell_at_rest_moves_as_fast_as_theory_says():
    resting = cc.Parameters(r_on=60, zeta_1=500)
    found = noise.speed_ratio(resting, 2e6, 100.0, nodes=32, dt=2e-3)
    assert abs(found.value - 1.0) < 4.0 * found.error + 0.01
    assert found.error < 0.05


def test_with_many_bonds_it_is_the_deterministic_scheme():
    run = {"start": check_start(CELL), "save_every": 0.5, **SMALL}
    without = cc.simulate(CELL, 1.0, bonds=1e300, **run)
    again = cc.simulate(CELL, 1.0, bonds=1e300, noise_seed=9, **run)
    assert different_values(without, again) == 0
    sizes = [1e18, 1e14, 1e10]
    apart = [
        float(abs(cc.simulate(CELL, 1.0, bonds=b, **run)["x"] - without["x"]).max()) for b in sizes
    ]
    assert apart[2] < 1e-3
    for less, more in itertools.pairwise(apart):  # with the root of their number
        assert more / less == pytest.approx(100.0, rel=0.2)


def test_without_noise_it_is_of_second_order():
    run = {"start": check_start(CELL), "save_every": 1.0, "solver": "stochastic", "bonds": 1e300}
    true = cc.simulate(CELL, 1.0, start=check_start(CELL), rtol=1e-8)
    errors = [
        abs(float(cc.simulate(CELL, 1.0, nodes=n, dt=dt, **run)["length"][-1] - true["length"][-1]))
        for n, dt in ((128, 4e-3), (256, 2e-3))
    ]
    assert math.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.3)


@pytest.mark.parametrize("halfway", [0.5, 0.3337])
def test_a_resumed_noisy_run_has_the_bits_of_one_in_one_go(tmp_path, halfway):
    schedule = cc.Schedule({"r_on": [(0.2, 26.0), (0.4, 40.0), (0.7, 40.0), (0.7, 20.0)]})
    run = {**SMALL, "schedule": schedule, "bonds": 300.0, "noise_seed": 5}
    path = tmp_path / "run.nc"
    cc.simulate(CELL, halfway, output=path, **run).close()
    resumed = cc.resume(path, 1.0)
    straight = cc.simulate(CELL, 1.0, **run)
    assert different_values(resumed, straight) == 0
    assert fixed_attributes(resumed) == fixed_attributes(straight)
    assert '"noise_seed": 5' in resumed.attrs["solver_options"]


def test_a_seed_gives_its_run_and_how_often_it_is_saved_changes_nothing():
    first = cc.simulate(CELL, 0.5, **SMALL)
    often = cc.simulate(CELL, 0.5, save_every=0.05, **SMALL)
    other = cc.simulate(CELL, 0.5, noise_seed=2, **SMALL)
    assert np.array_equal(first["x"].values, often["x"].values[::2])
    assert abs(first["x"] - other["x"]).max() > 1e-4


def test_a_record_between_two_steps_varies_as_one_at_a_step():
    found = noise.wave_ratio(HELD, 200.0, 8, 15.0, nodes=32, dt=0.02)  # most lie between two
    assert abs(found.value - 1.0) < 4.0 * found.error + 0.005


@pytest.mark.slow  # compiles two solvers for them
def test_it_knows_laws_and_surroundings():
    around = cc.surroundings.Island(radius=1.1, outside=0.5, edge=0.3)
    world = {"laws": cc.laws.Stiffness(chi=0.8), "surroundings": around}
    start = check_start(CELL)
    noisy = {**SMALL, "nodes": 256, "bonds": 1e300}
    run = cc.simulate(CELL, 1.0, start=start, **world, **noisy)
    true = cc.simulate(CELL, 1.0, start=start, **world)
    assert float(run["length"][-1]) == pytest.approx(float(true["length"][-1]), rel=1e-3)
    assert float(run["centroid_x"][-1]) == pytest.approx(float(true["centroid_x"][-1]), abs=1e-3)


def test_the_tension_goes_with_the_area():
    for elasticity in ("printed", "consistent"):
        p = CELL.replace(elasticity=elasticity)
        run = cc.simulate(p, 0.5, bonds=500.0, **SMALL)
        assert run.attrs["status"] == "completed"
        off = run["tension"] - p.tension_rate * run["area"]
        assert float(np.ptp(off.values)) < 1e-9 * p.tension_rate


def test_sweeps_go_over_seeds_of_the_noise(tmp_path):
    grid = {"noise_seed": [1, 2], "r_on": [26]}
    sweep = cc.sweep(
        grid, tmp_path / "seeds", InProcess(), solver="stochastic", nodes=64, t_end=0.2,
        keep="tracks",
    )  # fmt: skip
    assert [run.options["noise_seed"] for run in sweep.grid] == [1, 2]
    ends = [float(sweep.run(noise_seed=k)["centroid_x"][-1]) for k in (1, 2)]
    assert ends[0] != ends[1]


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        ({"bonds": 0.0}, "bonds"),
        ({"bonds": math.inf}, "bonds"),
        ({"noise_seed": -1}, "noise_seed"),
        ({"noise_seed": 1.5}, "noise_seed"),
        ({"noise_sed": 1}, "noise_seed"),
        ({"dt": 0.5}, "dt"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(wrong, told):
    with pytest.raises(cc.InputError, match=told) as refused:
        cc.simulate(CELL, 0.1, **SMALL, **wrong)
    assert "\n" not in str(refused.value)
