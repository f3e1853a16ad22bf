"""Runs on disk: blocks, kills, resumes to the same bits."""

from __future__ import annotations

import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import xarray as xr

import cellcrawl as cc
from cellcrawl.simulation import recorder
from cellcrawl.simulation.storage import RunStore
from cellcrawl.verification.restart import different_values, fixed_attributes

RUN = """
import sys
import cellcrawl as cc
from cellcrawl.simulation import recorder
recorder.BLOCK_SECONDS = 0.05
cc.simulate(cc.Parameters(r_on=26), float(sys.argv[2]), solver="paper", nodes=200, save_every=0.05,
            output=sys.argv[1])
"""


SOLVERS = pytest.mark.parametrize("solver", ["paper", "adaptive", "spline"])


def short(t_end: float, **options) -> xr.Dataset:
    return cc.simulate(
        cc.Parameters(r_on=26), t_end, **{"solver": "paper", "nodes": 100, **options}
    )


def same_bits(first: xr.Dataset, second: xr.Dataset) -> bool:
    return different_values(first, second) == 0


@pytest.mark.parametrize("suffix", ["nc", "zarr"])
def test_a_saved_run_reads_back_as_it_was(tmp_path, suffix):
    saved = short(0.55, output=tmp_path / f"run.{suffix}")
    assert same_bits(saved.load(), short(0.55))
    assert fixed_attributes(saved) == fixed_attributes(short(0.55))
    assert [path.name for path in tmp_path.iterdir()] == [f"run.{suffix}"]


@SOLVERS
@pytest.mark.parametrize(
    ("suffix", "halfway", "save_every"),
    [
        ("nc", 0.5, 0.1),
        ("nc", 0.52, 0.1),
        ("nc", 0.3337, 0.1),
        ("nc", 0.5003, 0.00037),
        ("zarr", 0.3337, 0.1),
        pytest.param("zarr", 0.5003, 0.00037, marks=pytest.mark.slow),
    ],
)
def test_resumed_run_has_the_bits_of_an_uninterrupted_one(
    tmp_path, solver, suffix, halfway, save_every
):
    path = tmp_path / f"run.{suffix}"
    schedule = cc.Schedule({"r_on": [(0.2, 26.0), (0.4, 40.0), (0.7, 40.0), (0.7, 20.0)]})
    options = {"save_every": save_every, "schedule": schedule, "solver": solver}
    short(halfway, output=path, **options).close()
    resumed = cc.resume(path, 1.0)
    straight = short(1.0, **options)
    assert same_bits(resumed, straight)
    assert fixed_attributes(resumed) == fixed_attributes(straight)


@SOLVERS
def test_resuming_many_times_changes_nothing(tmp_path, solver):
    path = tmp_path / "run.nc"
    short(0.1, output=path, solver=solver).close()
    for t_end in (0.2, 0.25, 0.5):
        cc.resume(path, t_end).close()
    assert same_bits(cc.open_run(path), short(0.5, solver=solver))


@SOLVERS
def test_writing_blocks_does_not_change_the_run(tmp_path, monkeypatch, solver):
    monkeypatch.setattr(recorder, "BLOCK_SECONDS", 0.0)
    written = short(0.5, output=tmp_path / "run.nc", solver=solver)
    assert same_bits(written, short(0.5, solver=solver))


def test_resume_where_it_ended_returns_the_run_and_before_is_refused(tmp_path):
    path = tmp_path / "run.nc"
    first = short(0.5, output=path).load()
    assert same_bits(cc.resume(path, 0.5), first)
    with pytest.raises(cc.InputError, match=r"reached t = 0\.5 already"):
        cc.resume(path, 0.4)


