"""`cellcrawl tracks`: a sheet about the tracks of a file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cellcrawl.command_line.many_tracks import classify_all
from cellcrawl.command_line.options import say
from cellcrawl.command_line.track_files import read_tracks_of, reading_options, told_of_drift
from cellcrawl.errors import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from cellcrawl.microscopy import Tracks
    from cellcrawl.modes import Classification

RUNS = (".nc", ".zarr")


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@reading_options
@click.option(
    "--cell-radius",
    type=click.FloatRange(0.0, min_open=True),
    metavar="LENGTH",
    help="Radius of the cells in the units of the tracks.",
)
@click.option("--remove-drift", is_flag=True, help="Take off the motion that all tracks share.")
@click.option(
    "--beside",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="A run or other tracks, drawn side by side with these.",
)
@click.option(
    "--output",
    type=click.Path(path_type=Path),
    metavar="PICTURE",
    help="Picture file (.png, .pdf, .svg).  [default: FILE's name with -tracks.png, beside it]",
)
@click.option(
    "--dpi",
    type=click.IntRange(30, 1200),
    default=200,
    show_default=True,
    help="Resolution of a .png.",
)
def tracks(
    file: Path,
    cell_radius: float | None,
    remove_drift: bool,
    beside: Path | None,
    output: Path | None,
    dpi: int,
    **reading: Any,
) -> None:
    """Draw a sheet about the tracks in FILE: modes, headings, turns, displacements, directions.

    FILE is what `cellcrawl classify` takes; of outlines of one frame, which make no tracks, sizes
    and shapes are drawn. Left and right are those seen on the screen.

    \b
    Examples
      cellcrawl tracks spots.csv
      cellcrawl tracks TrackMate.xml --output sheet.pdf
      cellcrawl tracks cells.csv --frame-interval '30 s' --pixel-size '0.65 um'
      cellcrawl tracks cells.csv --beside cellcrawl-run/run.nc
    """
    draw_sheet(file, output, dpi, cell_radius, remove_drift, beside, reading)


def draw_sheet(
    file: Path,
    output: Path | None = None,
    dpi: int = 200,
    cell_radius: float | None = None,
    remove_drift: bool = False,
    beside: Path | None = None,
    reading: dict[str, Any] | None = None,
) -> None:
    """Read tracks, say what was read, name and draw them."""
    import cellcrawl as cc

    try:
        given = _tracks(file, reading or {})
    except InputError:
        alone = None if beside else _outlines_of_one_frame(file, reading or {})
        if alone is None:
            raise
        _save(alone, output or file.with_name(f"{file.stem}-tracks.png"), dpi)
        return
    for line in given.lines():
        say(line)
    given = told_of_drift(given, remove_drift)
    results = _named(given, cell_radius)
    if beside is not None:
        other = _tracks(beside, reading or {})
        series = {file.name: given, beside.name: other}
        radius = None if beside.suffix in RUNS else cell_radius
        known = {file.name: results, beside.name: _named(other, radius)}
        figure = cc.plot.compare_tracks(series, known)
    else:
        tracks = "1 track" if len(given) == 1 else f"{len(given)} tracks"
        figure = cc.plot.tracks(given, results, title=f"{file.name}: {tracks}")
    _save(figure, output or file.with_name(f"{file.stem}-tracks.png"), dpi)


def _outlines_of_one_frame(file: Path, reading: dict[str, Any]) -> Figure | None:
    """Return a sheet of outlines that make no tracks, or None if the file holds no outlines."""
    import cellcrawl as cc

    known = ("frame_interval", "pixel_size")
    try:
        given = cc.read_outlines(file, **{name: reading.get(name) for name in known})
    except InputError:
        return None
    say(given.summary())
    say("one outline a cell: no paths to draw, so the sheet is about the outlines")
    return cc.plot.outlines(given, title=f"{file.name}: {len(given)} outlines")


def _tracks(file: Path, reading: dict[str, Any]) -> Tracks:
    import cellcrawl as cc
    from cellcrawl.microscopy.recognise import is_geff
    from cellcrawl.plot.tracks import as_tracks

    if file.suffix in RUNS and not is_geff(file):
        with cc.open_run(file) as run:
            return as_tracks(run)
    given = read_tracks_of(file, **reading)
    if len(given) == 0:
        raise InputError("; ".join([f"{file} has no tracks to draw", *given.lines()[-1:]]))
    return given


def _named(given: Tracks, cell_radius: float | None) -> list[Classification | None]:
    """Name all tracks; say of those without a name how many and why."""
    from cellcrawl.modes import FEWEST_RECORDS

    results: list[Classification | None] = []
    reasons: dict[str, list[str]] = {}
    for named in classify_all(given, cell_radius):
        results.append(named.result)
        if named.result is None:
            short = len(given[named.track]) < FEWEST_RECORDS
            reason = f"fewer than {FEWEST_RECORDS} records" if short else named.reason
            reasons.setdefault(reason, []).append(named.track)
    found = [result for result in results if result is not None]
    counts = {mode: sum(r.mode == mode for r in found) for mode in {r.mode for r in found}}
    say("modes    " + (", ".join(f"{counts[mode]} {mode}" for mode in sorted(counts)) or "none"))
    for reason, those in list(reasons.items())[:5]:
        some = f" and {len(those) - 5} more" if len(those) > 5 else ""
        say(f"not named: {', '.join(those[:5])}{some}: {reason}")
    return results


def _save(figure: Figure, target: Path, dpi: int) -> None:
    try:
        figure.savefig(target, dpi=dpi)
    except (OSError, ValueError) as error:
        raise InputError(f"cannot write {target}: {error}") from None
    say(f"picture  {target}")
