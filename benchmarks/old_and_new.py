"""Time and measure two versions of cellcrawl side by side, in one run on one machine.

    python benchmarks/old_and_new.py OLD_PYTHON [NEW_PYTHON] [--references FILE] [--output DIR]

Each Python has a version of cellcrawl installed (the new one is this one unless given). Two
processes wait for work; they are given every cell in turn, old, new, old, new, so that a busy
machine slows both alike. Ratios of medians and of minima, errors against recorded references
(`cellcrawl bench references`) and how far the area of the shape drifts off the tension law.
"""

from __future__ import annotations

import argparse
import json
import math
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

WORKER = """
import json, math, sys, time
import numpy as np
import cellcrawl as cc
from cellcrawl.bench.cases import check_start

def off_law(run, p):
    x, y = run["x"].values, run["y"].values
    k = np.fft.fftfreq(x.shape[1], 1.0 / x.shape[1])
    k[x.shape[1] // 2] = 0.0
    area = math.pi * np.sum(k * np.abs(np.fft.fft(x + 1j * y) / x.shape[1]) ** 2, axis=1)
    tension = run["tension"].values
    return float(np.abs(area - area[0] - (tension - tension[0]) / p.tension_rate).max())

for line in sys.stdin:
    job = json.loads(line)
    p = cc.Parameters(r_on=job["r_on"], zeta_1=job["zeta_1"], elasticity=job["elasticity"])
    start = cc.RandomPerturbation(seed=1) if job["random"] else check_start(p)
    began = time.perf_counter()
    run = cc.simulate(p, job["t_end"], start=start, rtol=job["rtol"],
                      save_every=job["save_every"], nodes=job["nodes"])
    seconds = time.perf_counter() - began
    names = ("time", "length", "tension", "area", "centroid_x", "centroid_y")
    told = {name: run[name].values.tolist() for name in names}
    told |= {"seconds": seconds, "status": run.attrs["status"]}
    if job["law"]:
        told["off_law"] = off_law(run, p)
    print(json.dumps(told), flush=True)
"""
CELLS = ((16, 600), (26, 600), (24, 540), (36, 560))
NINE = (*CELLS, (56, 560), (38, 580), (40, 540), (40, 600), (44, 560))
LAWS = ("printed", "consistent")