@pytest.mark.parametrize("kills", [3, pytest.param(20, marks=pytest.mark.slow)])
def test_killed_at_any_moment_a_run_opens_and_resumes(tmp_path, kills):
    straight = cc.simulate(cc.Parameters(r_on=26), 3.0, solver="paper", nodes=200, save_every=0.05)
    chance = random.Random(20)
    for attempt in range(kills):
        path = tmp_path / f"run-{attempt}.nc"
        child = subprocess.Popen([sys.executable, "-c", RUN, str(path), "3.0"])
        patience = time.monotonic() + 60.0
        while not RunStore(path).exists() and time.monotonic() < patience:
            time.sleep(0.002)
        time.sleep(chance.uniform(0.0, 0.4))
        child.send_signal(signal.SIGKILL)
        child.wait()
        with cc.open_run(path) as found:
            records = found.sizes["time"]
            assert records >= 1
            assert same_bits(found.load(), straight.isel(time=slice(records)))
            assert found.attrs["status"] in ("running", "completed")
        assert same_bits(cc.resume(path, 3.0), straight)


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
def test_a_stop_request_keeps_what_was_computed(tmp_path, name):
    path = tmp_path / "run.nc"
    child = subprocess.Popen([sys.executable, "-c", RUN, str(path), "1000"])
    while not RunStore(path).exists():
        time.sleep(0.01)
    time.sleep(0.2)
    child.send_signal(getattr(signal, name))
    assert child.wait(timeout=60) == 0
    with cc.open_run(path) as found:
        assert found.attrs["status"] == "interrupted"
        assert "t = " in found.attrs["status_message"]
        end = found.attrs["end_time"]
        assert float(found["time"][-1]) == pytest.approx(end)
    assert cc.resume(path, end + 0.5).attrs["status"] == "completed"


def test_a_full_disk_leaves_what_was_written_readable(tmp_path):
    path = tmp_path / "run.nc"
    limited = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (200_000, 200_000))\n"
    limited += RUN.replace("nodes=200", "nodes=400").replace("0.05\n", "0.3\n")
    result = subprocess.run(
        [sys.executable, "-c", limited, str(path), "30"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert "StorageError: cannot write" in result.stderr
    assert "resume" in result.stderr
    with cc.open_run(path) as found:
        reached = float(found["time"][-1])
    assert cc.resume(path, reached + 0.5).attrs["status"] == "completed"


def test_an_existing_run_is_not_overwritten_unless_asked(tmp_path):
    path = tmp_path / "run.nc"
    short(0.1, output=path).close()
    with pytest.raises(cc.InputError, match="exists"):
        short(0.1, output=path)
    assert short(0.2, output=path, overwrite=True).sizes["time"] == 3


def test_damaged_foreign_and_newer_files_are_named(tmp_path):
    damaged = tmp_path / "damaged.nc"
    damaged.write_bytes(b"not a netCDF file")
    cut, folder, empty = (tmp_path / name for name in ("cut.nc", "folder.nc", "empty.zarr"))
    folder.mkdir()
    empty.mkdir()
    short(0.1, output=tmp_path / "whole.nc").close()
    cut.write_bytes((tmp_path / "whole.nc").read_bytes()[:5000])
    foreign = tmp_path / "foreign.nc"
    xr.Dataset({"a": ("b", [1.0])}).to_netcdf(foreign, engine="h5netcdf")
    newer = tmp_path / "newer.nc"
    run = short(0.1)
    run.attrs["schema_version"] = 99
    run.to_netcdf(newer, engine="h5netcdf")
    for path, kind, says in [
        (damaged, cc.StorageError, "is damaged: it is no netCDF-4 file; restore it"),
        (cut, cc.StorageError, "is damaged: it is cut short"),
        (folder, cc.StorageError, "is damaged: it is no netCDF-4 file"),
        (empty, cc.StorageError, "is damaged: it is no Zarr store"),
        (foreign, cc.InputError, "not a cellcrawl run"),
        (newer, cc.StorageError, "newer cellcrawl"),
        (tmp_path / "absent.nc", cc.InputError, "no run"),
    ]:
        with pytest.raises(kind, match=says) as caught:
            cc.open_run(path)
        assert "\n" not in str(caught.value)


@pytest.mark.slow
def test_memory_stays_flat_in_the_length_of_the_run(tmp_path):
    script = RUN + "import resource; print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)\n"
    script = script.replace("save_every=0.05", "save_every=0.002").replace("nodes=200", "nodes=400")

    def peak(t_end: float) -> int:
        arguments = [sys.executable, "-c", script, str(tmp_path / f"{t_end}.nc"), str(t_end)]
        return int(subprocess.run(arguments, capture_output=True, check=True, text=True).stdout)

    short_run, long_run = peak(2.0), peak(12.0)
    written = Path(tmp_path / "12.0.nc").stat().st_size // 1024
    assert written > 100_000  # kB: the long run alone holds far more than it may cost
    assert long_run - short_run < 0.3 * written
