"""`cellcrawl classify` on runs and tables, and the mode in the report of a run."""

from __future__ import annotations

import csv

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.command_line.main import run
from cellcrawl.command_line.report import report_run
from tests.tracks import circle_track, sine_track, straight_track


def write(path, track, names=("t", "x", "y"), separator=","):
    rows = [separator.join(names)]
    rows += [separator.join(f"{value:.9g}" for value in row) for row in zip(*track, strict=True)]
    path.write_text("\n".join(rows) + "\n")
    return str(path)


@pytest.fixture(scope="module")
def turning_run():
    cell = cc.Parameters(r_on=24, zeta_1=540)
    return cc.simulate(cell, 60.0, start=cc.RandomPerturbation(seed=1), nodes=64)


def test_tables_of_tracks_are_named(tmp_path, capsys):
    files = [
        write(tmp_path / "a.csv", straight_track()),
        write(tmp_path / "b.csv", circle_track(), ("T", "x", "Y"), ";"),
        write(tmp_path / "c.txt", sine_track()[::-1], ("y", "x", "t"), "\t"),
    ]
    assert run(["classify", *files]) == 0
    lines = capsys.readouterr().out.splitlines()
    head = next(i for i, line in enumerate(lines) if line.startswith("file "))
    modes = [line.split()[1] for line in lines[head + 1 : head + 4]]
    assert modes == ["gliding", "rotational", "zigzag"]
    assert "together: mixed" in lines[head + 4]
    assert any("semicolon between" in line for line in lines[:head])


def test_one_table_may_hold_several_tracks(tmp_path, capsys):
    rows = ["track,frame,t,x,y"]
    for name, track in (("7", straight_track()), ("8", sine_track())):
        rows += [f"{name},0,{t},{x},{y}" for t, x, y in zip(*track, strict=True)]
    file = tmp_path / "cells.csv"
    file.write_text("\n".join(rows))
    table = tmp_path / "modes.csv"
    assert run(["classify", str(file), "--output", str(table)]) == 0
    assert "together: mixed" in capsys.readouterr().out
    written = list(csv.DictReader(table.read_text().splitlines()))
    assert [(row["file"], row["track"]) for row in written] == [(str(file), "7"), (str(file), "8")]
    assert [row["mode"] for row in written] == ["gliding", "zigzag"]
    assert float(written[1]["period"]) == pytest.approx(18.0, rel=1e-2)
    assert {path.name for path in tmp_path.iterdir()} == {"cells.csv", "modes.csv"}


def test_a_cell_radius_tells_a_spin_from_a_rotation(tmp_path, capsys):
    file = write(tmp_path / "spin.csv", circle_track(rate=0.5, radius=0.4))
    assert run(["classify", file]) == 0
    assert "rotational" in capsys.readouterr().out
    assert run(["classify", file, "--cell-radius", "1"]) == 0
    assert "spins within its own outline" in capsys.readouterr().out


def test_a_run_is_named(tmp_path, capsys, turning_run):
    data = tmp_path / "run.nc"
    start = cc.RandomPerturbation(seed=1)
    cc.simulate(
        cc.Parameters(r_on=24, zeta_1=540), 60.0, start=start, nodes=64, output=data
    ).close()
    assert run(["classify", str(data)]) == 0
    said = capsys.readouterr().out
    assert cc.classify(turning_run).mode == "rotational"
    assert "rotational" in said
    assert "once round" in said


def test_report_of_a_run_names_its_mode(capsys, turning_run):
    report_run(turning_run)
    assert "mode     rotational, confidence" in capsys.readouterr().out
    report_run(turning_run.isel(time=slice(0, 30)))
    assert "so far; a run to t = 50 or more can tell" in capsys.readouterr().out
    report_run(turning_run.isel(time=slice(0, 3)).assign_attrs(status="fragmented"))
    assert "mode     fragmented" in capsys.readouterr().out
    report_run(turning_run.isel(time=slice(0, 3)))
    assert "mode" not in capsys.readouterr().out