class Version:
    """A process with one version of cellcrawl, that runs what it is asked to."""

    def __init__(self, python: str) -> None:
        self._process = subprocess.Popen(
            [python, "-c", WORKER], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        told = [python, "-c", "import cellcrawl; print(cellcrawl.__version__)"]
        self.version = subprocess.run(
            told, check=True, capture_output=True, text=True
        ).stdout.strip()

    def run(
        self, cell: tuple[float, float], elasticity: str = "printed", **job: Any
    ) -> dict[str, Any]:
        """Return what became of one run."""
        usual = {
            "r_on": cell[0], "zeta_1": cell[1], "elasticity": elasticity, "random": False,
            "t_end": 100.0, "rtol": 1e-4, "save_every": 5.0, "nodes": 64, "law": False,
        }  # fmt: skip
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(json.dumps(usual | job) + "\n")
        self._process.stdin.flush()
        answer: dict[str, Any] = json.loads(self._process.stdout.readline())
        return answer

    def close(self) -> None:
        """End the process."""
        assert self._process.stdin is not None
        self._process.stdin.close()
        self._process.wait()


def timed(old: Version, new: Version, turns: int, **job: Any) -> dict[str, Any]:
    """Time one cell, or several one after another, in turns."""
    cells = job.pop("cells")
    seconds: tuple[list[float], list[float]] = ([], [])
    for turn in range(turns + 1):
        for version, found in zip((old, new), seconds, strict=True):
            spent = sum(version.run(cell, **job)["seconds"] for cell in cells)
            if turn > 0:  # the first compiles and loads
                found.append(spent)
    middle, least = ([fold(found) for found in seconds] for fold in (statistics.median, min))
    return {
        "old_ms": 1e3 * middle[0],
        "new_ms": 1e3 * middle[1],
        "ratio_of_medians": middle[1] / middle[0],
        "ratio_of_minima": least[1] / least[0],
        "turns": turns,
    }


def diagrams(python: str, grid: Path, turns: int) -> list[float]:
    """Return the seconds of a whole sweep, from a cold shell to its picture, each time anew."""
    seconds = []
    for _ in range(turns):
        with tempfile.TemporaryDirectory() as folder:
            command = [python, "-m", "cellcrawl", "sweep", str(grid), "--output", f"{folder}/made"]
            began = time.perf_counter()
            subprocess.run(command, check=True, capture_output=True)
            seconds.append(time.perf_counter() - began)
    return seconds


def errors(found: dict[str, Any], truth: dict[str, Any]) -> dict[str, float] | None:
    """Return the largest errors over the reference's times, None where the run ended before."""
    rows = [i for i, t in enumerate(found["time"]) for s in truth["times"] if abs(t - s) < 1e-9]
    if len(rows) != len(truth["times"]):
        return None
    named = {
        name: max(abs(found[name][i] / v - 1.0) for i, v in zip(rows, truth[name], strict=True))
        for name in ("length", "tension", "area")
    }
    places = zip(rows, truth["centroid_x"], truth["centroid_y"], strict=True)
    away = (
        math.hypot(found["centroid_x"][i] - x, found["centroid_y"][i] - y) for i, x, y in places
    )
    return {**named, "centroid": max(away)}


def main() -> None:
    """Measure, print and record."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("old", help="python with the old version")
    parser.add_argument("new", nargs="?", default=sys.executable, help="python with the new one")
    parser.add_argument("--references", type=Path, help="of `cellcrawl bench references`")
    parser.add_argument("--output", type=Path, help="folder for old-and-new.json")
    parser.add_argument("--turns", type=int, default=7)
    parser.add_argument("--diagram", type=Path, help="grid file of a sweep to time as a whole")
    parser.add_argument("--law-until", type=float, default=1000.0)
    given = parser.parse_args()
    old, new = Version(given.old), Version(given.new)
    data: dict[str, Any] = {"old": old.version, "new": new.version, "times": [], "errors": []}
    for law in LAWS:
        sets = {f"{cell}, {law}": (cell,) for cell in CELLS} | {f"nine cells, {law}": NINE}
        for name, cells in sets.items():
            job = {"elasticity": law, "random": len(cells) > 1}
            row = {"what": name, **timed(old, new, given.turns, cells=cells, **job)}
            data["times"].append(row)
            print(
                f"{name}: {row['old_ms']:.0f} -> {row['new_ms']:.0f} ms, "
                f"x {row['ratio_of_medians']:.2f} (medians), x {row['ratio_of_minima']:.2f}",
                flush=True,
            )
    if given.diagram is not None:
        pairs = [
            [*diagrams(given.old, given.diagram, 1), *diagrams(given.new, given.diagram, 1)]
            for _ in range(3)
        ]
        data["diagram"] = {"grid": given.diagram.name, "old_and_new_seconds": pairs}
        print(f"diagram of {given.diagram.name}, old and new: {pairs}", flush=True)
    references = json.loads(given.references.read_text("utf-8")) if given.references else {}
    for truth in references.get("references", []):
        if truth["t_end"] != 100.0:
            continue
        cell, law = (truth["r_on"], truth["zeta_1"]), truth["elasticity"]
        for rtol in (1e-3, 1e-4, 1e-5, 1e-6):
            row = {"what": f"{cell}, {law}", "rtol": rtol}
            for name, version in (("old", old), ("new", new)):
                found = version.run(cell, law, rtol=rtol)
                row[name] = {"errors": errors(found, truth), "seconds": found["seconds"]}
            data["errors"].append(row)
            print(row, flush=True)
    data["law_until"], data["law"] = given.law_until, []
    for law in LAWS:
        for cell in (*CELLS, (56, 560)):
            row = {"what": f"{cell}, {law}"}
            job = {"t_end": given.law_until, "save_every": given.law_until / 100.0}
            for name, version in (("old", old), ("new", new)):
                found = version.run(cell, law, nodes=1024, law=True, **job)
                row[name] = {"off_law": found["off_law"], "status": found["status"]}
            data["law"].append(row)
            print(row, flush=True)
    for version in (old, new):
        version.close()
    if given.output is not None:
        from cellcrawl.bench import machine

        machine.write(given.output / "old-and-new.json", data)


if __name__ == "__main__":
    main()
