"""The command line: files, exit codes, one-line errors, help."""

from __future__ import annotations

import json

import numpy as np
import pytest
from PIL import Image

import cellcrawl as cc
from cellcrawl.command_line.main import run
from cellcrawl.command_line.report import _report_motion
from cellcrawl.data import STATUSES
from cellcrawl.parameters import DESCRIPTIONS
from tests.runs import circle_on_track

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


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    folder = tmp_path_factory.mktemp("kept")
    cc.simulate(
        t_end=2.0, save_every=0.1, start=cc.Eigenmode(k=2), nodes=64, output=folder / "run.nc"
    ).close()
    return folder


def test_plot_movie_and_info_take_the_folder_of_a_run(kept, capsys):
    assert run(["plot", str(kept)]) == 0
    assert run(["movie", str(kept), "--seconds", "0.2", "--size", "160,120"]) == 0
    assert {"summary.png", "cell.mp4"} <= {path.name for path in kept.iterdir()}
    assert run(["info", str(kept)]) == 0
    said = capsys.readouterr().out
    assert "start Eigenmode" in said
    assert "seed -1" not in said
    assert "records: 21" in said


def test_the_look_of_a_picture_is_set_on_the_command_line(kept, tmp_path):
    picture = tmp_path / "path.png"
    look = ["--width", "5", "--font-size", "9", "--colormap", "magma", "--rc", "lines.linewidth=2"]
    where = ["--field", "off_rate", "--limits", "1,100", "--every", "1", "--dpi", "50"]
    arguments = ["--kind", "path", *look, *where, "--style", "dark_background"]
    assert run(["plot", str(kept), *arguments, "--output", str(picture)]) == 0
    with Image.open(picture) as image:
        assert image.width == 250
        assert image.convert("RGB").getpixel((2, 2)) == (0, 0, 0)
    for kind, more in (
        ("snapshots", ["--time", "0,1"]),
        ("kymographs", ["--field", "friction", "--origin", "material"]),
        ("time_series", ["--field", "tension,area"]),
        ("cell", ["--time", "1"]),
    ):
        target = tmp_path / f"{kind}.png"
        assert run(["plot", str(kept), "--kind", kind, *more, "--output", str(target)]) == 0
        assert target.stat().st_size > 1000


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--kind", "snapshots"], "needs --time"),
        (["--kind", "path", "--time", "3"], "--time means nothing for --kind path"),
        (["--kind", "cell", "--time", "1,2"], "shows one --time"),
        (["--limits", "3"], "give two numbers"),
        (["--limits", "a,b"], "numbers with commas"),
        (["--rc", "font.size"], "give a name and a value"),
        (["--rc", "lines.linewidth=x"], "lines.linewidth = 'x'"),
        (["--style", "no-such-style"], "no-such-style"),
        (["--colormap", "viridi"], "did you mean 'viridis'"),
        (["--width", "0"], "width = 0.0 is out of range"),
    ],
)
def test_looks_that_cannot_be_are_one_line(kept, arguments, said, capsys):
    assert run(["plot", str(kept), *arguments]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1


def test_a_folder_without_a_run_or_with_several_is_told(tmp_path, capsys):
    assert run(["info", str(tmp_path)]) == 2
    assert "holds no run" in capsys.readouterr().err
    for name in ("a.nc", "b.nc"):
        (tmp_path / name).touch()
    assert run(["plot", str(tmp_path)]) == 2
    assert "holds 2 runs: give one of a.nc, b.nc" in capsys.readouterr().err
    assert run(["info", str(tmp_path / "missing")]) == 2
    assert "there is no file or folder" in capsys.readouterr().err


def test_a_cell_at_rest_has_not_turned_by_nan(capsys):
    still = circle_on_track(np.arange(5.0), lambda t: ((0.0, 0.0), (0.0, 0.0)))
    _report_motion(still)
    said = capsys.readouterr().out
    assert "at rest" in said
    assert "nan" not in said


def test_info_tells_the_laws_and_surroundings_of_a_run(tmp_path, capsys):
    around = cc.surroundings.Stripes(period=1.5)
    path = tmp_path / "run.nc"
    cc.simulate(cc.Parameters(), 0.2, output=path).close()
    run(["info", str(path)])
    assert "laws:" not in capsys.readouterr().out
    made = cc.open_run(path).load()
    world = {
        "laws": json.dumps(cc.laws.Stiffness(chi=0.5).describe()),
        "surroundings": json.dumps(cc.surroundings.Surroundings([around]).describe()),
    }
    made.assign_attrs(**world).to_netcdf(tmp_path / "other.nc", engine="h5netcdf")
    run(["info", str(tmp_path / "other.nc")])
    told = capsys.readouterr().out
    assert "laws: cellcrawl.laws.stiffness:Stiffness (chi = 0.5)" in told
    assert "surroundings: cellcrawl.surroundings.patterns:Stripes (period = 1.5" in told
