"""`cellcrawl sweep`: files, what it says, exit codes, one-line errors."""

from __future__ import annotations

import pytest

import cellcrawl as cc
from cellcrawl.command_line.main import run

GRID = """
[axes]
r_on = [20, 50]
zeta_1 = [450, 600]
seed = [1, 2]
[run]
t_end = 2.0
"""


@pytest.fixture
def grid(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "grid.toml").write_text(GRID)
    return tmp_path / "grid.toml"


def test_a_sweep_leaves_rows_and_a_diagram_and_the_second_time_makes_no_run(grid, capsys):
    assert run(["sweep", "grid.toml", "--workers", "1"]) == 0
    said = capsys.readouterr().out
    assert "r_on 2 x zeta_1 2 x seed 2: 8 runs" in said
    assert "done     8\n" in said
    assert "ended    completed 8" in said
    assert (grid.with_name("grid") / "diagram.png").stat().st_size > 5000
    parts = sorted((grid.with_name("grid") / "rows").iterdir())
    assert run(["sweep", "grid.toml", "--workers", "1"]) == 0
    assert capsys.readouterr().out == said
    assert sorted((grid.with_name("grid") / "rows").iterdir()) == parts
    assert run(["sweep", "grid.toml", "--status"]) == 0
    assert "done     8\n" in capsys.readouterr().out
    assert run(["sweep", "grid", "--status"]) == 0
    assert "ended    completed 8" in capsys.readouterr().out


def test_tasks_of_a_job_array_are_collected(grid, capsys):
    for task in ("0", "1"):
        options = ["--chunk", task, "--of", "2", "--t-end", "0.1", "--workers", "1"]
        assert run(["sweep", "grid.toml", "--output", "out", *options]) == 0
        assert not (grid.with_name("out") / "diagram.png").exists()
    capsys.readouterr()
    assert run(["sweep", "grid.toml", "--output", "out", "--collect"]) == 0
    said = capsys.readouterr().out
    assert "done     8\n" in said
    assert "note     grid.toml has changed" in said  # it says t_end = 2
    assert (grid.with_name("out") / "diagram.png").exists()
    assert cc.open_sweep("out").to_dataset()["end_time"].values.max() == 0.1


@pytest.mark.parametrize(
    ("arguments", "code", "says"),
    [
        (["none.toml"], 2, "cannot read 'none.toml'"),
        (["grid.toml", "--status"], 2, "there is no sweep in grid"),
        (["grid.toml", "--keep", "all"], 2, "keep = 'all'"),
        (["grid.toml", "--workers", "0"], 2, "workers = 0"),
        (["grid.toml", "--chunk", "3"], 2, "--chunk and --of go together"),
        (["grid.toml", "--chunk", "3", "--of", "3"], 2, "--array=0-2"),
        (["grid.toml", "--refine", "0"], 2, "levels = 0"),
        (["grid.toml", "--refine", "1", "--chunk", "0", "--of", "2"], 2, "--refine does not go"),
        (["grid.toml", "--dask", "tcp://127.0.0.1:9"], 2, "no Dask scheduler answers"),
        (["grid.toml", "--output", "busy"], 2, "busy exists and holds no sweep"),
        (["."], 2, ". is a folder"),
    ],
)
def test_mistakes_are_one_line_and_exit_code_2(grid, capsys, monkeypatch, arguments, code, says):
    from cellcrawl.sweeps import executors

    monkeypatch.setattr(executors, "_CONNECT", "1s")
    grid.with_name("busy").mkdir()
    (grid.with_name("busy") / "notes.txt").write_text("mine")
    assert run(["sweep", *arguments]) == code
    said = capsys.readouterr()
    assert said.err.count("\n") == 1
    assert says in said.err
    assert [path.name for path in grid.with_name("busy").iterdir()] == ["notes.txt"]


def test_a_sweep_along_one_parameter_is_drawn_and_its_folder_can_be_asked(
    tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    content = "[axes]\nr_on = [20, 30]\nseed = [1, 2]\n[run]\nt_end = 6.0\nnodes = 64\n"
    (tmp_path / "line.toml").write_text(content)
    assert run(["sweep", "line.toml", "--workers", "1"]) == 0
    assert (tmp_path / "line" / "diagram.png").stat().st_size > 1000
    capsys.readouterr()
    assert run(["info", "line"]) == 0
    said = capsys.readouterr().out
    assert "r_on 2 x seed 2: 4 runs" in said
    assert "t_end = 6" in said
    for kind in ("diagram", "speed"):
        assert run(["plot", "line", "--kind", kind, "--width", "3"]) == 0
        assert (tmp_path / "line" / f"{kind}.png").exists()
    assert run(["plot", "line", "--kind", "path"]) == 2
    assert "--kind of a sweep" in capsys.readouterr().err
