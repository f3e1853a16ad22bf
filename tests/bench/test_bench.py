"""The benchmarks: what they compare is comparable, and what they write can be read."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

from cellcrawl.bench import machine, rivals
from cellcrawl.bench.cases import Case, error, reference
from cellcrawl.bench.work_precision import Row, prepare, speed_up
from cellcrawl.command_line.main import run


def row(solver: str, miss: float, seconds: float) -> Row:
    return Row("case", 5.0, solver, "", miss, seconds, 256)


def test_error_is_the_larger_of_length_and_centroid():
    truth = np.array([2.0, 1.0, 1.0])
    assert error(np.array([2.002, 1.0, 1.0]), truth) == pytest.approx(1e-3)
    assert error(np.array([2.0, 1.003, 1.004]), truth) == pytest.approx(5e-3)
    assert error(np.array([math.nan, 1.0, 1.0]), truth) == math.inf


def test_speed_up_compares_at_equal_error():
    # adaptive: time 1e-3 / error; the other: ten times that
    rows = [row("adaptive", e, 1e-3 / e) for e in (1e-2, 1e-4, 1e-6)]
    rows += [row("other", e, 1e-2 / e) for e in (3e-3, 3e-5)]
    assert speed_up(rows, "other", 1e-4) == pytest.approx(10.0)
    assert math.isnan(speed_up(rows, "other", 1e-6))  # it never gets there


def test_a_run_beaten_in_both_does_not_count():
    rows = [row("adaptive", 1e-4, 1.0), row("other", 1e-4, 4.0), row("other", 1e-3, 100.0)]
    assert speed_up(rows, "other", 1e-4) == pytest.approx(4.0)


@pytest.mark.parametrize("name", ["SciPy LSODA", "CVODE BDF+GMRES"])
def test_rivals_solve_the_same_equations(name):
    solve = rivals.available().get(name)
    if solve is None:
        pytest.skip(f"{name} is not installed")
    case = Case(26, 600, t_end=0.5)
    system = rivals.FixedGrid(case, 192)
    found = system.summary(case.t_end, solve(system, case.t_end, 1e-8))
    assert error(found, reference(case)) < 1e-5


def test_solvers_are_timed_on_the_same_case():
    case = Case(26, 600, t_end=0.5)
    truth = reference(case)
    assert error(prepare("adaptive", case, rtol=1e-6)()[0], truth) < 1e-6
    assert error(prepare("paper", case, nodes=400, dt=1e-3)()[0], truth) < 1e-2


def test_results_are_valid_json_with_the_machine(tmp_path):
    machine.write(
        tmp_path / "a" / "results.json", {"rows": [{"x": math.nan, "y": (1.0, math.inf)}]}
    )
    content = json.loads((tmp_path / "a" / "results.json").read_text())
    assert content["rows"] == [{"x": None, "y": [1.0, None]}]
    assert content["machine"]["numpy"] == np.__version__


def test_an_unknown_benchmark_is_one_line(capsys):
    assert run(["bench", "startupp"]) == 2
    assert "did you mean 'startup'" in capsys.readouterr().err


def test_named_points_are_measured_as_they_are_and_with_less(monkeypatch):
    from cellcrawl.bench import modes

    monkeypatch.setattr(modes, "PAPER_MODES", {(56, 560): "gliding"})
    rows = list(modes.measure_points(quick=True))
    assert {row.most for row in rows} == {"gliding"}
    assert all(row.agrees for row in rows)
    assert {"as it is", "track alone", "to t = 50"} <= {row.condition for row in rows}


def test_kinds_of_synthetic_tracks_are_counted():
    from cellcrawl.bench import modes

    rows = list(modes.measure_kinds(quick=True))
    assert {row.mode for row in rows} == {"gliding", "rotational", "zigzag", "other", "stationary"}
    for row in rows:
        assert row.right + row.wrong_and_sure <= row.tracks
        assert row.right >= 0.8 * row.tracks
