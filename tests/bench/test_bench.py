"""The benchmarks: what they compare is comparable, and what they write can be read."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

from cellcrawl.bench import machine, microscope, rivals
from cellcrawl.bench.cases import Case, errors
from cellcrawl.bench.references import References, computed
from cellcrawl.bench.uniform_grid import UniformGrid
from cellcrawl.bench.work_precision import Row, prepare, speed_up
from cellcrawl.command_line.main import run
from cellcrawl.parameters.paper_cells import PAPER_MODES


def row(solver: str, miss: float, seconds: float) -> Row:
    return Row("case", 5.0, solver, "", miss, miss, 0.0, 0.0, 0.0, seconds, 256)


def test_errors_are_the_largest_over_all_times():
    truth = np.array([[2.0, 900.0, 3.0, 1.0, 1.0]] * 3)
    found = truth.copy()
    found[0, 0] = 2.002
    found[1, 1], found[1, 2] = 909.0, 2.97
    found[2, 3:] = 1.003, 1.004
    miss = errors(found, truth)
    assert miss == pytest.approx((1e-3, 1e-2, 1e-2, 5e-3))
    assert miss.largest == pytest.approx(5e-3)  # of length and centroid
    found[1, 4] = math.nan
    assert errors(found, truth).length == math.inf


def test_a_long_run_is_measured_over_its_second_half_a_short_one_at_its_end():
    assert Case(26, 600, t_end=5.0).times == (5.0,)
    assert Case(26, 600, t_end=100.0).times == tuple(range(50, 101, 5))


def test_references_are_read_back_and_others_computed(tmp_path):
    case = Case(26, 600, t_end=0.3)
    recorded = {"r_on": 26, "zeta_1": 600, "elasticity": "printed", "D": 0.05, "random": False}
    values = {name: [7.0] for name in ("length", "tension", "area", "centroid_x", "centroid_y")}
    path = tmp_path / "references.json"
    machine.write(path, {"references": [{**recorded, "t_end": 0.3, "times": [0.3], **values}]})
    assert np.all(References(path).of(case) == 7.0)
    other = Case(26, 600, "consistent", t_end=0.3)
    assert np.array_equal(References(path).of(other), computed(other))


@pytest.mark.parametrize("content", ["{}", "no json", '{"references": [{"r_on": 26}]}', None])
def test_references_that_cannot_be_read_are_one_line(tmp_path, content, capsys):
    path = tmp_path / "references.json"
    if content is not None:
        path.write_text(content)
    assert run(["bench", "targets", "--references", str(path)]) == 2
    assert str(path) in capsys.readouterr().err


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
    system = UniformGrid(case.start(1024), case.conditions, 192)
    found = rivals.solved(solve, system, (0.2, case.t_end), 1e-8)
    assert found.shape == (2, 5)
    assert max(errors(found[1:], computed(case))) < 1e-5


def test_solvers_are_timed_on_the_same_case():
    case = Case(26, 600, t_end=0.5)
    truth = computed(case)
    assert max(errors(prepare("adaptive", case, rtol=1e-6)()[0], truth)) < 1e-6
    assert max(errors(prepare("paper", case, nodes=400, dt=1e-3)()[0], truth)) < 1e-2


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


@pytest.mark.parametrize("point", [(16, 600), (26, 600)])
def test_a_cell_seen_through_the_microscope_is_the_cell_of_the_run(point):
    seen = microscope.see(point)
    assert seen.mode_seen == seen.mode == PAPER_MODES[point]
    assert seen.speed_low < seen.speed < seen.speed_high
    assert seen.circularity_seen == pytest.approx(seen.circularity, abs=0.04)
    if seen.mode == "zigzag":
        assert seen.period_seen == pytest.approx(seen.period, rel=0.05)
