"""Grids: which runs they stand for, and mistakes told in one line."""

from __future__ import annotations

import itertools
import pickle

import pytest

import cellcrawl as cc
from cellcrawl.sweeps.grid import as_grid
from cellcrawl.sweeps.identity import run_key


def test_axes_give_every_combination_the_last_fastest():
    grid = cc.Grid(axes={"r_on": [20, 30], "zeta_1": [500, 600], "seed": [1, 2, 3]})
    got = [(run.parameters.r_on, run.parameters.zeta_1, run.start.seed) for run in grid]
    assert got == list(itertools.product([20, 30], [500, 600], [1, 2, 3]))
    assert [grid.run(i) for i in range(len(grid))] == list(grid)


def test_points_are_combined_with_the_axes():
    points = [{"r_on": 16, "zeta_1": 600}, {"r_on": 56, "zeta_1": 560}]
    grid = cc.Grid(points=points, axes={"seed": [1, 2]})
    got = [(run.parameters.r_on, run.parameters.zeta_1, run.start.seed) for run in grid]
    assert got == [(16, 600, 1), (16, 600, 2), (56, 560, 1), (56, 560, 2)]
    assert grid.shape == (2, 2)


def test_anything_can_be_an_axis():
    jump = cc.Schedule({"r_on": [(25.0, 16.0), (25.0, 30.0)]})
    start = cc.Eigenmode(k=3)
    grid = cc.Grid(
        axes={
            "start": [start, {"kind": "RandomPerturbation", "seed": 4}],
            "schedule": [{}, jump],
            "rtol": [1e-3, 1e-5],
            "t_end": [10.0, 20.0],
            "elasticity": ["printed", "consistent"],
        }
    )
    last = grid.run(len(grid) - 1)
    assert last.start == cc.RandomPerturbation(seed=4)
    assert last.schedule == jump
    assert last.options == {"rtol": 1e-5}
    assert (last.t_end, last.parameters.elasticity) == (20.0, "consistent")
    assert grid.run(0).start == start


@pytest.mark.parametrize(
    ("given", "values"),
    [
        ({"from": 10, "to": 60, "step": 10}, [10, 20, 30, 40, 50, 60]),
        ({"from": 60, "to": 40, "step": -10}, [60, 50, 40]),
        ({"from": 1, "to": 2, "count": 3}, [1.0, 1.5, 2.0]),
        (26, [26]),
    ],
)
def test_ranges_include_both_ends(given, values):
    assert list(cc.Grid(axes={"r_on": given}).axes["r_on"]) == values


def test_steps_of_a_tenth_are_the_decimals_one_writes():
    sizes = cc.Grid(axes={"D": {"from": 0.1, "to": 0.5, "step": 0.1}}).axes["D"]
    assert list(sizes) == [0.1, 0.2, 0.3, 0.4, 0.5]


TOML = """
[parameters]
D = 0.01
[axes]
r_on = { from = 20, to = 30, step = 5 }
seed = [1, 2]
[[points]]
zeta_1 = 500
[[points]]
zeta_1 = 600
h = 0.02
[schedule]
sigma_c = [[1.0, 100.0], [2.0, 50.0]]
[run]
t_end = 12
rtol = 1e-3
"""


def test_a_toml_grid_is_the_same_as_one_made_in_python(tmp_path):
    file = tmp_path / "grid.toml"
    file.write_text(TOML)
    made = cc.Grid(
        parameters=cc.Parameters(D=0.01),
        axes={"r_on": [20, 25, 30], "seed": [1, 2]},
        points=[{"zeta_1": 500}, {"zeta_1": 600, "h": 0.02}],
        schedule=cc.Schedule({"sigma_c": [(1.0, 100.0), (2.0, 50.0)]}),
        t_end=12.0,
        options={"rtol": 1e-3},
    )
    read = cc.Grid.from_toml(file)
    assert list(read) == list(made)
    assert read.digest == made.digest
    again = cc.Grid.from_dict(made.describe())
    assert [run_key(run, "rows") for run in again] == [run_key(run, "rows") for run in made]


