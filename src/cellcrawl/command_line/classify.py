"""`cellcrawl classify`: name the motility modes of runs and of tracks."""

from __future__ import annotations

import contextlib
import csv
import itertools
import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from cellcrawl.command_line.main import complain
from cellcrawl.command_line.many_tracks import classify_all
from cellcrawl.command_line.options import cannot_write, say, wants_progress
from cellcrawl.command_line.track_files import read_tracks_of, reading_options, told_of_drift
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
    shown_rows: list[_Row] = []
    failures: list[str] = []
    count = named = 0
    why = "there is nothing to name"

    def results() -> Iterator[Classification]:
        """Hand every row to the table and keep what is shown: memory stays flat."""
        nonlocal count, named, why
        for row in _rows_of_files(files, cell_radius, remove_drift, reading, failures):
            if count < _SHOWN:
                shown_rows.append(row)
            if count == 0 and row.reason:
                why = _about(row.label, row.reason)
            count += 1
            write(row)
            if row.result is not None:
                named += 1
                yield row.result

    with _table(output) as write:
        found = results()
        first = next(found, None)
        verdict = None if first is None else combine(itertools.chain([first], found))
        _print(shown_rows, count)
        if verdict is None:
            raise InputError(why)
    if named > 1:
        counts = ", ".join(f"{number} {mode}" for mode, number in verdict.counts.items())
        sure = f" (confidence {verdict.confidence:.2f})"
        agreed = verdict.mode + sure
        if verdict.mode == "mixed":
            most = sorted(verdict.counts.values())[-2:]
            agreed = "mixed" if most[0] == most[1] else f"mixed, most {verdict.majority}{sure}"
        say(f"together: {agreed}: {counts}")
    for failure in failures:
        complain(f"left out {failure}")
    if output is not None:
        say(f"table    {output}")


def _rows_of_files(
    files: tuple[Path, ...],
    cell_radius: float | None,
    remove_drift: bool,
    reading: dict[str, Any],
    failures: list[str],
) -> Iterator[_Row]:
    """Yield the rows of all files; one that cannot be read stops none of the others."""
    for file in files:
        try:
            yield from _rows(file, cell_radius, remove_drift, reading)
        except InputError as error:
            failures.append(_about(str(file), str(error)))
            if len(files) == 1:
                raise
            yield _Row(str(file), "", None, str(error))


def _rows(
    file: Path, cell_radius: float | None, remove_drift: bool, reading: dict[str, Any]
) -> Iterator[_Row]:
    import cellcrawl as cc

    if file.suffix in _RUNS and not _is_a_graph(file):
        with cc.open_run(file) as dataset, _complaints_name(str(file)):
            yield _Row(str(file), "", cc.classify(dataset))
        return
    tracks = read_tracks_of(file, **reading)
    for line in tracks.lines():
        say(line)
    if len(tracks):
        tracks = told_of_drift(tracks, remove_drift)
    with _progress(len(tracks)) as told:
        for named in classify_all(tracks, cell_radius, told):
            yield _Row(str(file), named.track, named.result, named.reason, tracks.source.y_down)
    for one in tracks.left_out:
        yield _Row(str(file), one.what, None, one.reason)


def _is_a_graph(file: Path) -> bool:
    """Whether a .zarr folder is a graph of tracks (GEFF), not a run."""
    from cellcrawl.microscopy.recognise import is_geff

    return is_geff(file)


def _print(shown: list[_Row], count: int) -> None:
    """Print the first rows of so many."""
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
    if count > len(shown):
        say(f"... and {count - len(shown)} more: --output TABLE holds them all")


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


@contextlib.contextmanager
def _table(output: Path | None) -> Iterator[Callable[[_Row], None]]:
    """Write rows as they come to a table that is there, whole, once all are."""
    if output is None:
        yield lambda row: None
        return
    from cellcrawl.modes import Classification, Measures

    measures = Classification("", 0.0, {}, Measures(), "").as_row()
    partial = output.with_name(f".{output.name}.part")
    with contextlib.ExitStack() as stack:
        stack.callback(_remove, partial)
        with _writing(output):
            stream = stack.enter_context(partial.open("w", encoding="utf-8", newline=""))
            table = csv.DictWriter(stream, ["file", "track", *measures, "reason"])
            table.writeheader()

        def write(row: _Row) -> None:
            seen = {} if row.result is None else row.result.as_row()
            with _writing(output):
                table.writerow({"file": row.file, "track": row.track, **seen, "reason": row.reason})

        yield write
        with _writing(output):
            stream.close()
            partial.replace(output)


@contextlib.contextmanager
def _writing(output: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise cannot_write(output, error) from None


def _remove(partial: Path) -> None:
    with contextlib.suppress(OSError):
        partial.unlink(missing_ok=True)


def _cell(value: float, form: str) -> str:
    return format(value, form) if math.isfinite(value) else "-"
