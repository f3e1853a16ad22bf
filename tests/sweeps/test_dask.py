"""Sweeps on a Dask cluster of separate processes, some of them killed."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

import cellcrawl as cc
from cellcrawl.sweeps.executors import InProcess
from tests.sweeps.starts import Misbehaving
from tests.sweeps.test_sweep import rows

pytest.importorskip("distributed")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.filterwarnings("ignore::ResourceWarning"),
    pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning"),
]
RUNS = 30


class Cluster:
    """A scheduler and two workers, each a process."""

    def __init__(self, folder: Path) -> None:
        self._file = folder / "scheduler.json"
        self._environment = {
            **os.environ,
            "PYTHONPATH": os.pathsep.join(path for path in sys.path if path),
        }
        self.scheduler = self._start("scheduler", "--port", "0")
        until = time.monotonic() + 60.0
        while not self._file.exists() and time.monotonic() < until:
            time.sleep(0.05)
        time.sleep(0.2)
        self.workers = [self._start("worker", "--nthreads", "1", "--no-nanny") for _ in range(2)]

    @property
    def address(self) -> str:
        import json

        return str(json.loads(self._file.read_text())["address"])

    def _start(self, what: str, *options: str) -> subprocess.Popen:
        command = [sys.executable, "-m", "dask", what, "--scheduler-file", str(self._file)]
        with self._file.with_name(f"{what}.log").open("a") as log:
            return subprocess.Popen(
                [*command, "--no-dashboard", *options],
                env=self._environment,
                stdout=log,
                stderr=log,
            )

    def end(self) -> None:
        for process in (*self.workers, self.scheduler):
            process.kill()
            process.wait()


@pytest.fixture
def cluster(tmp_path) -> Iterator[Cluster]:
    made = Cluster(tmp_path)
    yield made
    made.end()


def grid(seconds: float) -> dict:
    return {"start": [Misbehaving(seed=s, seconds=seconds) for s in range(1, RUNS + 1)]}


def once_under_way(output: Path, act) -> threading.Thread:
    """Act once two runs are made."""

    def watch() -> None:
        while True:
            found = [path.read_text() for path in output.glob("work/*.jsonl") if path.exists()]
            if sum(text.count('"row"') for text in found) >= 2 or list(output.glob("rows/*")):
                break
            time.sleep(0.02)
        act()

    thread = threading.Thread(target=watch, daemon=True)
    thread.start()
    return thread


def alone(folder: Path) -> list[dict]:
    return rows(cc.sweep(grid(0.0), folder, InProcess(), t_end=0.1))


def test_rows_are_those_of_one_process_although_a_worker_is_killed(tmp_path, cluster):
    killer = once_under_way(tmp_path / "out", cluster.workers[0].kill)
    sweep = cc.sweep(grid(0.2), tmp_path / "out", cluster.address, t_end=0.1)
    killer.join(60.0)
    assert cluster.workers[0].wait(10.0) != 0
    assert rows(sweep) == alone(tmp_path / "alone")


def test_a_killed_scheduler_ends_the_sweep_with_a_line_and_its_rows_kept(tmp_path, cluster):
    once_under_way(tmp_path / "out", cluster.scheduler.kill)
    with pytest.raises(cc.CellcrawlError, match="the same command goes on") as caught:
        cc.sweep(grid(0.2), tmp_path / "out", cluster.address, t_end=0.1)
    assert "\n" not in str(caught.value)
    cluster.end()
    cc.open_sweep(tmp_path / "out").collect()
    kept = len(cc.open_sweep(tmp_path / "out").table())
    assert 1 <= kept < RUNS  # a chunk may hold a single run
    again = cc.sweep(grid(0.0), tmp_path / "out", InProcess(), t_end=0.1)
    assert rows(again) == alone(tmp_path / "alone")


def test_a_run_that_kills_workers_is_a_row(tmp_path, cluster):
    cluster.workers += [cluster._start("worker", "--nthreads", "1") for _ in range(2)]
    starts = [Misbehaving(seed=1), Misbehaving("kill", seed=2), Misbehaving(seed=3)]
    sweep = cc.sweep({"start": starts}, tmp_path / "out", cluster.address, t_end=0.1)
    assert sweep.status().statuses == {"completed": 2, "killed": 1}


def test_a_scheduler_that_does_not_answer_is_told_in_one_line(tmp_path, monkeypatch):
    from cellcrawl.sweeps import executors

    monkeypatch.setattr(executors, "_CONNECT", "1s")
    with pytest.raises(cc.InputError, match="no Dask scheduler answers at tcp:"):
        cc.sweep(grid(0.0), tmp_path / "out", "tcp://127.0.0.1:9")
