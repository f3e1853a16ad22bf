"""Recipes: each writes what it says, nothing is made twice, and a cut run goes on."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import cellcrawl as cc
from cellcrawl.errors import InputError, StorageError
from cellcrawl.reproduction import GROUPS, RECIPES, reproduce
from cellcrawl.reproduction.cells import NINE, TRANSITIONS
from cellcrawl.reproduction.runs import kept_run
from cellcrawl.reproduction.workspace import Workspace

CELL = cc.Parameters(r_on=26, zeta_1=600)


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("reproduction")


def made(name: str, folder: Path, **options):
    (done,) = reproduce([name], folder, quick=True, dpi=40, **options)
    return done


SLOW = {"fig4": pytest.mark.slow}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=SLOW.get(name, ())) for name in GROUPS["figures"]]
)
def test_a_figure_leaves_its_picture_and_the_data_behind_it(name, folder):
    done = made(name, folder)
    assert not done.reused
    assert done.found
    assert (folder / name / f"{name}.png").stat().st_size > 5000
    record = json.loads((folder / name / "about.json").read_text())
    assert record["title"] == RECIPES[name].title
    assert record["found"] == done.found
    data = [path for path in record["files"] if path.startswith(f"{name}/") and "png" not in path]
    assert data
    assert not list(folder.rglob("*.part"))


@pytest.mark.slow
def test_both_diagrams_come_from_one_sweep(folder):
    made("fig4", folder)
    before = {path: path.stat().st_mtime_ns for path in (folder / "plane-quick").rglob("*.parquet")}
    made("fig7", folder, again=True)
    after = {path: path.stat().st_mtime_ns for path in (folder / "plane-quick").rglob("*.parquet")}
    assert before
    assert after == before
    for name in ("fig4", "fig7"):
        rows = (folder / name / "points.csv").read_text().splitlines()
        assert len(rows) == 1 + 3 * 2  # r_on = 16, 26, 36 by zeta_1 = 560, 600


@pytest.mark.parametrize("name", ["movie-s4", "movie-s10"])
def test_a_movie_is_filmed_and_its_track_kept(name, folder):
    done = made(name, folder)
    assert (folder / name / f"{name}.mp4").stat().st_size > 5000
    track = np.loadtxt(folder / name / "track.csv", delimiter=",", skiprows=1)
    assert track[0, 0] == 0.0
    assert track[-1, 0] == pytest.approx(10.0)
    assert "completed" in done.found[0]


def test_what_is_there_is_not_made_again(folder):
    first = made("fig2", folder)
    picture = folder / "fig2" / "fig2.png"
    before = picture.stat().st_mtime_ns
    second = made("fig2", folder)
    assert second.reused
    assert second.found == first.found
    assert picture.stat().st_mtime_ns == before
    assert not made("fig2", folder, again=True, formats=["png", "svg"]).reused
    assert (folder / "fig2" / "fig2.svg").exists()


@pytest.mark.parametrize("damage", ["cut", "lost", "record"])
def test_what_is_damaged_counts_as_not_done(damage, tmp_path):
    place = Workspace(tmp_path, "fig2")
    place.table("numbers", {"a": [1.0, 2.0]})
    place.finish({"identity": "this", "found": []})
    assert place.finished("this") is not None
    assert place.finished("that") is None
    table, record = tmp_path / "fig2" / "numbers.csv", tmp_path / "fig2" / "about.json"
    if damage == "cut":
        table.write_bytes(table.read_bytes()[:3])
    elif damage == "lost":
        table.unlink()
    else:
        record.write_text("{")
    assert place.finished("this") is None


def test_runs_are_shared_and_told_apart_by_what_decides_them(tmp_path):
    kept_run(tmp_path, CELL, 0.2)
    kept_run(tmp_path, CELL, 0.2)
    assert len(list(tmp_path.glob("*.nc"))) == 1
    kept_run(tmp_path, CELL, 0.3)
    kept_run(tmp_path, CELL, 0.2, seed=2)
    kept_run(tmp_path, CELL, 0.2, rtol=1e-3)
    kept_run(tmp_path, CELL, 0.2, schedule=cc.Schedule({"D": [(0.5, 0.1)]}))
    assert len(list(tmp_path.glob("*.nc"))) == 5


def test_a_run_that_was_cut_goes_on_to_the_same_bits(tmp_path):
    whole = kept_run(tmp_path / "whole", CELL, 3.0)
    file = next((tmp_path / "whole").glob("*.nc"))
    (tmp_path / "cut").mkdir()
    cut = tmp_path / "cut" / file.name
    with cc.simulate(CELL, 1.3, start=cc.RandomPerturbation(seed=1), output=cut) as partial:
        assert partial.attrs["status"] == "completed"
    _call_interrupted(cut)
    joined = kept_run(tmp_path / "cut", CELL, 3.0)
    assert joined.sizes["time"] == 31
    for name in whole.data_vars:
        np.testing.assert_array_equal(joined[name], whole[name])


def _call_interrupted(path: Path) -> None:
    import h5py

    with h5py.File(path, "r+") as file:
        file.attrs["status"] = "interrupted"


def test_an_unreadable_run_is_made_anew(tmp_path):
    kept_run(tmp_path, CELL, 0.5)
    file = next(tmp_path.glob("*.nc"))
    file.write_bytes(b"not a run")
    again = kept_run(tmp_path, CELL, 0.5)
    assert again.attrs["status"] == "completed"
    with cc.open_run(file) as saved:
        assert saved.sizes["time"] == 6


def test_a_failed_write_leaves_nothing_half(tmp_path):
    place = Workspace(tmp_path, "fig2")
    (tmp_path / "fig2" / "table.csv").mkdir(parents=True)
    with pytest.raises(StorageError, match="cannot write"):
        place.table("table", {"a": [1]})
    assert [path.name for path in (tmp_path / "fig2").iterdir()] == ["table.csv"]
    (tmp_path / "file").write_text("")
    with pytest.raises(StorageError, match="cannot make the folder"):
        Workspace(tmp_path / "file", "fig2").data("x", xr.Dataset())


@pytest.mark.parametrize(
    ("names", "options", "says"),
    [
        (["fig44"], {}, "did you mean 'fig4'"),
        (["movie-s13"], {}, "did you mean 'movie-s3'"),
        (["fig2", "everything"], {}, "nothing to reproduce named 'everything'"),
        ([], {}, "give names, or 'all'"),
        (["fig2"], {"formats": ["jpg"]}, "'png', 'pdf', 'svg'"),
        (["fig2"], {"dpi": 3}, "dpi"),
    ],
)
def test_mistakes_are_refused_before_anything_is_made(names, options, says, tmp_path):
    with pytest.raises(InputError, match=says) as refused:
        reproduce(names, tmp_path, **options)
    assert "\n" not in str(refused.value)
    assert list(tmp_path.iterdir()) == []


def test_every_figure_and_movie_of_the_paper_has_a_name():
    figures = {f"fig{number}" for number in range(2, 8)} | {"short-time"}
    assert set(GROUPS["figures"]) == figures
    assert set(GROUPS["movies"]) == {f"movie-s{number}" for number in range(1, 13)}
    assert set(GROUPS["all"]) == set(RECIPES)


def test_the_nine_cells_and_the_changes_between_modes_are_the_papers():
    assert [(cell.r_on, cell.zeta_1) for cell in NINE] == [
        (16, 600), (56, 560), (24, 540), (26, 600), (36, 560),
        (38, 580), (40, 540), (40, 600), (44, 560),
    ]  # fmt: skip
    for change in TRANSITIONS:
        before = change.schedule.before(change.parameters, change.time)
        after = change.schedule.at(change.parameters, change.time + change.over)
        assert (before.r_on, before.zeta_1) == change.first
        assert (after.r_on, after.zeta_1) == change.second
