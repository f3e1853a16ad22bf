"""`cellcrawl reproduce`: the list, what it says, and mistakes."""

from __future__ import annotations

import signal
import subprocess
import sys
import time

import pytest

from cellcrawl.command_line.main import run
from cellcrawl.reproduction import RECIPES


@pytest.mark.parametrize("arguments", [["--list"], []])
def test_the_list_names_everything_with_its_cost(arguments, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert run(["reproduce", *arguments]) == 0
    said = capsys.readouterr().out
    for recipe in RECIPES.values():
        assert f"{recipe.name} " in said
        assert recipe.title in said
    assert "figures, movies, all" in said
    assert list(tmp_path.iterdir()) == []


def test_a_figure_is_made_once_and_then_found(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert run(["reproduce", "fig2", "--quick", "--dpi", "40", "--format", "png,pdf"]) == 0
    said = capsys.readouterr().out
    for file in ("fig2.png", "fig2.pdf", "growth-rates.csv"):
        assert (tmp_path / "reproduction-quick" / "fig2" / file).exists()
        assert file in said
    assert run(["reproduce", "fig2", "--quick", "--dpi", "40", "--format", "png,pdf"]) == 0
    assert "[was there]" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["fig22"], "did you mean 'fig2'"),
        (["fig2", "--format", "gif"], "'png', 'pdf', 'svg'"),
        (["fig2", "--dpi", "5"], "--dpi"),
    ],
)
def test_mistakes_are_one_line_and_exit_code_2(arguments, says, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert run(["reproduce", *arguments]) == 2
    complaint = capsys.readouterr().err
    assert says in complaint
    assert complaint.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_ctrl_c_keeps_the_run_and_the_next_call_goes_on(tmp_path):
    output = ["--output", str(tmp_path / "out")]
    command = [sys.executable, "-m", "cellcrawl", "reproduce", "movie-s6", *output]
    child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while not list(tmp_path.glob("out/runs/*.part")) and child.poll() is None:
        time.sleep(0.002)
    child.send_signal(signal.SIGINT)
    said, _ = child.communicate(timeout=60)
    assert child.returncode == 130
    assert "goes on" in said
    kept = list((tmp_path / "out" / "runs").iterdir())
    assert len(kept) == 1
    assert run(["reproduce", "movie-s6", "--quick", *output]) == 0
    assert not list((tmp_path / "out" / "movie-s6").glob(".*part*"))