def test_a_grid_is_a_mapping_a_list_or_a_file(tmp_path):
    (tmp_path / "g.toml").write_text("[axes]\nr_on = [20, 30]\n")
    runs = list(cc.Grid(axes={"r_on": [20, 30]}))
    assert list(as_grid({"r_on": [20, 30]})) == runs
    assert list(as_grid([{"r_on": 20}, {"r_on": 30}])) == runs
    assert list(as_grid(tmp_path / "g.toml")) == runs
    assert list(as_grid(cc.Grid(axes={"r_on": [20, 30]}))) == runs
    assert as_grid({"r_on": [20]}, t_end=3.0).run(0).t_end == 3.0


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: cc.Grid(axes={"r_onn": [1]}), "did you mean 'r_on'"),
        (lambda: cc.Grid(axes={"r_on": []}), "axis r_on of the grid is empty"),
        (lambda: cc.Grid(axes={"r_on": [20, 20.0]}), "20.0 twice"),
        (lambda: cc.Grid(axes={"r_on": [20, 999]}), "r_on = 999 is out of range"),
        (lambda: cc.Grid(axes={"r_on": ["x"]}), "wrong type"),
        (lambda: cc.Grid(axes={"r_on": {"from": 1, "to": 2}}), "either step or count"),
        (lambda: cc.Grid(axes={"r_on": {"from": 1, "to": 2, "step": 0.3}}), "do not lead"),
        (lambda: cc.Grid(axes={"r_on": {"from": 1, "to": 2, "step": 0}}), "do not lead"),
        (lambda: cc.Grid(axes={"r_on": {"from": 2, "upto": 3}}), "upto"),
        (lambda: cc.Grid(axes={"solver": ["euler"]}), "solver = 'euler' is not known"),
        (lambda: cc.Grid(axes={"dt": [1e-3]}), "no option 'dt'"),
        (lambda: cc.Grid(axes={"seed": [1.5]}), "seed = 1.5"),
        (lambda: cc.Grid(axes={"seed": [1]}, start=cc.Eigenmode(k=2)), "random start"),
        (lambda: cc.Grid(axes={"seed": [1]}, points=[{"seed": 2}]), "both an axis and"),
        (lambda: cc.Grid(points=[{}]), "the grid is empty"),
        (lambda: cc.Grid(points=[{"zeta": 2}]), "zeta_1"),
        (lambda: cc.Grid.from_toml("[axes]\n"), "needs \\[axes\\]"),
        (lambda: cc.Grid.from_toml("[axis]\nr_on = [1]\n"), "did you mean 'axes'"),
        (lambda: cc.Grid.from_toml("[axes]\nr_on = [20]\n[run]\ntend = 3\n"), "t_end"),
        (lambda: cc.Grid.from_toml("[axes\n"), "not valid TOML"),
        (lambda: as_grid({"r_on": [20]}, tend=3.0), "t_end"),
        (lambda: as_grid(3), "a grid is a table"),
    ],
)
def test_mistakes_in_a_grid_are_told_in_one_line(make, says):
    with pytest.raises(cc.InputError, match=says) as caught:
        make()
    assert "\n" not in str(caught.value)


def test_runs_differ_in_key_exactly_if_they_differ_in_content():
    grid = cc.Grid(
        axes={"r_on": [20, 30], "seed": [1, 2], "t_end": [1.0, 2.0], "rtol": [1e-4, 1e-5]}
    )
    keys = [run_key(run, "rows") for run in grid]
    assert len(set(keys)) == len(grid)
    assert keys == [run_key(run, "rows") for run in grid]
    assert run_key(grid.run(0), "tracks") not in keys
    usual = cc.Grid(axes={"r_on": [20], "seed": [1], "t_end": [1.0]}).run(0)
    assert run_key(usual, "rows") == keys[0]  # rtol = 1e-4 is what is usual


def test_starts_from_runs_are_told_apart_by_their_state():
    first = cc.simulate(t_end=0.1)
    second = cc.simulate(t_end=0.2)
    keys = {
        run_key(run, "rows")
        for run in cc.Grid(axes={"start": [cc.FromRun(first), cc.FromRun(second)]})
    }
    assert len(keys) == 2


def test_descriptions_travel_to_other_processes():
    grid = cc.Grid(
        axes={
            "start": [cc.PerturbedCircle(radius={1: (0.01, 0.0)}), cc.Eigenmode(k=2)],
            "schedule": [{"r_on": [[1.0, 20.0]]}],
        }
    )
    for run in grid:
        assert run_key(pickle.loads(pickle.dumps(run)), "rows") == run_key(run, "rows")
