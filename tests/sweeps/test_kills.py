"""Workers and drivers killed, disks full, Ctrl-C: nothing is lost and nothing is made twice."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import cellcrawl as cc
from cellcrawl.sweeps.executors import InProcess
from cellcrawl.sweeps.journal import read_journal
from tests.sweeps.starts import Misbehaving
from tests.sweeps.test_sweep import rows

SWEEP = """
import sys
import cellcrawl as cc
from cellcrawl.sweeps.journal import read_journal
from tests.sweeps.starts import Misbehaving

starts = [Misbehaving(seed=s, seconds=0.1) for s in range(1, int(sys.argv[2]) + 1)]
sweep = cc.sweep({"start": starts}, sys.argv[1], t_end=0.1, workers=2)
sys.exit(130 if sweep.interrupted else 0)
"""


def started(output: Path, runs: int) -> subprocess.Popen:
    # A script with no `if __name__ == "__main__"`, as users write them.
    script = output.with_name("script.py")
    script.write_text(SWEEP)
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    command = [sys.executable, str(script), str(output), str(runs)]
    with output.with_name("said").open("w") as said:
        return subprocess.Popen(command, env=environment, stderr=said)


def grid(runs: int) -> dict:
    return {"start": [Misbehaving(seed=s) for s in range(1, runs + 1)]}


def wait_for_rows(output: Path, process: subprocess.Popen) -> None:
    until = time.monotonic() + 60.0
    while time.monotonic() < until:
        assert process.poll() is None, output.with_name("said").read_text()
        if sum(line.count('"row"') for line in journals(output)) >= 2:
            return
        time.sleep(0.02)
    raise AssertionError("no run was made within a minute")


def journals(output: Path) -> list[str]:
    return [path.read_text() for path in output.glob("work/*.jsonl") if path.exists()]


def workers_of(process: subprocess.Popen) -> list[int]:
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    return [
        int(pid)
        for pid in children
        if "spawn_main" in Path(f"/proc/{pid}/cmdline").read_text().replace("\0", " ")
    ]


def in_one_process(runs: int, folder: Path) -> list[dict]:
    return rows(cc.sweep(grid(runs), folder, InProcess(), t_end=0.1))


linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")


@linux
def test_a_killed_worker_costs_nothing_but_its_present_run(tmp_path):
    process = started(tmp_path / "out", 24)
    wait_for_rows(tmp_path / "out", process)
    os.kill(workers_of(process)[0], signal.SIGKILL)
    assert process.wait(120) == 0, (tmp_path / "said").read_text()
    made = rows(cc.open_sweep(tmp_path / "out"))
    assert len(made) == 24
    assert {row["status"] for row in made} == {"completed"}
    assert made == in_one_process(24, tmp_path / "alone")
    assert not list((tmp_path / "out" / "work").glob("*.jsonl"))


@linux
def test_a_killed_driver_leaves_rows_and_no_workers(tmp_path):
    process = started(tmp_path / "out", 24)
    wait_for_rows(tmp_path / "out", process)
    workers = workers_of(process)
    assert len(workers) == 2
    process.kill()
    process.wait()
    until = time.monotonic() + 20.0
    while any(Path(f"/proc/{pid}").exists() for pid in workers) and time.monotonic() < until:
        time.sleep(0.05)
    assert not any(Path(f"/proc/{pid}").exists() for pid in workers)
    left = [read_journal(path) for path in (tmp_path / "out" / "work").glob("*.jsonl")]
    sweep = cc.open_sweep(tmp_path / "out")
    made = {row["key"] for entries in left for row in entries.rows}
    made |= {row["key"] for row in sweep.rows()}
    assert len(made) >= 2
    sweep.collect()
    assert made == {row["key"] for row in sweep.rows()}
    again = cc.sweep(grid(24), tmp_path / "out", InProcess(), t_end=0.1)
    assert rows(again) == in_one_process(24, tmp_path / "alone")


@linux
def test_ctrl_c_keeps_what_was_done(tmp_path):
    process = started(tmp_path / "out", 200)
    wait_for_rows(tmp_path / "out", process)
    process.send_signal(signal.SIGINT)
    assert process.wait(60) == 130, (tmp_path / "said").read_text()
    sweep = cc.open_sweep(tmp_path / "out")
    assert 2 <= sweep.status().done < 200
    assert {row["status"] for row in sweep.rows()} == {"completed"}
    assert not list((tmp_path / "out" / "work").glob("*.jsonl"))
    assert not list((tmp_path / "out" / "work").glob("halt*"))


def test_a_run_that_kills_its_worker_three_times_is_a_row(tmp_path):
    starts = [Misbehaving(seed=s) for s in range(1, 7)]
    starts[2] = Misbehaving("kill", seed=3)
    starts[3] = Misbehaving("kill", seed=4, once=str(tmp_path / "mark"))
    sweep = cc.sweep({"start": starts}, tmp_path / "out", workers=2, t_end=0.1)
    found = {json.loads(row["start"])["seed"]: row for row in sweep.rows()}
    assert {seed: row["status"] for seed, row in found.items()} == {
        1: "completed",
        2: "completed",
        3: "killed",
        4: "completed",
        5: "completed",
        6: "completed",
    }
    assert "died 3 times" in found[3]["message"]


FULL = """
import resource, sys
import cellcrawl as cc
from cellcrawl.sweeps.executors import InProcess
from cellcrawl.sweeps.journal import read_journal
from tests.sweeps.starts import Misbehaving

starts = [Misbehaving(seed=s) for s in range(1, 21)]
cc.simulate(t_end=0.1)
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[2]), resource.RLIM_INFINITY))
try:
    cc.sweep({"start": starts}, sys.argv[1], InProcess(), t_end=0.1, keep=sys.argv[3])
except cc.StorageError as error:
    print(error)
    sys.exit(3)
"""


@pytest.mark.parametrize(("keep", "limit"), [("rows", 5000), ("fields", 20_000)])
def test_a_full_disk_stops_the_sweep_with_a_line_and_keeps_the_rows(tmp_path, keep, limit):
    pytest.importorskip("resource")
    output = tmp_path / "out"
    done = subprocess.run(
        [sys.executable, "-c", FULL, str(output), str(limit), keep],
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 3, done.stderr
    assert done.stdout.startswith("cannot write ")
    assert "the same command goes on" in done.stdout
    assert done.stdout.count("\n") == 1
    assert not list(output.rglob("*.tmp"))
    before = len(cc.open_sweep(output).table())
    starts = [Misbehaving(seed=s) for s in range(1, 21)]
    again = cc.sweep({"start": starts}, output, InProcess(), t_end=0.1, keep=keep)
    assert before <= again.status().done == 20
    assert again.status().statuses == {"completed": 20}
