"""What people in the field bring, and the right answers: tests/data/cases/expected.json."""

from __future__ import annotations

import csv
import importlib.util
import json
import warnings
from pathlib import Path

import pytest

import cellcrawl as cc
from cellcrawl.command_line.main import run

FOLDER = Path(__file__).parents[1] / "data" / "cases"
CASES = json.loads((FOLDER / "expected.json").read_text(encoding="utf-8"))["cases"]


def marked(name):
    marks = []
    if CASES[name]["how"] == "many":
        marks.append(pytest.mark.slow)
    return pytest.param(name, marks=marks)


@pytest.fixture(scope="module")
def runner():
    """The script that came with the cases, its commands run within this process."""
    spec = importlib.util.spec_from_file_location("run_cases", FOLDER / "run_cases.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("name", [marked(name) for name in CASES])
def test_a_given_case_is_right(name, runner, tmp_path, capsys, monkeypatch):
    case = CASES[name]
    files = [FOLDER / file for file in case["inputs"]]

    def cli(files, tmp, limit=300):
        table = Path(tmp) / "modes.csv"
        table.unlink(missing_ok=True)
        code = run(["classify", *map(str, files), "--output", str(table)])
        said = capsys.readouterr()
        text = said.out + said.err
        for file in files:
            text = text.replace(str(file), "FILE" + Path(file).suffix)
        lines = table.read_text(encoding="utf-8").splitlines() if table.exists() else []
        rows = list(csv.DictReader(lines))
        for row in rows:
            row["_id"] = row["track"]
        return code, text, rows

    monkeypatch.setattr(runner, "cli", cli)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cc.errors.OutlineChangedWarning)
        runner.HOW[case["how"]](case, files, tmp_path)
