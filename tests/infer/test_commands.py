"""`cellcrawl bank` and `cellcrawl fit`: files, what they say, exit codes, one line a mistake."""

import re
import shutil

import h5py
import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.command_line.main import run
from cellcrawl.infer import bank_file, page, pictures
from tests.infer.conftest import swimmer

FILMED = ["--pixel-size", "0.1 um", "--frame-interval", "0.5 s"]


@pytest.fixture(autouse=True)
def _quick(monkeypatch):
    """Draw as little as will do: what is asked here is what the commands do with it."""
    monkeypatch.setattr(page, "_DPI", 30)
    monkeypatch.setattr(pictures, "foretold", lambda fit: [])  # runs of the solver


@pytest.fixture(scope="module")
def film(tmp_path_factory):
    """A film of one made-up cell, R_0 = 1 µm and 1/k_off0 = 1 s, as a label image."""
    made = swimmer(28.0, 1e-3, 5, step=0.5).isel(time=slice(20, None))
    return cc.observe(made, pixel=0.1, frame=0.5).write(tmp_path_factory.mktemp("film") / "a.tif")


@pytest.fixture
def here(tmp_path, monkeypatch, bank, film):
    """A folder with a bank, a film, and a table of tracks of three cells."""
    monkeypatch.chdir(tmp_path)
    shutil.copy(bank.path, "bank.h5")
    shutil.copy(film, "a.tif")
    rows = ["id,t [s],x [um],y [um]"]
    for name, seed in (("1", 5), ("2", 6), ("3", 7)):
        cell = swimmer(28.0, 1e-3, seed, step=1.0).isel(time=slice(10, None))
        for t, x, y in zip(cell.time, cell.centroid_x, cell.centroid_y, strict=True):
            rows.append(f"{name},{float(t)},{float(x)},{float(y)}")
    (tmp_path / "tracks.csv").write_text("\n".join(rows) + "\n")
    return tmp_path


def refused(capsys, *arguments):
    """Run a command that is refused; return its one line."""
    assert run(list(arguments)) == 2
    lines = capsys.readouterr().err.strip().splitlines()
    assert len(lines) == 1, lines
    return lines[0]


