"""`cellcrawl dispersion` and `cellcrawl stability`."""

from __future__ import annotations

import pytest
import xarray as xr

from cellcrawl.command_line.main import run


def test_dispersion_prints_both_roots_of_every_wavenumber(capsys):
    assert run(["dispersion", "--r-on", "25", "--zeta-1", "600"]) == 0
    lines = capsys.readouterr().out.splitlines()
    rows = {line.split()[0]: line.split()[1:] for line in lines}
    assert rows["0"] == ["4.6496", "+", "15.503i", "4.6496", "-", "15.503i"]
    assert rows["1"] == ["12.742", "0"]
    assert len(rows["7"]) == 2  # the first pair is k = 8
    assert len(rows["8"]) == 6
    assert "k = 0 to 15, fastest k = 1" in lines[-3]
    assert lines[-2].startswith("onset    k = 7.80")
    assert lines[-1].startswith("Hopf     k = 15.28")


def test_dispersion_of_the_other_law_and_of_a_stable_cell(capsys):
    assert run(["dispersion", "--elasticity", "consistent", "--k-max", "2"]) == 0
    said = capsys.readouterr().out
    assert "-76.976" in said
    assert "-3408" in said
    assert run(["dispersion", "--zeta-1", "100"]) == 0
    assert "unstable none" in capsys.readouterr().out
    assert run(["dispersion", "--zeta-1", "0", "--sigma-c", "900"]) == 0
    assert "negative tension" in capsys.readouterr().out


@pytest.mark.parametrize("suffix", ["png", "pdf", "svg"])
def test_pictures_are_written(tmp_path, suffix, capsys):
    family, diagram = tmp_path / f"family.{suffix}", tmp_path / f"map.{suffix}"
    arguments = ["--vary", "zeta-1=400,500,600", "--k-max", "30"]
    assert run(["dispersion", *arguments, "--output", str(family), "--dpi", "50"]) == 0
    assert run(["stability", "--output", str(diagram), "--dpi", "50"]) == 0
    assert family.stat().st_size > 5000
    assert diagram.stat().st_size > 5000
    said = capsys.readouterr().out
    assert said.count("cell ") == 3
    assert str(diagram) in said


def test_stability_writes_the_map_it_prints(tmp_path, capsys):
    file = tmp_path / "map.nc"
    plane = ["--vary", "r_on=20:30:11", "--vary", "D=0.01:0.1", "--k", "1,15"]
    assert run(["stability", *plane, "--data", str(file)]) == 0
    said = capsys.readouterr().out
    assert "r_on 20 to 30, D 0.01 to 0.1" in said
    with xr.open_dataset(file, engine="h5netcdf") as saved:
        assert dict(saved.growth_rate.sizes) == {"k": 2, "r_on": 11, "D": 201}
        assert saved.sizes["vertex"] > 100


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["dispersion", "--vary", "zta_1=3"], "did you mean 'zeta_1'"),
        (["dispersion", "--vary", "zeta_1"], "must be a name and values"),
        (["dispersion", "--vary", "zeta_1=3,x"], "must be numbers"),
        (["dispersion", "--vary", "zeta_1=1:2:3:4"], "LOW:HIGH:COUNT"),
        (["dispersion", "--vary", "zeta_1=5000"], "from 0 to 2000"),
        (["dispersion", "--vary", "D=0.1", "--vary", "h=0.1"], "one parameter"),
        (["dispersion", "--vary", "D=0.1", "--vary", "D=0.2"], "D twice"),
        (["dispersion", "--k-max", "1"], "--k-max"),
        (["dispersion", "--output", "picture.xyz"], "cannot write picture.xyz"),
        (["stability", "--vary", "r_on=3:4"], "two parameters, not 1"),
        (["stability", "--vary", "r_on=4:3", "--vary", "D=0.1:1"], "increasing"),
        (["stability", "--k", "1,two"], "--k must be numbers"),
        (["stability", "--k", "1.5"], "k = 1.5"),
        (["stability", "--data", "map.txt"], "must end in .nc"),
    ],
)
def test_mistakes_are_one_line_and_exit_code_2(arguments, says, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert run(arguments) == 2
    complaint = capsys.readouterr().err
    assert says in complaint
    assert complaint.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("command", ["dispersion", "stability"])
def test_help_shows_examples_and_the_parameters(command, capsys):
    assert run([command, "--help"]) == 0
    said = capsys.readouterr().out
    assert f"cellcrawl {command} --" in said
    assert "--zeta-1" in said
