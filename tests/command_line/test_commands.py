"""The command line: files, exit codes, one-line errors, help."""

from __future__ import annotations

import pytest

import cellcrawl as cc
from cellcrawl.command_line.main import run
from cellcrawl.parameters import DESCRIPTIONS
from cellcrawl.simulation.events import STATUSES

QUICK = ["--solver", "paper", "--nodes", "100", "--t-end", "0.3"]


def test_simulate_leaves_data_picture_and_movie(tmp_path, capsys):
    folder = tmp_path / "cell"
    assert run(["simulate", *QUICK, "--output", str(folder)]) == 0
    assert {path.name for path in folder.iterdir()} == {"run.nc", "summary.png", "cell.mp4"}
    said = capsys.readouterr().out
    assert "completed" in said
    assert str(folder / "cell.mp4") in said


def test_flags_reach_the_run(tmp_path):
    flags = ["--r-on", "30", "--D", "0.1", "--k-sigma", "900", "--elasticity", "printed"]
    arguments = [*QUICK, *flags, "--seed", "4", "--no-movie", "--no-plot"]
    assert run(["simulate", *arguments, "--output", str(tmp_path)]) == 0
    saved = cc.open_run(tmp_path / "run.nc")
    direct = cc.simulate(
        cc.Parameters(r_on=30, D=0.1, k_sigma=900),
        0.3,
        start=cc.RandomPerturbation(seed=4),
        solver="paper",
        nodes=100,
    )
    assert saved.equals(direct)
    assert [path.name for path in tmp_path.iterdir()] == ["run.nc"]


def test_config_file_sets_everything_and_flags_win(tmp_path):
    config = tmp_path / "cell.toml"
    config.write_text(
        "[parameters]\nr_on = 16\nzeta_1 = 580\n[schedule]\nr_on = [[0.1, 16.0], [0.1, 30.0]]\n"
        '[start]\nkind = "Eigenmode"\nk = 3\namplitude = 1e-4\n'
        '[run]\nsolver = "paper"\nnodes = 100\nt_end = 5.0\n'
    )
    arguments = ["--config", str(config), "--t-end", "0.2", "--no-movie", "--no-plot"]
    assert run(["simulate", *arguments, "--output", str(tmp_path / "out")]) == 0
    saved = cc.open_run(tmp_path / "out" / "run.nc")
    direct = cc.simulate(
        cc.Parameters(r_on=16, zeta_1=580),
        0.2,
        start=cc.Eigenmode(k=3, amplitude=1e-4),
        schedule=cc.Schedule({"r_on": [(0.1, 16.0), (0.1, 30.0)]}),
        solver="paper",
        nodes=100,
    )
    assert saved.equals(direct)


def test_without_output_runs_get_numbered_folders(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for _ in range(2):
        assert run(["simulate", *QUICK, "--no-movie", "--no-plot"]) == 0
    assert {path.name for path in tmp_path.iterdir()} == {"cellcrawl-run", "cellcrawl-run-2"}


def test_resume_plot_movie_and_info_work_on_the_file(tmp_path, capsys):
    run(["simulate", *QUICK, "--no-movie", "--no-plot", "--output", str(tmp_path)])
    data = str(tmp_path / "run.nc")
    assert run(["resume", data, "--t-end", "0.5"]) == 0
    for kind in ("summary", "path", "kymographs", "time_series"):
        assert run(["plot", data, "--kind", kind, "--dpi", "50"]) == 0
        assert (tmp_path / f"{kind}.png").stat().st_size > 1000
    assert run(["movie", data, "--seconds", "0.4", "--output", str(tmp_path / "c.gif")]) == 0
    capsys.readouterr()
    assert run(["info", data]) == 0
    said = capsys.readouterr().out
    assert "r_on = 26.0" in said
    assert "to 0.5" in said
    assert "bound_fraction" in said


def test_a_torn_cell_is_a_success_and_a_failed_run_is_not():
    from cellcrawl.command_line.report import exit_code

    codes = {"completed": 0, "fragmented": 0, "interrupted": 130}
    failures = dict.fromkeys(set(STATUSES) - {*codes, "running"}, 3)
    assert {"inconsistent", "out_of_range"} <= set(failures)
    for status, code in {**codes, **failures}.items():
        assert exit_code(status) == code


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["simulat"], "did you mean 'simulate'"),
        (["simulate", "--r-onn", "3"], "--r-on"),
        (["simulate", "--r-on", "nan"], "r_on = nan"),
        (["simulate", "--r-on", "1e9"], "from 1 to 200"),
        (["simulate", "--r-on", "x"], "not a valid float"),
        (["simulate", "--t-end", "-1"], "t_end"),
        (["simulate", "--seed", "-1"], "seed"),
        (["simulate", "--solver", "papr"], "did you mean 'paper'"),
        (["simulate", "--config", "absent.toml"], "absent.toml"),
        (["resume", "absent.nc", "--t-end", "1"], "no run at absent.nc"),
        (["info", "absent.nc"], "no run at absent.nc"),
        (["plot", "absent.nc"], "no run at absent.nc"),
        (["movie", "absent.txt"], "must end in .nc"),
    ],
)
def test_mistakes_are_one_line_and_exit_code_2(arguments, says, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert run(arguments) == 2
    complaint = capsys.readouterr().err
    assert says in complaint
    assert complaint.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "text",
    [
        "[parameters]\nr_onn = 3\n",
        "[parameter]\n",
        "not toml",
        '[start]\nkind = "Random"\n',
        "[start]\nkind = 'Eigenmode'\n",
        "[start]\nseeed = 3\n",
        "[run]\ndt = 'x'\n",
        "[run]\nt_ende = 3\n",
        "parameters = 3\n",
        "[schedule]\nr_on = 3\n",
    ],
)
def test_mistakes_in_a_config_are_one_line(text, tmp_path, capsys):
    config = tmp_path / "cell.toml"
    config.write_text(text)
    arguments = ["simulate", *QUICK, "--config", str(config), "--output", str(tmp_path / "o")]
    assert run(arguments) == 2
    assert capsys.readouterr().err.count("\n") == 1


@pytest.mark.parametrize(
    "command",
    [[], ["simulate"], ["resume"], ["classify"], ["plot"], ["movie"], ["info"]],
)
def test_help_shows_an_example(command, capsys):
    assert run([*command, "--help"]) == 0
    assert "cellcrawl " in capsys.readouterr().out


def test_simulate_has_a_flag_for_every_parameter(capsys):
    run(["simulate", "--help"])
    said = capsys.readouterr().out
    for name in DESCRIPTIONS:
        assert f"--{name.replace('_', '-')}" in said


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_script_is_for_this_command(shell, capsys):
    assert run(["completion", shell]) == 0
    assert "_CELLCRAWL_COMPLETE" in capsys.readouterr().out
