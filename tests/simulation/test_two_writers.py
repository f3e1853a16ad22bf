"""One output, two writers; and a reader who polls."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.errors import StorageError
from cellcrawl.locks import is_locked, locked
from cellcrawl.simulation import recorder
from cellcrawl.simulation.storage import RunStore
from cellcrawl.verification.restart import different_values
from tests.simulation.test_damage import short

LONG = """
import sys
import cellcrawl as cc
from cellcrawl.simulation import recorder
recorder.BLOCK_SECONDS = 0.05
cc.simulate(cc.Parameters(r_on=26), 1000.0, solver="paper", nodes=200, output=sys.argv[1])
"""


@pytest.mark.skipif(sys.platform == "win32", reason="sends SIGTERM")
def test_a_run_that_another_process_writes_is_left_alone(tmp_path):
    path = tmp_path / "run.nc"
    child = subprocess.Popen([sys.executable, "-c", LONG, str(path)])
    try:
        until = time.monotonic() + 120.0
        while not RunStore(path).exists() and time.monotonic() < until:
            time.sleep(0.01)
        with pytest.raises(cc.InputError, match="exists"):
            short(0.1, output=path)
        for use in (
            lambda: short(0.1, output=path, overwrite=True),
            lambda: cc.resume(path, 2000.0),
        ):
            with pytest.raises(cc.InputError, match=r"another process is at work on .*run\.nc"):
                use()
    finally:
        child.send_signal(signal.SIGTERM)
    assert child.wait(60) == 0
    with cc.open_run(path) as found:
        assert found.attrs["status"] == "interrupted"
        reached = found.attrs["end_time"]
        assert np.all(np.diff(found["time"].values) > 0.0)
        assert different_values(found.load(), short(reached, nodes=200)) == 0
    assert [file.name for file in tmp_path.iterdir()] == ["run.nc"]
    assert cc.resume(path, reached + 0.5).attrs["status"] == "completed"


def test_of_two_runs_started_at_once_on_one_name_one_is_made(tmp_path):
    path = tmp_path / "run.nc"
    ready = threading.Barrier(2)
    ended: list[str] = []

    def run(seed: int) -> None:
        ready.wait()
        try:
            start = cc.RandomPerturbation(seed=seed)
            with short(1.0, output=path, start=start) as made:
                ended.append(str(made.attrs["seed"]))
        except cc.InputError as error:
            ended.append(str(error))

    threads = [threading.Thread(target=run, args=(seed,)) for seed in (1, 2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    refusals = [said for said in ended if not said.isdigit()]
    (made,) = (said for said in ended if said.isdigit())
    assert len(refusals) == 1
    assert "exists" in refusals[0] or "another process is at work" in refusals[0]
    straight = short(1.0, start=cc.RandomPerturbation(seed=int(made)))
    assert different_values(cc.open_run(path).load(), straight) == 0


@pytest.mark.parametrize("suffix", ["nc", "zarr"])
def test_a_reader_who_polls_meets_whole_runs_only(tmp_path, monkeypatch, suffix):
    monkeypatch.setattr(recorder, "BLOCK_SECONDS", 0.0)
    path = tmp_path / f"run.{suffix}"
    straight = short(0.4)
    wrong: list[object] = []
    looks = 0
    over = threading.Event()

    def poll() -> None:
        nonlocal looks
        while not over.is_set():
            try:
                with cc.open_run(path) as found:
                    records = found.sizes["time"]
                    if different_values(found.load(), straight.isel(time=slice(records))):
                        wrong.append(records)
            except cc.InputError as error:  # nothing is there at the beginning
                if "there is no run" not in str(error):
                    wrong.append(error)
            except Exception as error:
                wrong.append(error)
            looks += 1

    reader = threading.Thread(target=poll)
    reader.start()
    short(0.1, output=path).close()
    for t_end in (0.2, 0.4):
        cc.resume(path, t_end).close()
    over.set()
    reader.join()
    assert looks > 1
    assert not wrong


def test_a_lock_is_held_by_one_and_its_file_removed(tmp_path):
    path = tmp_path / "lock"
    inside, most, refused = 0, 0, 0
    counting = threading.Lock()

    def work() -> None:
        nonlocal inside, most, refused
        for _ in range(50):
            try:
                with locked(path, tmp_path, remove=True):
                    with counting:
                        inside += 1
                        most = max(most, inside)
                    time.sleep(1e-4)
                    with counting:
                        inside -= 1
            except cc.InputError:
                refused += 1

    threads = [threading.Thread(target=work) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert most == 1
    assert refused < 150
    assert not path.exists()
    assert not is_locked(path)


def test_a_file_system_without_locks_is_told_of(tmp_path, monkeypatch):
    import errno

    from filelock import FileLock

    def refuse(self: FileLock, *_: object, **__: object) -> None:
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr(FileLock, "acquire", refuse)
    with (
        pytest.warns(UserWarning, match="has no locks"),
        locked(tmp_path / "lock", tmp_path),
    ):
        pass


def test_a_link_to_a_run_is_that_run_with_its_lock(tmp_path):
    run, link = tmp_path / "run.nc", tmp_path / "latest.nc"
    p = cc.Parameters()
    cc.simulate(p, 0.1, nodes=64, output=run).close()
    link.symlink_to(run)
    cc.resume(link, t_end=0.2).close()
    assert link.is_symlink()
    assert cc.open_run(run).attrs["end_time"] == 0.2
    with locked(tmp_path / "run.nc.lock", run), pytest.raises(cc.InputError, match="at work on"):
        cc.resume(link, t_end=0.3)


def test_a_tilde_is_the_home_folder(tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("USERPROFILE", str(tmp_path))
    cc.simulate(cc.Parameters(), 0.1, nodes=64, output="~/run.nc").close()
    assert (tmp_path / "run.nc").is_file()
    assert cc.open_run("~/run.nc").attrs["status"] == "completed"
    assert cc.movie(cc.open_run("~/run.nc"), "~/run.gif", size=(64, 64)).parent == tmp_path
    with pytest.raises(cc.InputError, match="no such home folder"):
        cc.open_run("~nobody-of-that-name/run.nc")


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="there is no folder without files")
def test_a_folder_that_takes_no_file_is_not_called_held_by_another():
    lock, run = Path("/proc/run.nc.lock"), Path("/proc/run.nc")
    with pytest.raises(StorageError, match="cannot write in /proc"), locked(lock, run):
        pass
