"""Files that were damaged, edited, lost or written by another version: one line, never a lie."""

from __future__ import annotations

import random
import shutil
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr

import cellcrawl as cc
from cellcrawl.simulation import recorder
from cellcrawl.simulation.storage import RunStore
from cellcrawl.verification.restart import different_values

OLD = Path(__file__).parents[1] / "old_files"
FLIPS = 25  # of bits, over each kind of file


def short(t_end: float = 0.3, **options) -> xr.Dataset:
    options = {"solver": "paper", "nodes": 48, **options}
    return cc.simulate(cc.Parameters(r_on=26), t_end, **options)


def killed(path: Path, monkeypatch, **options) -> None:
    """Leave the blocks of a run that never ended."""

    def stop(*_: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(recorder, "BLOCK_SECONDS", 0.0)
        patch.setattr(RunStore, "finish", stop)
        with pytest.raises(KeyboardInterrupt):
            short(0.2, output=path, **options)


def content(path: Path) -> tuple[xr.Dataset, dict[str, np.ndarray]]:
    with cc.open_run(path) as run:
        return run.load(), RunStore(path).checkpoint()


def same(one, other) -> bool:
    return one[0].identical(other[0]) and all(
        np.array_equal(one[1][name], other[1][name]) for name in one[1] | other[1]
    )


def read_or_refused(path: Path, whole) -> str | None:
    """Return why a file is refused; None if it reads as it was."""
    try:
        assert same(content(path), whole)
    except cc.StorageError as error:
        return str(error)
    return None


def start(path: Path) -> cc.CellState:
    return cc.FromRun(path).state(cc.Parameters(), 48)


def one_line_about(path: Path, error: BaseException) -> bool:
    return "\n" not in str(error) and str(path) in str(error)


@pytest.mark.parametrize("kind", ["nc", "zarr", "part"])
@pytest.mark.parametrize("solver", ["paper", "adaptive"])
def test_a_flipped_bit_changes_nothing_readable_or_is_refused(tmp_path, monkeypatch, kind, solver):
    path = tmp_path / f"run.{'zarr' if kind == 'zarr' else 'nc'}"
    if kind == "part":
        killed(path, monkeypatch, solver=solver)
    else:
        short(output=path, solver=solver).close()
    files = [file for file in tmp_path.rglob("*") if file.is_file()]
    whole = content(path)
    chance = random.Random(f"{kind} {solver}")
    refused = 0
    for _ in range(FLIPS):
        file = chance.choices(files, [file.stat().st_size for file in files])[0]
        good = file.read_bytes()
        damaged = bytearray(good)
        damaged[chance.randrange(len(good))] ^= 1 << chance.randrange(8)
        file.write_bytes(damaged)
        said = read_or_refused(path, whole)
        assert said is None or (str(tmp_path) in said and "\n" not in said)
        refused += said is not None
        file.write_bytes(good)
    assert refused > FLIPS // 2
    assert same(content(path), whole)


@pytest.mark.parametrize("suffix", ["nc", "zarr"])
def test_a_file_cut_short_is_refused(tmp_path, suffix):
    path = tmp_path / f"run.{suffix}"
    short(output=path).close()
    file = path if suffix == "nc" else path / "x" / "c" / "0" / "0"
    file.write_bytes(file.read_bytes()[:-100])
    with pytest.raises(cc.StorageError) as caught:
        cc.open_run(path).load()
    assert one_line_about(path, caught.value)


def test_a_missing_file_of_a_store_is_refused_and_not_read_as_zeros(tmp_path):
    path = tmp_path / "run.zarr"
    short(output=path).close()
    (path / "tension" / "c" / "0").unlink()
    with pytest.raises(cc.StorageError, match="files of 'tension' are missing"):
        cc.open_run(path)


@pytest.mark.parametrize("from_file", ["new", "old"])
@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("save_every", 0.0),
        ("save_every", np.nan),
        ("status", None),
        ("status", "well"),
        ("schema_version", "x"),
        ("schema_version", 99),
        ("parameters", "{"),
        ("solver_options", "[1]"),
        ("records_on_grid", -1),
        ("end_time", "now"),
        ("diagnostics", None),
    ],
)
def test_an_edited_attribute_is_named(tmp_path, name, value, from_file):
    path = tmp_path / "run.nc"
    if from_file == "old":
        shutil.copy(OLD / "run-0.1.0.nc", path)
    else:
        short(0.1, output=path).close()
    with h5py.File(path, "a") as file:
        del file.attrs[name]
        if value is not None:
            file.attrs[name] = value
    for use in (cc.open_run, lambda path: cc.resume(path, 1.0), start):
        with pytest.raises(cc.StorageError) as caught:
            use(path)
        assert one_line_about(path, caught.value)
        assert name in str(caught.value) or "newer cellcrawl" in str(caught.value)


