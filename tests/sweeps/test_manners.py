"""Sweeps in the hands of users: moved, extended, empty, asked for single runs, inside a pool."""

from __future__ import annotations

import concurrent.futures as futures
import multiprocessing
import os
import subprocess
import sys
import types

import pytest

import cellcrawl as cc
from cellcrawl.sweeps.executors import InProcess
from cellcrawl.sweeps.grid import united

QUICK = {"t_end": 0.1, "options": {"rtol": 1e-2}}


def quick(grid, output, **options):
    return cc.sweep(grid, output, InProcess(), **{**QUICK, **options})


def test_an_opened_sweep_stays_where_it_is(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    quick({"r_on": [20, 30]}, "out")
    opened = cc.open_sweep("out")
    os.chdir(tmp_path.parent)
    assert len(opened.table()) == 2


def test_pandas_has_the_order_of_the_grid(tmp_path):
    quick({"r_on": [30]}, tmp_path / "out")
    sweep = quick({"r_on": [40, 20, 30], "seed": [2, 1]}, tmp_path / "out", extend=True)
    frame = cc.open_sweep(sweep.path, cc.Grid(axes={"r_on": [40, 20, 30], "seed": [2, 1]}, **QUICK))
    frame = frame.to_pandas()
    assert frame["r_on"].tolist() == [40, 40, 20, 20, 30, 30]
    assert frame["seed"].tolist() == [2, 1, 2, 1, 2, 1]


def test_an_extended_folder_holds_the_runs_of_all_its_grids(tmp_path):
    first, more = {"r_on": [20, 30], "D": [0.1]}, {"D": [0.1], "r_on": [40]}
    quick(first, tmp_path / "out")
    sweep = quick(more, tmp_path / "out", extend=True)
    assert sweep.to_dataset()["r_on"].values.tolist() == [20, 30, 40]
    assert set(sweep.to_dataset()["status"].values.ravel()) == {"completed"}
    assert sweep.status()[:2] == (3, 3)
    assert cc.open_sweep(sweep.path).to_pandas()["r_on"].tolist() == [20, 30, 40]
    for grid in (first, more):  # neither is another grid
        assert quick(grid, tmp_path / "out").status().done == 3


def test_grids_that_share_too_little_are_united_as_points():
    one = cc.Grid(axes={"r_on": [20, 30]}, t_end=1.0)
    other = cc.Grid(axes={"D": [0.1]}, t_end=2.0, start=cc.Eigenmode(2), options={"rtol": 1e-3})
    runs = [run.describe() for run in united([one, other])]
    asked = [run.describe() for grid in (one, other) for run in grid]
    assert runs == asked


@pytest.mark.parametrize("grid", [{}, [], [{}], {"axes": {}}, {"points": []}])
def test_a_grid_without_runs_is_refused(grid, tmp_path):
    with pytest.raises(cc.InputError, match="empty"):
        quick(grid, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_run_is_found_by_its_start_and_schedule(tmp_path):
    starts = [cc.Eigenmode(2), cc.Eigenmode(3)]
    schedule = cc.Schedule({"D": [(0.0, 0.1)]})
    grid = {"start": starts, "r_on": [20], "schedule": [schedule]}
    sweep = quick(grid, tmp_path / "out", keep="tracks")
    kept = sweep.run(start=cc.Eigenmode(k=3), r_on=20, schedule=schedule)
    assert cc.Eigenmode(3).describe()["k"] == 3
    assert '"k": 3' in kept.attrs["start"]
    with pytest.raises(cc.InputError, match="0 runs match"):
        sweep.run(start=cc.Eigenmode(k=4))
    with pytest.raises(cc.InputError, match="one value"):
        sweep.run(r_on=[20, 30])


def sweep_in_a_worker(folder):
    return len(cc.sweep({"r_on": [20, 30]}, folder, **QUICK).table())


def test_a_worker_of_a_pool_makes_the_runs_itself(tmp_path):
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.apply(sweep_in_a_worker, (str(tmp_path / "out"),)) == 2


def test_threads_will_do(tmp_path):
    with futures.ThreadPoolExecutor(1) as threads:
        assert len(cc.sweep({"r_on": [20]}, tmp_path / "out", threads, **QUICK).table()) == 1


def test_a_start_of_a_session_is_refused_before_a_worker_starts(tmp_path):
    session = f"""
import dataclasses, sys
import cellcrawl as cc

@dataclasses.dataclass(frozen=True)
class Mine:
    seed: int = 1
    def state(self, parameters, nodes):
        return cc.RandomPerturbation(self.seed).state(parameters, nodes)
    def describe(self):
        return {{"kind": "Mine", "seed": self.seed}}

try:
    cc.sweep({{"r_on": [20]}}, {str(tmp_path / "out")!r}, start=Mine(), t_end=0.1)
except cc.InputError as error:
    print(error)
"""
    done = subprocess.run(
        [sys.executable], input=session, capture_output=True, text=True, cwd=tmp_path
    )
    assert done.stderr == ""
    assert "in a file of its own" in done.stdout


@pytest.mark.parametrize("address", ["", "x", "node 1:8786", "x" * 5000])
def test_what_is_no_address_is_not_waited_for(address, tmp_path):
    with pytest.raises(cc.InputError, match="address of a Dask scheduler"):
        cc.sweep({"r_on": [20]}, tmp_path / "out", address, **QUICK)


def test_a_start_of_a_function_or_of_a_module_without_a_file_is_refused_too(tmp_path):
    class Inside(cc.RandomPerturbation):
        pass

    nowhere = types.ModuleType("nowhere")
    exec("import cellcrawl\nclass Start(cellcrawl.RandomPerturbation): pass", vars(nowhere))
    for start in (Inside(), nowhere.Start()):
        with pytest.raises(cc.InputError, match="in a file of its own"):
            cc.sweep({"r_on": [20]}, tmp_path / "out", start=start, t_end=0.1)
