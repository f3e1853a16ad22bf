import csv

import pytest

import cellcrawl as cc
from cellcrawl.command_line.main import run


def test_the_command_prints_and_keeps_where_gliding_loses_its_hold(tmp_path, capsys):
    folder = tmp_path / "made"
    assert run(["branches", "--to", "54", "--output", str(folder)]) == 0
    said = capsys.readouterr().out
    assert "antisymmetric pitchfork" in said
    with (folder / "special_points.csv").open(encoding="utf-8") as file:
        (row,) = csv.DictReader(file)
    assert float(row["r_on"]) == pytest.approx(54.817202, abs=1e-6)
    assert (folder / "branches.png").stat().st_size > 0
    kept = cc.branches.open_branch(folder / "gliding-560.nc")
    assert kept.values[-1] == 54.0
    assert run(["branches", "--to", "54", "--output", str(folder)]) == 2  # nothing is overwritten
    assert run(["branches", "--at-zeta-1", "many", "--output", str(folder)]) == 2


def test_branches_in_different_parameters_share_no_axes():
    start = cc.branches.from_circle(cc.Parameters(r_on=56, zeta_1=560))
    first = start.continue_in("r_on", 57, spectra=False)
    second = start.continue_in("zeta_1", 561, spectra=False)
    with pytest.raises(cc.InputError, match="same parameter"):
        cc.plot.branch([first, second])
