"""`cellcrawl classify`: name the motility modes of runs and of tracks."""

from __future__ import annotations

import contextlib
import csv
import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from cellcrawl.command_line.main import complain
from cellcrawl.command_line.many_tracks import classify_all
from cellcrawl.command_line.options import cannot_write, say, wants_progress
from cellcrawl.command_line.track_files import read_tracks_of, reading_options
from cellcrawl.errors import InputError
from cellcrawl.validation import shown

if TYPE_CHECKING:
    from cellcrawl.modes import Classification

_RUNS = (".nc", ".zarr")
_SHOWN = 200  # tracks shown on the terminal; a table holds them all


class _Row(NamedTuple):
    """One run or track: its classification, or the reason that there is none."""

    file: str
    track: str
    result: Classification | None
    reason: str = ""
    y_down: bool = False

    @property
    def label(self) -> str:
        return f"{self.file} {self.track}".rstrip()


@click.command()
@click.argument(
    "files", nargs=-1, required=True, type=click.Path(path_type=Path), metavar="FILE..."
)
@reading_options
@click.option(
    "--cell-radius",
    type=click.FloatRange(0.0, min_open=True),
    metavar="LENGTH",
    help="Radius of the cell in the units of the tracks; runs know theirs.",
)
@click.option("--remove-drift", is_flag=True, help="Take off the motion that all tracks share.")
@click.option(
    "--output",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="TABLE",
    help="Also write the table with all measures, as .csv.",
)
def classify(
    files: tuple[Path, ...],
    cell_radius: float | None,
    remove_drift: bool,
    output: Path | None,
    **reading: Any,
) -> None:
    """Name the motility mode of each FILE: gliding, rotational, zigzag, other, stationary or torn.

    A FILE is a run (.nc, .zarr) or holds tracks: a table whose columns have the usual names, or
    what TrackMate, trackpy, btrack, napari, CellProfiler, celltrackR, ImageJ and the Cell Tracking
    Challenge write. It is known by its content; what was recognised and left out is said. Of
    several tracks the mode of most is named too. A track or a file that cannot be named is listed
    with the reason and stops none of the others.

    \b
    Examples
      cellcrawl classify cellcrawl-run/run.nc
      cellcrawl classify keratocytes/*.csv --output modes.csv
      cellcrawl classify spots.csv --frame-interval 60 --pixel-size 0.65
      cellcrawl classify cells.txt --columns id=Cell,t=Time,x=Xpos,y=Ypos
    """
    from cellcrawl.modes import combine

    if output is not None and output.suffix.lower() != ".csv":
        raise InputError(f"--output {shown(str(output))}: the table is written as .csv")
    rows: list[_Row] = []
    failures: list[str] = []
    for file in files:
        try:
            rows += _rows(file, cell_radius, remove_drift, reading)
        except InputError as error:
            if len(files) == 1:
                raise
            failures.append(_about(str(file), str(error)))
            rows.append(_Row(str(file), "", None, str(error)))
    _print(rows)
    found = [row.result for row in rows if row.result is not None]
    if not found:
        first = next((row for row in rows if row.reason), None)
        why = _about(first.label, first.reason) if first else "there is nothing to name"
        raise InputError(why)
    if len(found) > 1:
        verdict = combine(found)
        counts = ", ".join(f"{count} {mode}" for mode, count in verdict.counts.items())
        agreed = f"mixed, most {verdict.majority}" if verdict.mode == "mixed" else verdict.mode
        say(f"together: {agreed} (confidence {verdict.confidence:.2f}): {counts}")
    for failure in failures:
        complain(f"left out {failure}")
    if output is not None:
        _write(output, rows)
        say(f"table    {output}")


def _rows(
    file: Path, cell_radius: float | None, remove_drift: bool, reading: dict[str, Any]
) -> list[_Row]:
    import cellcrawl as cc

    if file.suffix in _RUNS and not _is_a_graph(file):
        with cc.open_run(file) as dataset, _complaints_name(str(file)):
            return [_Row(str(file), "", cc.classify(dataset))]
    tracks = read_tracks_of(file, **reading)
    for line in tracks.lines():
        say(line)
    if len(tracks):
        drift = cc.observables.shared_drift(tracks)
        if drift.noticed:
            say(f"{drift}" + ("" if remove_drift else "; --remove-drift takes it off"))
        if remove_drift:
            tracks = cc.observables.without_drift(tracks, drift)
            say(tracks.source.notes[-1])
    with _progress(len(tracks)) as told:
        rows = [
            _Row(str(file), named.track, named.result, named.reason, tracks.source.y_down)
            for named in classify_all(tracks, cell_radius, told)
        ]
    rows += [_Row(str(file), one.what, None, one.reason) for one in tracks.left_out]
    return rows


def _is_a_graph(file: Path) -> bool:
    """Whether a .zarr folder is a graph of tracks (GEFF), not a run."""
    from cellcrawl.microscopy.recognise import is_geff

    return is_geff(file)


def _print(rows: list[_Row]) -> None:
    shown = rows if len(rows) <= _SHOWN else rows[:_SHOWN]
    wide = max(len("file"), *(len(row.label) for row in shown)) if shown else len("file")
    say(f"{'file':{wide}}  mode        sure  turned  swings  period  speed   seen by")
    for row in shown:
        if row.result is None:
            say(f"{row.label:{wide}}  -           not named: {row.reason}")
            continue
        seen = row.result.measures
        say(
            f"{row.label:{wide}}  {row.result.mode:10}  {row.result.confidence:4.2f}  "
            f"{_cell(math.degrees(seen.turned), '+.0f'):>6}  {seen.swings:6}  "
            f"{_cell(seen.period, '.3g'):>6}  {_cell(seen.speed, '.3g'):6}  "
            f"{row.result.summary(y_down=row.y_down)}"
        )
    if len(rows) > len(shown):
        say(f"... and {len(rows) - len(shown)} more: --output TABLE holds them all")


@contextlib.contextmanager
def _progress(total: int) -> Iterator[Callable[[int], None]]:
    """A bar over many tracks where somebody looks at it."""
    if total < _SHOWN or not wants_progress():
        yield lambda count: None
        return
    from tqdm.auto import tqdm

    with tqdm(total=total, unit="track") as bar:
        yield bar.update


@contextlib.contextmanager
def _complaints_name(label: str) -> Iterator[None]:
    """Say which file a complaint is about."""
    try:
        yield
    except InputError as error:
        raise InputError(f"{label}: {error}") from None


def _about(label: str, reason: str) -> str:
    return reason if label in reason else f"{label}: {reason}"


def _write(output: Path, rows: list[_Row]) -> None:
    named = next(row.result for row in rows if row.result is not None)
    columns = ["file", "track", *named.as_row(), "reason"]
    partial = output.with_name(f".{output.name}.part")
    try:
        with partial.open("w", encoding="utf-8", newline="") as stream:
            table = csv.DictWriter(stream, columns)
            table.writeheader()
            for row in rows:
                seen = {} if row.result is None else row.result.as_row()
                table.writerow({"file": row.file, "track": row.track, **seen, "reason": row.reason})
        partial.replace(output)
    except OSError as error:
        with contextlib.suppress(OSError):
            partial.unlink(missing_ok=True)
        raise cannot_write(output, error) from None


def _cell(value: float, form: str) -> str:
    return format(value, form) if math.isfinite(value) else "-"
