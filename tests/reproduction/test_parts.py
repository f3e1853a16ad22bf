"""Parts of the recipes: the period, the verdict on a point, the lock on the folder."""

from __future__ import annotations

import re
import subprocess
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.locks import locked
from cellcrawl.reproduction import reproduce
from cellcrawl.reproduction.fig5 import period
from cellcrawl.reproduction.fig6 import routes
from cellcrawl.reproduction.plane import keep_table, verdicts
from cellcrawl.reproduction.workspace import Workspace
from tests.runs import circling


@pytest.mark.parametrize("length", [8.9, 13.3])
@pytest.mark.parametrize("offset", [0.0, 3.0])
def test_a_period_of_the_tension_begins_at_a_minimum_past_half_time(length, offset):
    run = circling(0.05, records=1001)  # t = 0 to 100
    phase = 2.0 * np.pi * (run["time"].values - offset) / length
    run["tension"][:] = 900.0 - 20.0 * np.cos(phase) + 5.0 * np.cos(2.0 * phase)
    start, found = period(run)
    assert found == pytest.approx(length, rel=1e-3)
    assert 50.0 <= start <= 50.0 + length
    lowest = float(run["tension"].min())
    assert float(run["tension"].sel(time=start)) == pytest.approx(lowest, abs=0.05)


class Rows:
    """What a sweep gives of its table."""

    def __init__(self, rows: list[dict[str, Any]]) -> None:
        self._rows = rows

    def table(self, columns: list[str]) -> Rows:
        return Rows([{name: row[name] for name in columns} for row in self._rows])

    def to_pylist(self) -> list[dict[str, Any]]:
        return self._rows


ROWS = Rows(
    [
        {"r_on": r_on, "zeta_1": 600.0, "mode": mode, "tension": tension}
        for r_on, mode, tension in (
            (16.0, "gliding", 670.0),
            (16.0, "fragmented", 100.0),
            (26.0, "zigzag", 900.0),
            (26.0, "rotational", 910.0),
            (10.0, "fragmented", 50.0),
        )
    ]
)


def test_a_verdict_is_what_whole_cells_agree_on():
    assert verdicts(ROWS) == {
        (10.0, 600.0): ("fragmented", Counter(fragmented=1)),
        (16.0, 600.0): ("gliding", Counter(gliding=1, fragmented=1)),
        (26.0, 600.0): ("mixed", Counter(zigzag=1, rotational=1)),
    }


def test_the_table_of_points_leaves_torn_cells_out_of_means(tmp_path):
    keep_table(Workspace(tmp_path, "fig7"), ROWS, ("tension",))
    lines = (tmp_path / "fig7" / "points.csv").read_text().splitlines()
    assert lines[0] == "r_on,zeta_1,verdict,fragmented,gliding,rotational,zigzag,tension"
    assert lines[1:] == [
        "10.0,600.0,fragmented,1,0,0,0,",
        "16.0,600.0,gliding,1,1,0,0,670.0",
        "26.0,600.0,mixed,0,0,1,1,905.0",
    ]


def test_two_at_once_in_one_folder_are_refused(tmp_path):
    with (
        locked(tmp_path / ".lock", tmp_path),
        pytest.raises(cc.InputError, match="another process"),
    ):
        next(reproduce(["fig2"], tmp_path))
    hold = (
        "import sys; from pathlib import Path; from cellcrawl.locks import locked\n"
        "folder = Path(sys.argv[1])\n"
        "with locked(folder / '.lock', folder): raise SystemExit(7)"
    )
    run = subprocess.run([sys.executable, "-c", hold, str(tmp_path)], check=False)
    assert run.returncode == 7
    with locked(tmp_path / ".lock", tmp_path):
        pass  # a process that ended holds nothing


def test_a_folder_that_cannot_be_made_is_said_in_one_line(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(cc.StorageError, match="cannot write in"):
        next(reproduce(["fig2"], Path(tmp_path / "file" / "out")))


@pytest.mark.parametrize("scale", [1.0, 0.1])
def test_routes_are_named_by_the_times_of_their_schedules(scale):
    for name, schedule in routes(scale).items():
        times = sorted({time for points in schedule.to_dict().values() for time, _ in points})
        words = re.findall(r"[0-9.]+", name.replace("(24, 540)", ""))
        written = [float(word) for word in words]
        start, *rest = written
        assert start == pytest.approx(times[0])
        if "over" in name:
            assert rest == pytest.approx([times[-1] - times[0]])
        elif "abrupt" in name:
            assert times == pytest.approx([start])
