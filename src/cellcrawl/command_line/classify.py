"""`cellcrawl classify`: name the motility modes of runs and of tracks."""

from __future__ import annotations

import contextlib
import csv
import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import click

from cellcrawl.command_line.main import USER_MISTAKE, complain
from cellcrawl.command_line.options import cannot_write, say
from cellcrawl.errors import CellcrawlError, InputError
from cellcrawl.validation import shown

if TYPE_CHECKING:
    from cellcrawl.modes import Classification

_RUNS = (".nc", ".zarr")
_COLUMNS = ("t", "x", "y")


@click.command()
@click.argument(
    "files", nargs=-1, required=True, type=click.Path(path_type=Path), metavar="FILE..."
)
@click.option(
    "--cell-radius",
    type=click.FloatRange(0.0, min_open=True),
    metavar="LENGTH",
    help="Radius of the cell in the units of the tracks; runs know theirs.",
)
@click.option(
    "--output",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="TABLE",
    help="Also write the table with all measures, as .csv.",
)
def classify(files: tuple[Path, ...], cell_radius: float | None, output: Path | None) -> int:
    """Name the motility mode of each FILE: gliding, rotational, zigzag, other, stationary or torn.

    A FILE is a run (.nc, .zarr) or a table of a centroid track with the columns t, x and y in any
    units; a column "track" keeps several tracks apart. Of several the mode of most is named too.
    A file that cannot be read is left out and named at the end; the exit code is then 2.

    \b
    Examples
      cellcrawl classify cellcrawl-run/run.nc
      cellcrawl classify keratocytes/*.csv --output modes.csv
    """
    from cellcrawl.modes import combine

    if output is not None and output.suffix.lower() != ".csv":
        raise InputError(f"--output {shown(str(output))}: the table is written as .csv")
    found, refused = _all_results(files, cell_radius)
    if not found:
        raise refused[0]
    wide = max(len("file"), *(len(name) for name, _ in found))
    say(f"{'file':{wide}}  mode        sure  turned  swings  period  speed   seen by")
    for name, result in found:
        seen = result.measures
        say(
            f"{name:{wide}}  {result.mode:10}  {result.confidence:4.2f}  "
            f"{_cell(math.degrees(seen.turned), '+.0f'):>6}  {seen.swings:6}  "
            f"{_cell(seen.period, '.3g'):>6}  {_cell(seen.speed, '.3g'):6}  {result.summary()}"
        )
    if len(found) > 1:
        verdict = combine(result for _, result in found)
        counts = ", ".join(f"{count} {mode}" for mode, count in verdict.counts.items())
        agreed = f"mixed, most {verdict.majority}" if verdict.mode == "mixed" else verdict.mode
        say(f"together: {agreed} (confidence {verdict.confidence:.2f}): {counts}")
    if output is not None:
        _write(output, found)
        say(f"table    {output}")
    for error in refused:
        complain(f"left out: {error}")
    return USER_MISTAKE if refused else 0


def _all_results(
    files: tuple[Path, ...], cell_radius: float | None
) -> tuple[list[tuple[str, Classification]], list[CellcrawlError]]:
    """Return the tracks that have a mode, and why the others have none: one stops no other."""
    found: list[tuple[str, Classification]] = []
    refused: list[CellcrawlError] = []
    for file in files:
        try:
            for result in _results(file, cell_radius, refused):
                found.append(result)
        except CellcrawlError as error:
            refused.append(error)
    return found, refused


def _results(
    file: Path, cell_radius: float | None, refused: list[CellcrawlError]
) -> Iterator[tuple[str, Classification]]:
    """Yield the modes of a file's tracks; a track that has none is noted and passed over."""
    import cellcrawl as cc

    if file.suffix in _RUNS:
        with cc.open_run(file) as dataset, _complaints_name(str(file)):
            yield str(file), cc.classify(dataset)
        return
    for name, (t, x, y) in _tracks(file).items():
        label = f"{file} {name}".rstrip()
        try:
            with _complaints_name(label):
                result = cc.classify_track(t, x, y, cell_radius=cell_radius)
        except InputError as error:
            refused.append(error)
        else:
            yield label, result


@contextlib.contextmanager
def _complaints_name(label: str) -> Iterator[None]:
    """Say which file a complaint is about."""
    try:
        yield
    except InputError as error:
        raise InputError(f"{label}: {error}") from None


def _tracks(file: Path) -> dict[str, tuple[list[float], list[float], list[float]]]:
    """Read the tracks of a table, by the value of its column "track"."""
    try:
        text = file.read_text("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        why = error.strerror if isinstance(error, OSError) else "it is not text"
        raise InputError(f"cannot read {file}: {why}; give runs (.nc, .zarr) or .csv") from None
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    first = lines[0] if lines else ""
    separator = max(",;\t", key=first.count)
    rows = csv.DictReader(lines, delimiter=separator, skipinitialspace=True)
    names = {name.strip().lower(): name for name in rows.fieldnames or () if name}
    missing = [column for column in _COLUMNS if column not in names]
    if missing:
        raise InputError(
            f"{file} has no column {missing[0]!r}: its first line must name the columns t, x, y"
        )
    tracks: dict[str, tuple[list[float], list[float], list[float]]] = {}
    for number, row in enumerate(rows, start=2):
        which = str(row[names["track"]]).strip() if "track" in names else ""
        for values, column in zip(tracks.setdefault(which, ([], [], [])), _COLUMNS, strict=True):
            cell = row[names[column]]
            try:
                values.append(float(cell))
            except (TypeError, ValueError):
                raise InputError(
                    f"{file}, row {number}: {column} = {shown(cell)} is not a number"
                ) from None
    if not tracks:
        raise InputError(f"{file} has no rows below its column names")
    return tracks


def _write(output: Path, found: list[tuple[str, Classification]]) -> None:
    rows = [{"file": name, **result.as_row()} for name, result in found]
    partial = output.with_name(f".{output.name}.part")
    try:
        with partial.open("w", encoding="utf-8", newline="") as stream:
            table = csv.DictWriter(stream, list(rows[0]))
            table.writeheader()
            table.writerows(rows)
        partial.replace(output)
    except OSError as error:
        with contextlib.suppress(OSError):
            partial.unlink(missing_ok=True)
        raise cannot_write(output, error) from None


def _cell(value: float, form: str) -> str:
    return format(value, form) if math.isfinite(value) else "-"
