"""What runs on a worker: a chunk of runs, one after another, to one file of rows."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import xarray as xr

from cellcrawl.errors import CellcrawlError
from cellcrawl.simulation.description import RunDescription
from cellcrawl.simulation.following import Follower
from cellcrawl.simulation.interruption import Uninterrupted
from cellcrawl.simulation.progress import Silent
from cellcrawl.simulation.recorder import MemoryRecorder
from cellcrawl.simulation.tension_law import TensionLaw
from cellcrawl.simulation.track import Track, TrackRecorder, track_of
from cellcrawl.sweeps.identity import code_version
from cellcrawl.sweeps.journal import Journal, Row, read_journal
from cellcrawl.sweeps.kept import KeptRuns
from cellcrawl.sweeps.layout import Layout
from cellcrawl.sweeps.measures import described_columns, measured_columns
from cellcrawl.sweeps.parts import FAILED, KILLED, cannot_write, write_part

MOST_DEATHS = 3
"""A run that killed its worker this often is given up."""


class Outcome(NamedTuple):
    """A run's columns, and its Dataset if it is kept."""

    columns: Row
    dataset: xr.Dataset | None = None


Execute = Callable[[RunDescription, str], Outcome]


@dataclass(frozen=True)
class Chunk:
    """Runs that one worker does in one go.

    Attributes
    ----------
    folder : str
        Where the sweep is.
    name : str
        Names the files of this chunk, and no other.
    runs : tuple of (key, RunDescription)
    keep : str
        "rows", "tracks" or "fields".
    halt : str
        Name of the file whose existence asks to stop after the present run.
    """

    folder: str
    name: str
    runs: tuple[tuple[str, RunDescription], ...]
    keep: str
    halt: str


class Done(NamedTuple):
    """What a worker reports of a chunk: no rows, so that the driver stays small."""

    runs: int
    outcomes: dict[str, int]
    """How many runs ended with each status."""
    seconds: float


def execute(run: RunDescription, keep: str) -> Outcome:
    """Make one run; the bits are those of `simulate`."""
    engine = run.solver_at_start()
    recorder: Any = MemoryRecorder() if keep == "fields" else TrackRecorder()
    follower: Follower[Any] = Follower(
        engine,
        TensionLaw(run.conditions, engine.invariant_tolerance),
        recorder,
        run.identity(engine),
        run.save_every,
        Silent(),
        interruption=Uninterrupted(),
    )
    kept: Track | xr.Dataset = follower.follow(run.t_end)
    if isinstance(kept, xr.Dataset):
        return Outcome(measured_columns(track_of(kept)), kept)
    return Outcome(measured_columns(kept), kept.to_dataset() if keep == "tracks" else None)


def run_chunk(chunk: Chunk, execute: Execute = execute) -> Done:
    """Make a chunk's runs and write their rows; a run that fails is a row with its reason.

    Called again for the same chunk after a worker died (Dask does so), it goes on where the journal
    ends. Runs that killed their worker three times become rows.

    Raises
    ------
    StorageError
        If the rows cannot be written.
    """
    began = time.monotonic()
    layout = Layout(Path(chunk.folder))
    halt = layout.halt(chunk.halt)
    path = layout.journal(chunk.name)
    before = read_journal(path)
    rows = {row["key"]: row for row in before.rows} if chunk.keep == "rows" else {}
    try:
        with Journal(path) as journal, KeptRuns(layout.kept(chunk.name)) as kept:
            for key, run in chunk.runs:
                if key in rows:
                    continue
                if halt.exists():
                    break
                if before.unfinished[key] >= MOST_DEATHS:
                    row = killed_row(key, run, before.unfinished[key])
                else:
                    journal.begin(key)
                    row = _row(key, run, chunk, execute, kept)
                rows[key] = row
                journal.finish(row)
    except OSError as error:
        if isinstance(error, CellcrawlError):
            raise
        raise cannot_write(path, error) from None
    if rows:
        write_part(layout.part(chunk.name), list(rows.values()))
    path.unlink(missing_ok=True)
    outcomes = Counter(row["status"] for row in rows.values())
    return Done(len(rows), dict(outcomes), time.monotonic() - began)


def killed_row(key: str, run: RunDescription, deaths: int) -> Row:
    """Return the row of a run that is given up."""
    message = f"the worker died {deaths} times during this run (killed, or out of memory?)"
    return {**_asked(key, run), "status": KILLED, "message": message}


def _row(key: str, run: RunDescription, chunk: Chunk, execute: Execute, kept: KeptRuns) -> Row:
    began = time.monotonic()
    row = _asked(key, run)
    try:
        outcome = execute(run, chunk.keep)
    except Exception as error:
        reason = " ".join(str(error).split()) or "no reason given"
        kind = "" if isinstance(error, CellcrawlError) else f"{type(error).__name__}: "
        row |= {"status": FAILED, "message": kind + reason}
    else:
        row |= outcome.columns
        if outcome.dataset is not None:
            kept.add(key, outcome.dataset)
            row["part"] = chunk.name
    return {**row, "wall_time": time.monotonic() - began}


def _asked(key: str, run: RunDescription) -> Row:
    return {"key": key, "code": code_version(), **described_columns(run)}