def test_a_bank_is_made_gone_on_with_and_shown(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    asked = ["bank", "--output", "real.h5", "--t-end", "20", "--prior", "r_on=25,27"]
    assert run([*asked, "--runs", "2", "--workers", "1"]) == 0
    assert "2 runs to t = 20" in capsys.readouterr().out
    assert run([*asked, "--runs", "3", "--workers", "1"]) == 0
    capsys.readouterr()
    assert run(["bank", "--output", "real.h5", "--show"]) == 0
    told = capsys.readouterr().out
    assert "3 runs to t = 20" in told
    assert "r_on: 25 to 27" in told
    before = (tmp_path / "real.h5").read_bytes()
    assert "another prior" in refused(capsys, *asked, "--prior", "D=0.02,0.2,log")
    assert "30 is no range" in refused(capsys, *asked[:-2], "--prior", "30")
    assert "no number or range" in refused(capsys, *asked[:-2], "--prior", "r_on=a,b")
    assert (tmp_path / "real.h5").read_bytes() == before
    assert not list(tmp_path.glob("*.work"))


def test_a_film_becomes_a_page(here, capsys):
    asked = ["fit", "a.tif", *FILMED, "--bank", "bank.h5", "--time-unit", "0.8,1.25,log"]
    assert run(asked) == 0
    told = capsys.readouterr().out
    low, high = map(float, re.search(r"r_on .* from ([\d.]+) to ([\d.]+)", told).groups())
    assert low < 28.0 < high
    text = (here / "fit.html").read_text("utf-8")
    assert "length_unit" in text  # read off the outlines
    assert "What to know" in text
    assert 'src="http' not in text


def test_several_tracks_are_fitted_one_by_one_and_together(here, capsys):
    asked = ["fit", "tracks.csv", "--bank", "bank.h5", "--length-unit", "1"]
    assert run([*asked, "--time-unit", "1", "--output", "all.html"]) == 0
    told = capsys.readouterr().out
    assert told.count("cell     ") == 3
    assert "together 3 cells" in told
    assert "Cell 2" in (here / "all.html").read_text("utf-8")
    assert run([*asked, "--time-unit", "1", "--track", "2", "--output", "two.html"]) == 0
    assert capsys.readouterr().out.count("cell     ") == 1


def test_two_conditions_are_compared(here, capsys):
    shutil.copy("tracks.csv", "again.csv")
    asked = ["fit", "tracks.csv", "--treated", "again.csv", "--bank", "bank.h5"]
    assert run([*asked, "--length-unit", "1", "--time-unit", "1"]) == 0
    told = capsys.readouterr().out
    assert "compared 3 cells with 3" in told
    assert re.search(r"r_on +times 1\.000", told)  # of the same cells twice
    assert "What changed" in (here / "fit.html").read_text("utf-8")


def without(pattern, text):
    return "\n".join(line for line in text.splitlines() if not re.search(pattern, line)) + "\n"


MISTAKES = {
    "no bank": (["a.tif", "--bank", "nowhere.h5"], None, "there is no bank"),
    "no film": (["b.tif", "--bank", "bank.h5"], None, "b.tif"),
    "no units": (
        ["bare.csv", "--bank", "bank.h5"],
        lambda text: text.replace(" [um]", "").replace(" [s]", ""),
        "without a unit",
    ),
    "one frame": (
        ["bare.csv", "--bank", "bank.h5", "--length-unit", "1"],
        lambda text: "\n".join(text.splitlines()[:2]) + "\n",
        "a single record is no path",
    ),
    "a resting cell": (
        ["bare.csv", "--bank", "bank.h5", "--length-unit", "1"],
        lambda text: re.sub(r"^(\d,[\d.]+),.*$", r"\1,1,2", text, flags=re.M),
        "rests",
    ),
    "no length of a track": (["tracks.csv", "--bank", "bank.h5"], None, "give length_unit"),
    "a network for abc": (["a.tif", "--bank", "bank.h5", "--network", "n.npz"], None, "npe"),
    "no such method": (["a.tif", "--bank", "bank.h5", "--method", "guess"], None, "abc"),
    "no such track": (["tracks.csv", "--bank", "bank.h5", "--track", "9"], None, "9"),
    "a unit that is none": (
        ["tracks.csv", "--bank", "bank.h5", "--length-unit", "wide"],
        None,
        "no number or range",
    ),
    "outlines of treated cells alone": (
        ["tracks.csv", "--bank", "bank.h5", "--treated-outlines", "a.tif"],
        None,
        "--treated",
    ),
    "a page that is none": (["a.tif", "--bank", "bank.h5", "--output", "fit.pdf"], None, ".html"),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_one_line_and_nothing_is_written(mistake, here, capsys):
    arguments, change, word = MISTAKES[mistake]
    if change is not None:
        (here / "bare.csv").write_text(change((here / "tracks.csv").read_text()))
    filmed = FILMED if arguments[0] == "a.tif" else []
    before = {path.name: path.read_bytes() for path in here.iterdir()}
    assert word in refused(capsys, "fit", *arguments, *filmed)
    assert {path.name: path.read_bytes() for path in here.iterdir()} == before


def test_outlines_in_some_frames_only_are_refused(here, capsys):
    whole = cc.read_outlines("a.tif", pixel_size="0.1 um", frame_interval="0.5 s")
    some = [one for one in whole if one.frame % 3]
    line = None
    with pytest.raises(cc.InputError, match="of 59 frames") as raised:
        cc.infer.fit(cc.microscopy.Outlines(some, whole.source), cc.infer.open_bank("bank.h5"))
    line = str(raised.value)
    assert "\n" not in line
    assert "track alone" in line


@pytest.mark.parametrize("name", ["schema", "kind"])
def test_a_bank_of_another_version_is_refused(name, here, capsys):
    with h5py.File("bank.h5", "r+") as file:
        text = file.attrs["header"].replace(f'"schema": {bank_file.SCHEMA}', '"schema": 0')
        text = text if name == "schema" else text.replace(bank_file.KIND, "other")
        file.attrs["header"], file.attrs["seal"] = text, bank_file._hash(text)
    before = (here / "bank.h5").read_bytes()
    assert "another version" in refused(capsys, "fit", "a.tif", *FILMED, "--bank", "bank.h5")
    assert "another version" in refused(capsys, "bank", "--output", "bank.h5")
    assert (here / "bank.h5").read_bytes() == before
    assert not (here / "fit.html").exists()


def test_a_cell_outside_the_prior_is_told(here, bank):
    """Twice as fast as any cell of the bank: whatever else is said, not that all is well."""
    cell = swimmer(28.0, 4e-3, 5, step=0.5)
    found = cc.infer.fit(cell, bank, time_unit=(0.8, 1.25, "log"))
    assert found.alarm or "epsilon" in found.at_the_edge or "time_unit" in found.at_the_edge
    assert np.isfinite(found.values).all()
