"""The law of the guide, as its reader saves it, in 100 runs: killed, resumed, on Dask."""

from __future__ import annotations

import importlib
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import cellcrawl as cc
from tests.sweeps.test_dask import Cluster
from tests.sweeps.test_sweep import rows

pytestmark = [
    pytest.mark.slow,
    pytest.mark.filterwarnings("ignore::ResourceWarning"),
    pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning"),
]
GUIDE = Path(__file__).parents[2] / "docs" / "laws.md"
GRID = {"r_on": [16, 21, 26, 31, 36], "zeta_1": [500, 540, 560, 580, 600], "seed": [1, 2, 3, 4]}
DRIVER = f"""
import sys
import cellcrawl as cc
from force_on_rate import ForceOnRate

cc.sweep({GRID!r}, sys.argv[1], workers=2, t_end=20.0, laws=ForceOnRate(gain=0.05))
"""


@pytest.fixture
def law(tmp_path, monkeypatch) -> cc.laws.Law:
    """The guide's law, imported from the file it says to write, which workers find as well."""
    [code] = re.findall(r"```python\n# force_on_rate.py\n(.*?)```", GUIDE.read_text("utf-8"), re.S)
    (tmp_path / "force_on_rate.py").write_text(code, encoding="utf-8")
    (tmp_path / "driver.py").write_text(DRIVER, encoding="utf-8")
    folders = [str(tmp_path), *(path for path in sys.path if path)]
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(folders))
    monkeypatch.syspath_prepend(tmp_path)
    module = importlib.import_module("force_on_rate")
    yield module.ForceOnRate(gain=0.05)
    del sys.modules["force_on_rate"]


def test_two_workers_a_killed_driver_and_dask_make_the_same_hundred_rows(tmp_path, law):
    here = cc.sweep(GRID, tmp_path / "here", workers=2, t_end=20.0, laws=law)
    made = rows(here)
    assert len(made) == 100
    assert {row["status"] for row in made} <= {"completed", "fragmented"}
    base = rows(cc.sweep({"r_on": [26], "seed": [1]}, tmp_path / "base", t_end=20.0))[0]
    same = next(row for row in made if (row["r_on"], row["zeta_1"], row["seed"]) == (26, 600, 1))
    assert same["tension"] != pytest.approx(base["tension"], rel=1e-3)

    killed = kill_halfway(tmp_path)
    assert killed < 100
    again = cc.sweep(GRID, tmp_path / "killed", workers=2, t_end=20.0, laws=law)
    assert rows(again) == made

    cluster = Cluster(tmp_path)
    try:
        spread = cc.sweep(GRID, tmp_path / "dask", cluster.address, t_end=20.0, laws=law)
        assert rows(spread) == made
    finally:
        cluster.end()


def kill_halfway(folder: Path) -> int:
    """Start the sweep as a program of its own, kill it among its runs; return how many are kept."""
    output = folder / "killed"
    process = subprocess.Popen([sys.executable, "driver.py", str(output)], cwd=folder)
    until = time.monotonic() + 300.0
    while time.monotonic() < until:
        written = [path.read_text() for path in output.glob("work/*.jsonl") if path.exists()]
        if sum(text.count('"row"') for text in written) >= 20 or list(output.glob("rows/*")):
            break
        assert process.poll() is None
        time.sleep(0.02)
    process.send_signal(signal.SIGKILL)
    process.wait()
    sweep = cc.open_sweep(output)
    sweep.collect()
    kept = len(list(sweep.rows()))
    assert kept >= 1
    return kept
