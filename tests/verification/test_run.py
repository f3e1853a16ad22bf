"""Running a verification: what fails is told, whatever fails, and nothing measured is lost."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

import cellcrawl as cc
from cellcrawl import verification
from cellcrawl.command_line.main import run as command
from cellcrawl.verification import Check, Result, registry, report
from cellcrawl.verification.check import AS_DOCUMENTED, FAILS, HOLDS, at_most, near


def sound(full: bool) -> Iterator[Result]:
    yield at_most("a small number", 1e-3, 1e-2)


def wrong(full: bool) -> Iterator[Result]:
    yield at_most("a number | with a bar", 2.0, 1.0)


def raising(full: bool) -> Iterator[Result]:
    yield at_most("a small number", 0.0, 1.0)
    raise RuntimeError("the solver broke down")


def stopping(full: bool) -> Iterator[Result]:
    raise KeyboardInterrupt
    yield


def dying(full: bool) -> Iterator[Result]:
    os._exit(7)
    yield


def long_only(full: bool) -> Iterator[Result]:
    yield Result("told whether the long version runs", "True", str(full), full)


def claims(full: bool) -> Iterator[Result]:
    yield Result("it holds", "yes", "yes", holds=True, where="Fig. 1")
    yield Result("it does not", "yes", "no", holds=False, known_not_to_hold="a reason")


SOUND, WRONG = Check("sound", "geometry", sound), Check("wrong", "geometry", wrong)
RAISING, CLAIMS = Check("raising", "orders", raising), Check("claims", "claims-linear", claims)


@pytest.fixture
def with_checks(monkeypatch):
    def use(*checks: Check) -> None:
        monkeypatch.setattr(registry, "CHECKS", checks)

    return use


def recorded(folder: Path) -> dict:
    return json.loads((folder / "verification.json").read_text("utf-8"))


def test_every_check_has_its_own_name_and_a_part_with_a_title():
    names = [check.name for check in verification.CHECKS]
    assert len(set(names)) == len(names)
    assert not set(names) & set(verification.PARTS)
    assert {check.part for check in verification.CHECKS} == set(verification.PARTS)


def test_a_broken_check_gives_exit_code_3_and_a_row(with_checks, tmp_path, capsys):
    with_checks(SOUND, WRONG)
    assert command(["verify", "--workers", "1", "--output", str(tmp_path)]) == 3
    said = capsys.readouterr().out
    assert "FAILS  a number | with a bar" in said
    assert "expected at most 1; measured 2" in said
    assert said.count("ok  ") == 1
    content = recorded(tmp_path)
    assert content["status"] == "failed"
    assert content["counts"] == {HOLDS: 1, AS_DOCUMENTED: 0, FAILS: 1}
    page = (tmp_path / "verification.md").read_text("utf-8")
    assert r"| a number \| with a bar | at most 1 | 2 | **fails** |" in page


def test_what_a_check_raises_is_its_result_and_the_others_go_on(with_checks, tmp_path, capsys):
    with_checks(RAISING, SOUND)
    assert command(["verify", "--workers", "1", "--output", str(tmp_path)]) == 3
    rows = recorded(tmp_path)["results"]
    assert [row["passed"] for row in rows] == [False, True]
    assert "the solver broke down" in rows[0]["measured"]
    assert "Traceback" not in capsys.readouterr().err


def test_all_that_holds_gives_exit_code_0_and_a_complete_record(with_checks, tmp_path):
    with_checks(SOUND, CLAIMS)
    assert command(["verify", "--workers", "1", "--output", str(tmp_path / "new")]) == 0
    content = recorded(tmp_path / "new")
    assert content["status"] == "passed"
    assert content["machine"]["python"]
    assert set(content["check_seconds"]) == {"sound", "claims"}
    told = {"part", "check", "what", "expected", "measured", "holds", "where"}
    told |= {"known_not_to_hold", "note", "values", "passed", "verdict"}
    assert all(set(row) == told for row in content["results"])
    assert content["results"][0]["values"] == {"found": 1e-3}
    assert [path.name for path in (tmp_path / "new").iterdir() if path.name.startswith(".")] == []


def test_a_claim_known_not_to_hold_fails_only_once_it_does():
    unless = {"known_not_to_hold": "a reason"}
    as_told = Result("it", "yes", "no", holds=False, **unless)
    changed = Result("it", "yes", "yes", holds=True, **unless)
    assert (as_told.passed, as_told.verdict) == (True, AS_DOCUMENTED)
    assert (changed.passed, changed.verdict) == (False, FAILS)


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_what_is_not_a_number_never_holds(value):
    assert not at_most("it", value, 1.0).holds
    assert not near("it", value, 1.0, 0.1).holds


def test_ctrl_c_keeps_what_was_measured(with_checks, tmp_path, capsys):
    with_checks(SOUND, Check("stopping", "geometry", stopping), WRONG)
    assert command(["verify", "--workers", "1", "--output", str(tmp_path)]) == 130
    content = recorded(tmp_path)
    assert content["status"] == "interrupted"
    assert [row["check"] for row in content["results"]] == ["sound"]
    assert "interrupted: 1 hold" in capsys.readouterr().out


def test_ctrl_c_ends_the_worker_processes(tmp_path):
    program = [sys.executable, "-m", "cellcrawl", "verify", "--workers", "2", "--output", "out"]
    process = subprocess.Popen(
        [*program, "--only", "curves", "--only", "growth"],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    assert "curves" in process.stdout.readline()
    process.send_signal(signal.SIGINT)
    began = time.monotonic()
    rest, _ = process.communicate(timeout=120)
    assert process.returncode == 130
    assert "interrupted" in rest
    assert recorded(tmp_path / "out")["status"] == "interrupted"
    # the pipe is closed only when no worker holds it any more
    assert time.monotonic() - began < 60


def test_workers_find_what_one_process_finds():
    checks = (SOUND, CLAIMS, WRONG, RAISING)
    alone, shared = (verification.run(checks=checks, workers=n) for n in (1, 2))
    assert [outcome.results for outcome in alone] == [outcome.results for outcome in shared]


def test_a_worker_that_dies_fails_its_check_and_hangs_nothing():
    (outcome,) = verification.run(checks=[Check("dying", "geometry", dying)], workers=2)
    assert not outcome.passed
    assert "its process ended" in outcome.results[0].measured


def test_names_choose_parts_and_checks():
    checks = (SOUND, WRONG, CLAIMS)
    names = [o.check for o in verification.run(["geometry"], checks=checks)]
    assert names == ["sound", "wrong"]
    assert [o.check for o in verification.run(["claims"], checks=checks)] == ["claims"]
    with pytest.raises(cc.InputError, match="did you mean 'geometry'"):
        verification.run(["geometri"], checks=checks)


def test_long_checks_run_in_the_long_version_or_by_name():
    checks = (SOUND, Check("long", "orders", long_only, only_in_full=True))
    assert [o.check for o in verification.run(checks=checks)] == ["sound"]
    assert verification.run(checks=checks, full=True)[1].passed
    assert [o.check for o in verification.run(["long"], checks=checks)] == ["long"]


def test_a_mistake_is_one_line(capsys):
    assert command(["verify", "--only", "growht"]) == 2
    assert "did you mean 'growth'" in capsys.readouterr().err


def test_a_folder_that_cannot_be_written_is_one_line(with_checks, tmp_path, capsys):
    with_checks(SOUND)
    (tmp_path / "taken").write_text("a file")
    assert command(["verify", "--workers", "1", "--output", str(tmp_path / "taken")]) in (2, 3)
    assert len(capsys.readouterr().err.strip().splitlines()) == 1


def test_the_page_in_the_documentation_is_that_of_the_recorded_run():
    root = Path(__file__).resolve().parents[2]
    content = json.loads((root / "benchmarks" / "results" / "verification.json").read_text("utf-8"))
    assert content["status"] == "passed"
    assert content["full"]
    assert (root / "docs" / "verification.md").read_text("utf-8") == report.page(content)
    assert (root / "docs" / "claims.md").read_text("utf-8") == report.claims_page(content)


def test_the_recorded_run_has_every_check():
    root = Path(__file__).resolve().parents[2]
    content = json.loads((root / "benchmarks" / "results" / "verification.json").read_text("utf-8"))
    assert {row["check"] for row in content["results"]} == {c.name for c in verification.CHECKS}