@pytest.mark.parametrize("from_file", ["new", "old"])
@pytest.mark.parametrize("place", ["checkpoint/fields", "x"])
def test_a_run_with_a_nan_in_its_edge_or_its_state_is_not_resumed(tmp_path, place, from_file):
    path = tmp_path / "run.nc"
    if from_file == "old":
        shutil.copy(OLD / "run-0.1.0.nc", path)
    else:
        short(output=path).close()
    with h5py.File(path, "a") as file:
        file[place][0, 3] = np.nan
    with pytest.raises(cc.StorageError) as caught:
        cc.resume(path, 1.0)
    assert one_line_about(path, caught.value)


def test_a_copy_saved_by_xarray_opens_and_says_why_it_cannot_be_resumed(tmp_path):
    run = short()
    run.to_netcdf(tmp_path / "copy.nc", engine="h5netcdf")
    copy = tmp_path / "copy.nc"
    assert different_values(cc.open_run(copy).load(), run) == 0
    with pytest.raises(cc.StorageError, match="no state to go on from"):
        cc.resume(copy, 1.0)
    assert short(0.1, start=cc.FromRun(copy)).attrs["status"] == "completed"


@pytest.mark.parametrize("which", ["all", "first"])
def test_blocks_that_vanish_end_the_run_and_are_named(tmp_path, monkeypatch, which):
    path = tmp_path / "run.nc"
    monkeypatch.setattr(recorder, "BLOCK_SECONDS", 0.0)
    write, written = RunStore.write_block, []

    def write_and_lose(store: RunStore, first: int, *rest: object) -> None:
        write(store, first, *rest)
        written.append(first)
        if len(written) == 2:
            shutil.rmtree(store.part) if which == "all" else store._blocks()[0].unlink()

    monkeypatch.setattr(RunStore, "write_block", write_and_lose)
    with pytest.raises(cc.StorageError, match=r"records 0 to \d+ of .* have gone") as caught:
        short(0.5, output=path)
    assert one_line_about(path, caught.value)
    assert not path.exists()


def test_only_a_run_is_overwritten(tmp_path):
    notes = tmp_path / "notes.zarr"
    notes.mkdir()
    (notes / "thesis.txt").write_text("years of work")
    table = tmp_path / "table.nc"
    xr.Dataset({"a": ("b", [1.0])}).to_netcdf(table, engine="h5netcdf")
    part = tmp_path / "other.nc.part"
    part.mkdir()
    (part / "data.csv").write_text("t,x,y")
    for path in (notes, table, tmp_path / "other.nc"):
        with pytest.raises(cc.InputError, match="not overwritten"):
            short(0.1, output=path, overwrite=True)
    assert (notes / "thesis.txt").exists()
    assert table.exists()
    assert (part / "data.csv").exists()


def test_a_killed_run_is_overwritten_when_asked(tmp_path, monkeypatch):
    path = tmp_path / "run.nc"
    killed(path, monkeypatch)
    short(0.1, output=path, overwrite=True).close()
    assert [found.name for found in tmp_path.iterdir()] == ["run.nc"]


def test_runs_of_version_0_1_0_open_and_go_on(tmp_path):
    path = tmp_path / "run.nc"
    shutil.copy(OLD / "run-0.1.0.nc", path)
    old = cc.open_run(path).load()
    assert float(old["tension"][-1]) == 891.0203467480438
    resumed = cc.resume(path, 0.5)
    assert different_values(resumed.isel(time=slice(4)).load(), old) == 0
    assert resumed.attrs["schema_version"] == 2
    assert resumed.attrs["status"] == "completed"


def test_a_run_that_version_0_1_0_left_in_blocks_opens_and_goes_on(tmp_path):
    shutil.copytree(OLD / "killed-0.1.0.nc.part", tmp_path / "run.nc.part")
    path = tmp_path / "run.nc"
    with cc.open_run(path) as found:
        assert found.attrs["status"] == "running"
        records = found.sizes["time"]
        assert different_values(cc.resume(path, 0.3).isel(time=slice(records)).load(), found) == 0


@pytest.mark.parametrize("suffix", ["nc", "zarr"])
def test_variables_and_attributes_of_the_user_survive_a_resume(tmp_path, suffix):
    path = tmp_path / f"run.{suffix}"
    with short(output=path) as run:
        mine = run.load().drop_vars([*run.data_vars, "time"])
    mine["marked"] = ("time", np.arange(4.0))
    mine["along"] = ("node", np.arange(48))
    mine["scan"] = (("time", "pixel"), np.ones((4, 3)))
    mine.attrs["plate"] = "B7"
    if suffix == "nc":
        mine.to_netcdf(path, mode="a", engine="h5netcdf")
    else:
        mine.to_zarr(path, mode="a", consolidated=False)
    for t_end, records in ((0.5, 6), (0.6, 7)):
        with cc.resume(path, t_end) as resumed:
            assert resumed["marked"].values[:4].tolist() == [0.0, 1.0, 2.0, 3.0]
            assert np.isnan(resumed["marked"].values[4:]).all()
            assert resumed["scan"].shape == (records, 3)
            assert resumed["along"].values.tolist() == list(range(48))
            assert resumed.attrs["plate"] == "B7"
            assert different_values(resumed[list(short().variables)], short(t_end)) == 0