def test_summary_picture_names_the_mode(turning_run):
    title = cc.plot.summary(turning_run).get_suptitle()
    assert "rotational" in title


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "is empty"),
        ("a,b,c\n1,2,3\n", "no columns of positions among a, b, c"),
        ("t,x\n1,2\n", "no columns of positions among t, x"),
        ("t,x,y\n", "holds no table"),
        ("t,x,y\n1,2,3\n1,two,3\n", "no track of two records"),
        ("t,x,y\n1,two,3\n2,two,3\n", "lines 2, 3: x = 'two' is not a number"),
        ("t,x,y\n1,2,3\n2,3,4\n", "at least 12 needed"),
        ("t,x,y\n" + "".join(f"1,{i},3\n" for i in range(20)), "two positions at t = 1"),
        ("t,x,y\n" + "".join(f"{i},nan,3\n" for i in range(20)), "all its records are blank"),
    ],
)
def test_a_bad_table_is_one_line_that_names_it(text, says, tmp_path, capsys):
    file = tmp_path / "cells.csv"
    file.write_text(text)
    assert run(["classify", str(file)]) == 2
    complaint = capsys.readouterr().err
    assert says in complaint
    assert "cells.csv" in complaint
    assert complaint.count("\n") == 1


def test_files_that_are_not_there_or_not_text_are_one_line(tmp_path, capsys):
    binary = tmp_path / "image.tif"
    binary.write_bytes(bytes(np.arange(256, dtype=np.uint8)))
    for file in ("absent.csv", "absent.nc", str(binary)):
        assert run(["classify", file]) == 2
        assert capsys.readouterr().err.count("\n") == 1
    assert run(["classify"]) == 2
    good = write(tmp_path / "a.csv", straight_track())
    assert run(["classify", good, "--output", str(tmp_path / "no" / "such.csv")]) == 3
    assert capsys.readouterr().err.splitlines()[-1].startswith("cellcrawl: cannot write")


def test_one_bad_track_or_file_stops_no_other(tmp_path, capsys):
    names = {"7": straight_track(), "8": sine_track()}
    rows = [
        f"{n},{t},{x},{y}" for n, track in names.items() for t, x, y in zip(*track, strict=True)
    ]
    rows += ["9,0,1,1", "9,1,2,2", "10,0,1,1", "7,0,99,99"]
    file = tmp_path / "cells.csv"
    file.write_text("track,t,x,y\n" + "\n".join(rows))
    other = tmp_path / "broken.csv"
    other.write_text("t,x\n1,2\n")
    table = tmp_path / "modes.csv"
    assert run(["classify", str(other), str(file), "--output", str(table)]) == 0
    said = capsys.readouterr()
    assert "left out" in said.err
    assert "broken.csv" in said.err
    written = {row["track"]: row for row in csv.DictReader(table.read_text().splitlines())}
    assert written["8"]["mode"] == "zigzag"
    assert "at least 12" in written["9"]["reason"]
    assert written["10"]["reason"] == "a single record is no path"
    assert "two positions at one time" in written["7"]["reason"]
    assert all(written[name]["mode"] == "" for name in ("7", "9", "10"))


def test_the_sense_of_rotation_is_that_on_the_screen(tmp_path, capsys):
    file = write(tmp_path / "c.csv", circle_track())
    assert run(["classify", file]) == 0
    assert "turns left" in capsys.readouterr().out
    assert run(["classify", file, "--image-coordinates"]) == 0
    said = capsys.readouterr().out
    assert "turns right" in said
    assert "y points down" in said


def test_columns_interval_and_pixel_are_options(tmp_path, capsys):
    file = write(tmp_path / "c.csv", straight_track(), ("when", "east", "north"))
    assert run(["classify", file]) == 2
    assert "--columns" in capsys.readouterr().err
    assert (
        run(["classify", file, "--columns", "t=when,x=east,y=north", "--pixel-size", "2 um"]) == 0
    )
    said = capsys.readouterr().out
    assert "gliding" in said
    assert "length µm" in said
    assert run(["classify", file, "--columns", "t=wen,x=east,y=north"]) == 2
    assert "did you mean 'when'" in capsys.readouterr().err
