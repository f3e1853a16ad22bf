"""Classify a table of many tracks, as the command line does: time and memory against their number.

    python benchmarks/tracks.py --tracks 1000 10000 100000 --output benchmarks/results

Persistent walks of 30 records with an error of position, in one comma-separated table whose rows
stand in the order of time, cells mixed, as trackers write them. Each table is read, classified and
written by ``cellcrawl classify`` in a process of its own; its memory is the most that it and its
workers held, sampled ten times a second, and that of the reader alone is measured beside it. For
Linux, where a process can say which part of its memory is its own; needs psutil.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import psutil

from cellcrawl.bench import machine

RECORDS = 30
READ = "import sys, cellcrawl as cc; print(len(cc.read_tracks(sys.argv[1])))"


def write_table(path: Path, tracks: int, seed: int = 0) -> None:
    """Write persistent walks in µm and minutes, rows in the order of time."""
    random = np.random.default_rng(seed)
    turns = random.normal(0.0, random.uniform(0.05, 1.0, (tracks, 1)), (tracks, RECORDS))
    heading = random.uniform(0.0, 2.0 * np.pi, (tracks, 1)) + np.cumsum(turns, axis=1)
    place = random.uniform(0.0, 1e4, (tracks, 2, 1))
    steps = np.stack([np.cos(heading), np.sin(heading)], axis=1)
    xy = place + np.cumsum(steps, axis=2) + random.normal(0.0, 0.1, (tracks, 2, RECORDS))
    with path.open("w", encoding="utf-8", newline="\n") as stream:
        stream.write("TrackID,t [min],x [µm],y [µm]\n")
        for frame in range(RECORDS):
            here = zip(range(tracks), xy[:, 0, frame], xy[:, 1, frame], strict=True)
            stream.writelines(f"{cell},{frame},{x:.4f},{y:.4f}\n" for cell, x, y in here)


def watched(command: list[str]) -> tuple[float, float]:
    """Run a command; return its wall time in seconds and the most memory it held, in MB."""
    begin = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    own = psutil.Process(process.pid)
    most = 0
    while process.poll() is None:
        held = 0
        try:
            for one in (own, *own.children(recursive=True)):
                held += one.memory_full_info().pss  # shared pages once
        except psutil.Error:
            pass  # it ended between two looks
        most = max(most, held)
        time.sleep(0.1)
    if process.returncode != 0:
        raise SystemExit(f"{' '.join(command)} ended with {process.returncode}")
    return time.perf_counter() - begin, most / 1e6


def measure(tracks: int, folder: Path) -> dict[str, float]:
    """Return time and memory of one table."""
    table = folder / f"{tracks}.csv"
    write_table(table, tracks)
    classify = [sys.executable, "-m", "cellcrawl", "classify", str(table)]
    seconds, memory = watched([*classify, "--output", str(folder / f"{tracks}-modes.csv")])
    reading, reader = watched([sys.executable, "-c", READ, str(table)])
    rows = sum(1 for _ in (folder / f"{tracks}-modes.csv").open(encoding="utf-8")) - 1
    if rows != tracks:
        raise SystemExit(f"{tracks} tracks, but {rows} rows in the table")
    return {
        "tracks": tracks,
        "file_mb": table.stat().st_size / 1e6,
        "seconds": seconds,
        "memory_mb": memory,
        "reading_seconds": reading,
        "reading_memory_mb": reader,
    }


def main() -> None:
    """Measure tables of several sizes."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tracks", type=int, nargs="+", default=[1_000, 10_000, 100_000])
    parser.add_argument("--output", type=Path)
    chosen = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for tracks in chosen.tracks:
            row = measure(tracks, Path(folder))
            rows.append(row)
            print(
                f"{tracks:>8} tracks ({row['file_mb']:.0f} MB): {row['seconds']:.1f} s, "
                f"{row['memory_mb']:.0f} MB; reading alone {row['reading_seconds']:.1f} s, "
                f"{row['reading_memory_mb']:.0f} MB",
                flush=True,
            )
    if chosen.output is not None:
        machine.write(chosen.output / "tracks.json", {"rows": rows})


if __name__ == "__main__":
    main()
