"""Sweeps: rows, resuming, the bits of a run, results, folders that are not ours."""

from __future__ import annotations

import json
import tracemalloc
from pathlib import Path

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.sweeps import dispatch, store, worker
from cellcrawl.sweeps.executors import InProcess
from cellcrawl.sweeps.identity import run_key
from cellcrawl.sweeps.parts import COLUMNS
from cellcrawl.sweeps.store import checksum
from cellcrawl.sweeps.worker import Outcome
from tests.sweeps.starts import Misbehaving

AXES = {"r_on": [20, 30], "zeta_1": [500, 600], "seed": [1, 2]}
DONE = {"status": "completed"}
VARYING = ("wall_time", "part")


def quick(grid, output, **options):
    return cc.sweep(grid, output, InProcess(), **{"t_end": 0.2, **options})


def rows(sweep: cc.Sweep) -> list[dict]:
    """Rows in order of key, without what may differ."""
    found = [{n: v for n, v in row.items() if n not in VARYING} for row in sweep.rows()]
    return sorted(found, key=lambda row: row["key"])


def contents(folder: Path) -> dict[str, bytes]:
    return {str(path): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.fixture
def counted(monkeypatch):
    """The runs made, one key each."""
    made = []
    original = worker.execute

    def count(run, keep):
        made.append(run_key(run, keep))
        return original(run, keep)

    monkeypatch.setattr(worker, "execute", count)
    return made


def test_each_run_has_one_row_with_what_was_asked_and_how_it_ended(tmp_path):
    sweep = quick(AXES, tmp_path / "out")
    table = sweep.table()
    assert table.column_names == list(COLUMNS)
    assert len(table) == 8
    asked = {(row["r_on"], row["zeta_1"], row["seed"]) for row in table.to_pylist()}
    assert asked == {(r, z, s) for r in (20, 30) for z in (500, 600) for s in (1, 2)}
    for row in table.to_pylist():
        assert (row["status"], row["end_time"], row["t_end"]) == ("completed", 0.2, 0.2)
        assert row["wall_time"] > 0.0
    assert sweep.status().done == sweep.status().runs == 8


def test_a_second_time_nothing_is_run(tmp_path, counted):
    first = quick(AXES, tmp_path / "out")
    before = contents(tmp_path)
    assert len(counted) == 8
    second = quick(AXES, tmp_path / "out")
    assert len(counted) == 8
    assert rows(first) == rows(second)
    assert contents(tmp_path) == before


def test_missing_runs_alone_are_made(tmp_path, counted):
    complete = rows(quick(AXES, tmp_path / "out"))
    lost = sorted((tmp_path / "out" / "rows").iterdir())[0]
    lost.unlink()
    missing = 8 - len(cc.open_sweep(tmp_path / "out").table())
    assert missing > 0
    counted.clear()
    assert rows(quick(AXES, tmp_path / "out")) == complete
    assert len(counted) == missing


def test_a_run_has_the_bits_of_simulate_whatever_is_kept(tmp_path):
    axes = {"r_on": [26], "seed": [3]}
    alone = cc.simulate(cc.Parameters(r_on=26), 6.0, start=cc.RandomPerturbation(seed=3))
    by_keep = {keep: quick(axes, tmp_path / keep, t_end=6.0, keep=keep) for keep in store.KEEP}
    fields = by_keep["fields"].run(r_on=26)
    tracks = by_keep["tracks"].run(seed=3)
    for name in alone.variables:
        assert np.array_equal(fields[name].values, alone[name].values), name
    for name in ("time", "centroid_x", "centroid_y", "tension", "length", "area"):
        assert np.array_equal(tracks[name].values, alone[name].values), name
    assert set(fields.attrs) == set(tracks.attrs) == set(alone.attrs)
    measured = [
        {name: row[name] for name in row if name not in ("key", *VARYING)}
        for keep in store.KEEP
        for row in rows(by_keep[keep])
    ]
    assert measured[0] == measured[1] == measured[2]
    assert measured[0]["tension"] == pytest.approx(alone["tension"].sel(time=slice(4.95, 7)).mean())
    with pytest.raises(cc.InputError, match="keeps rows only"):
        by_keep["rows"].run(r_on=26)


def test_a_torn_cell_ends_where_it_does_alone(tmp_path):
    axes = {"r_on": [16], "zeta_1": [600], "seed": [6]}
    row = rows(quick(axes, tmp_path / "out", t_end=20.0))[0]
    alone = cc.simulate(cc.Parameters(r_on=16), 20.0, start=cc.RandomPerturbation(seed=6))
    assert alone.attrs["status"] == "fragmented"
    assert (row["status"], row["mode"]) == ("fragmented", "fragmented")
    assert row["message"] == alone.attrs["status_message"]
    assert row["end_time"] == alone.attrs["end_time"]


def test_a_failing_run_is_a_row_with_its_reason_and_spares_the_others(tmp_path):
    starts = [Misbehaving(seed=1), Misbehaving("raise", seed=2), Misbehaving(seed=3)]
    sweep = quick({"start": starts}, tmp_path / "out")
    status = sweep.status()
    assert status.statuses == {"completed": 2, "failed": 1}
    (failed,) = [row for row in sweep.rows() if row["status"] == "failed"]
    assert failed["message"] == "RuntimeError: this start is broken"
    assert json.loads(failed["start"])["seed"] == 2
    assert failed["mode"] is None
    assert sweep.failures() == {"RuntimeError: this start is broken": 1}


def test_failed_runs_are_made_again_only_if_asked(tmp_path):
    starts = [Misbehaving("raise", seed=2, once=str(tmp_path / "mark"))]
    assert quick({"start": starts}, tmp_path / "out").status().statuses == {"failed": 1}
    assert quick({"start": starts}, tmp_path / "out").status().statuses == {"failed": 1}
    again = quick({"start": starts}, tmp_path / "out", retry=True)
    assert again.status().statuses == {"completed": 1}


def test_parts_of_a_job_array_make_each_run_once(tmp_path, counted):
    parts = [quick(AXES, tmp_path / "parts", part=(i, 3)) for i in range(3)]
    assert len(counted) == len(set(counted)) == 8
    assert rows(parts[-1]) == rows(quick(AXES, tmp_path / "whole"))
    assert rows(quick(AXES, tmp_path / "parts")) == rows(parts[0])
    assert len(counted) == 16


def test_results_lie_on_the_axes_of_the_grid(tmp_path):
    dataset = quick(AXES, tmp_path / "out", t_end=1.0).to_dataset()
    assert dict(dataset.sizes) == {"r_on": 2, "zeta_1": 2, "seed": 2}
    parameters = cc.Parameters(r_on=30, zeta_1=500)
    alone = cc.simulate(parameters, 1.0, start=cc.RandomPerturbation(seed=2))
    late = alone["tension"].sel(time=slice(0.5, None))
    cell = dataset.sel(r_on=30, zeta_1=500, seed=2)
    assert float(cell["tension_high"]) == float(late.max())
    assert (dataset["status"] == "completed").all()


def test_runs_not_made_yet_are_missing_and_not_a_number(tmp_path):
    sweep = quick(AXES, tmp_path / "out", part=(0, 2))
    dataset = sweep.to_dataset()
    assert (sweep.status().runs, sweep.status().done) == (8, 4)
    assert (dataset["status"] == "missing").sum() == 4
    assert np.isnan(dataset["end_time"].values).sum() == 4


def test_points_are_one_dimension(tmp_path):
    points = [{"r_on": 16, "zeta_1": 600}, {"r_on": 56, "zeta_1": 560}]
    grid = cc.Grid(points=points, axes={"seed": [1, 2]}, t_end=0.1)
    dataset = cc.sweep(grid, tmp_path / "out", InProcess()).to_dataset()
    assert dict(dataset.sizes) == {"point": 2, "seed": 2}
    assert dataset["zeta_1"].values.tolist() == [600, 560]


def test_a_folder_reads_without_its_grid(tmp_path):
    made = quick(AXES, tmp_path / "out")
    assert cc.open_sweep(tmp_path / "out").to_dataset().equals(made.to_dataset())


def test_a_grid_extends_another_only_if_asked(tmp_path, counted):
    quick(AXES, tmp_path / "out")
    wider = {**AXES, "seed": [1, 2, 3]}
    before = contents(tmp_path)
    with pytest.raises(cc.InputError, match="holds another grid, of 8 runs"):
        quick(wider, tmp_path / "out")
    assert contents(tmp_path) == before
    extended = quick(wider, tmp_path / "out", extend=True)
    assert len(counted) == 12
    assert (extended.status().runs, extended.status().done) == (12, 12)
    assert dict(extended.to_dataset().sizes)["seed"] == 3


@pytest.mark.parametrize(
    ("spoil", "error", "says"),
    [
        (lambda out: change(out, code="0.0.1+0"), cc.InputError, "another version"),
        (lambda out: change(out, keep="fields"), cc.InputError, "keeps fields, not rows"),
        (lambda out: change(out, schema=99), cc.StorageError, "newer cellcrawl"),
        (lambda out: (out / "sweep.json").write_text("{"), cc.StorageError, "is damaged"),
        (lambda out: (out / "sweep.json").unlink(), cc.InputError, "holds no sweep"),
        (lambda out: cut(out), cc.StorageError, "delete it"),
    ],
)
def test_a_folder_that_is_not_ours_or_damaged_is_left_as_it_is(tmp_path, spoil, error, says):
    quick(AXES, tmp_path / "out")
    spoil(tmp_path / "out")
    before = contents(tmp_path)
    with pytest.raises(error, match=says) as caught:
        quick(AXES, tmp_path / "out")
    assert "\n" not in str(caught.value)
    assert contents(tmp_path) == before


def change(out: Path, **values) -> None:
    path = out / "sweep.json"
    changed = {**json.loads(path.read_text()), **values}
    del changed["checksum"]
    path.write_text(json.dumps({**changed, "checksum": checksum(changed)}))


def cut(out: Path) -> None:
    path = sorted((out / "rows").iterdir())[0]
    path.write_bytes(path.read_bytes()[:-50])


def test_deleting_a_damaged_part_mends_the_sweep(tmp_path):
    complete = rows(quick(AXES, tmp_path / "out"))
    cut(tmp_path / "out")
    sorted((tmp_path / "out" / "rows").iterdir())[0].unlink()
    assert rows(quick(AXES, tmp_path / "out")) == complete


def test_two_drivers_do_not_work_on_one_folder(tmp_path):
    quick(AXES, tmp_path / "out")
    held = store.SweepStore(tmp_path / "out")
    with held.locked("sweep"), pytest.raises(cc.InputError, match="another process is at work"):
        quick(AXES, tmp_path / "out")
    quick(AXES, tmp_path / "out")


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"keep": "everything"}, "keep = 'everything'"),
        ({"workers": 0}, "workers = 0"),
        ({"executor": 3}, "executor must be"),
        ({"part": (3, 3)}, "part = 3"),
    ],
)
def test_options_that_cannot_be_are_refused(tmp_path, options, says):
    with pytest.raises(cc.InputError, match=says):
        cc.sweep(AXES, tmp_path / "out", **{"t_end": 0.1, **options})


def test_the_driver_holds_no_rows(tmp_path):
    grid = cc.Grid(axes={"seed": {"from": 1, "to": 4000, "step": 1}})
    place = store.SweepStore(tmp_path / "out")
    place.take(grid, "rows", extend=False)
    todo = dispatch.Todo(grid, range(len(grid)), "rows", set())
    team = dispatch.Dispatcher(place, InProcess(), "rows", "sweep", lambda run, keep: Outcome(DONE))
    peaks = []
    tracemalloc.start()
    for left in (2000, 0):
        part = Until(todo, left)
        team.work(part, dispatch.RunsBar(False, 1, 1))
        peaks.append(tracemalloc.get_traced_memory()[0])
    tracemalloc.stop()
    assert len(cc.open_sweep(tmp_path / "out").table(["key"])) == 4000
    assert peaks[1] - peaks[0] < 200_000


class Until:
    """Gives out runs of another until some are left."""

    def __init__(self, todo: dispatch.Todo, leave: int) -> None:
        self._todo, self._leave = todo, leave

    @property
    def left(self) -> int:
        return self._todo.left - self._leave

    def take(self, count: int):
        return self._todo.take(min(count, self.left))
