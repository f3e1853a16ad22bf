"""Adaptive diagrams: the full grid's answer for part of its runs."""

from __future__ import annotations

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl import sweeps
from cellcrawl.sweeps import worker
from cellcrawl.sweeps.executors import InProcess
from cellcrawl.sweeps.planes import majority, plane
from cellcrawl.sweeps.worker import Outcome

COARSE = {
    "r_on": {"from": 10, "to": 60, "step": 10},
    "zeta_1": {"from": 400, "to": 600, "step": 50},
    "seed": [1, 2],
}
FINE = {
    "r_on": {"from": 10, "to": 60, "step": 1.25},
    "zeta_1": {"from": 400, "to": 600, "step": 6.25},
    "seed": [1, 2],
}


def mode_of(r_on: float, zeta_1: float) -> str:
    """Three regions with a curved and a straight border."""
    if (r_on - 38.0) ** 2 / 200.0 + (zeta_1 - 510.0) ** 2 / 3000.0 < 1.0:
        return "zigzag"
    return "gliding" if zeta_1 - 400.0 > 3.1 * r_on else "stationary"


@pytest.fixture
def made(monkeypatch):
    """Runs whose mode is `mode_of` their parameters; the list of those made."""
    runs = []

    def pretend(run, keep):
        runs.append(run)
        mode = mode_of(run.parameters.r_on, run.parameters.zeta_1)
        return Outcome({"status": "completed", "mode": mode, "confidence": 1.0})

    monkeypatch.setattr(worker, "execute", pretend)
    return runs


def test_the_refined_diagram_is_that_of_the_full_grid_for_part_of_its_runs(tmp_path, made):
    refined = plane(sweeps.refine(COARSE, tmp_path / "out", InProcess(), levels=3).table())
    full = cc.Grid(axes=FINE)
    assert len(made) < 0.45 * len(full)
    modes = majority(refined)
    wrong = 0
    for r_on in full.axes["r_on"]:
        for zeta_1 in full.axes["zeta_1"]:
            away = ((refined.x - r_on) / 1.25) ** 2 + ((refined.y - zeta_1) / 6.25) ** 2
            wrong += modes[int(np.argmin(away))] != mode_of(r_on, zeta_1)
    assert wrong == 0


def test_all_points_next_to_a_border_are_run(tmp_path, made):
    sweeps.refine(COARSE, tmp_path / "out", InProcess(), levels=3)
    ran = {(run.parameters.r_on, run.parameters.zeta_1) for run in made}
    axes = cc.Grid(axes=FINE).axes
    for i, r_on in enumerate(axes["r_on"][:-1]):
        for zeta_1 in axes["zeta_1"]:
            ahead = axes["r_on"][i + 1]
            if mode_of(r_on, zeta_1) != mode_of(ahead, zeta_1):
                assert {(r_on, zeta_1), (ahead, zeta_1)} <= ran


def test_a_second_time_nothing_is_run_and_more_levels_go_on(tmp_path, made):
    sweeps.refine(COARSE, tmp_path / "out", InProcess(), levels=1)
    one = len(made)
    sweeps.refine(COARSE, tmp_path / "out", InProcess(), levels=1)
    assert len(made) == one
    sweeps.refine(COARSE, tmp_path / "out", InProcess(), levels=2)
    two = len(made)
    assert two > one
    made.clear()
    sweeps.refine(COARSE, tmp_path / "fresh", InProcess(), levels=2)
    assert len(made) == two


def test_a_single_mode_is_not_refined(tmp_path, made):
    axes = {"r_on": [50, 60], "zeta_1": [400, 420]}
    sweeps.refine(axes, tmp_path / "out", InProcess(), levels=4)
    assert len(made) == 4


@pytest.mark.parametrize(
    "grid",
    [
        {"r_on": [10, 20], "seed": [1, 2]},
        {"r_on": [10, 20], "zeta_1": [500]},
        [{"r_on": 10, "zeta_1": 500}],
    ],
)
def test_a_grid_without_two_axes_cannot_be_refined(tmp_path, grid):
    with pytest.raises(cc.InputError, match="two parameters as axes"):
        sweeps.refine(grid, tmp_path / "out", InProcess())


def test_each_refined_run_is_that_of_a_plain_sweep(tmp_path):
    axes = {"r_on": [20, 60], "zeta_1": [400, 600]}
    refined = sweeps.refine(axes, tmp_path / "a", InProcess(), levels=1, t_end=12.0)
    keys = set(refined.table(["key"])["key"].to_pylist())
    full = {"r_on": [20, 40, 60], "zeta_1": [400, 500, 600]}
    plain = cc.sweep(full, tmp_path / "b", InProcess(), t_end=12.0)
    assert 4 < len(keys) <= 9
    assert keys <= set(plain.table(["key"])["key"].to_pylist())
