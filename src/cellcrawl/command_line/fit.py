"""`cellcrawl fit`: from tracks and outlines of cells to a report on their adhesions."""

from __future__ import annotations

import contextlib
import shlex
import sys
from pathlib import Path
from typing import Any

import click

from cellcrawl.command_line.bank import numbers
from cellcrawl.command_line.main import complain
from cellcrawl.command_line.options import say
from cellcrawl.command_line.track_files import read_tracks_of, reading_options
from cellcrawl.errors import InputError

_QUICK = 500  # runs that are learned from without a word


@click.command()
@click.argument("file", type=click.Path(path_type=Path), metavar="TRACKS")
@click.option(
    "--outlines",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Outlines of the same cells: label images, ROIs, whatever read_outlines takes.",
)
@click.option(
    "--bank",
    "bank_file",
    type=click.Path(path_type=Path),
    required=True,
    metavar="FILE",
    help="What cellcrawl bank made.",
)
@click.option("--track", metavar="ID", help="Which cell, of several.")
@click.option(
    "--treated",
    type=click.Path(path_type=Path),
    metavar="TRACKS",
    help="Cells of a second condition, to compare.",
)
@click.option(
    "--treated-outlines", type=click.Path(path_type=Path), metavar="FILE", help="Their outlines."
)
@click.option("--method", default="abc", show_default=True, metavar="METHOD", help="abc or npe.")
@click.option(
    "--network",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="With npe: use the network kept there, or train one and keep it there.",
)
@click.option(
    "--time-unit",
    metavar="TIME",
    help="Lifetime 1/k_off0 of a linker in s: 10, or 5,20,log.  [default: the bank's]",
)
@click.option(
    "--length-unit",
    metavar="LENGTH",
    help="Radius R_0 of the cell in µm: 10, or 8,12.  [default: from the outlines]",
)
@click.option("--error", type=float, metavar="LENGTH", help="Error of a position, in µm.")
@click.option("--seed", type=int, default=0, show_default=True, metavar="NUMBER")
@click.option(
    "--output",
    type=click.Path(path_type=Path, dir_okay=False),
    default=Path("fit.html"),
    show_default=True,
    metavar="FILE",
    help="The report.",
)
@reading_options
def fit(
    file: Path,
    outlines: Path | None,
    bank_file: Path,
    track: str | None,
    treated: Path | None,
    treated_outlines: Path | None,
    method: str,
    network: Path | None,
    time_unit: str | None,
    length_unit: str | None,
    error: float | None,
    seed: int,
    output: Path,
    **reading: Any,
) -> None:
    """Say what the TRACKS of cells, and their outlines, tell of their adhesions: one HTML page.

    Intervals of every parameter, what the film does not tell, whether the model makes such films,
    runs beside the cell, and how far to trust it all. Several cells are fitted one by one and
    together; with --treated, two conditions are compared.

    \b
    Examples
      cellcrawl fit tracks.xml --outlines masks.tif --pixel-size '0.65 um' \\
                --frame-interval '10 s' --bank paper.h5
      cellcrawl fit control.csv --treated drug.csv --length-unit 10 --bank paper.h5
    """
    from cellcrawl import infer
    from cellcrawl.infer.page import must_be_a_page

    bank = infer.open_bank(bank_file)
    must_be_a_page(output)
    if (treated_outlines is not None) and treated is None:
        raise InputError("--treated-outlines go with --treated")
    cells = _cells(file, outlines, track, reading)
    others = [] if treated is None else _cells(treated, treated_outlines, None, reading)
    if len(bank) > _QUICK:
        complain(f"learning from {len(bank):,} runs, filmed as these cells were: some minutes")
    fits = infer.fit_all(
        [*cells, *others],
        bank,
        method=method,
        time_unit=None if time_unit is None else numbers("--time-unit", time_unit),
        length_unit=None if length_unit is None else numbers("--length-unit", length_unit),
        pixel=_pixel(reading),
        error=error,
        seed=seed,
        network=network,
    )
    control, drugged = fits[: len(cells)], fits[len(cells) :]
    for one in fits:
        say(one.summary())
    comparison = infer.compare(control, drugged) if drugged else None
    group = None
    if not drugged and len(control) >= 3:
        group = infer.together(control)
        say(group.summary())
    if comparison is not None:
        say(comparison.summary())
    command = "cellcrawl " + shlex.join(sys.argv[1:])
    infer.report(fits, output, command=command, comparison=comparison, group=group)
    say(f"report   {output}")


def _cells(file: Path, outlines: Path | None, track: str | None, reading: dict[str, Any]) -> Any:
    """Return the cells of a file of tracks, with their outlines if there are any."""
    import cellcrawl as cc
    from cellcrawl.infer.cells import cells_of

    told = {name: value for name, value in reading.items() if name != "columns"}
    found = None
    if outlines is None and _may_have_outlines(file):
        with contextlib.suppress(InputError):  # of tracks alone
            found = cc.read_outlines(file, **told)
    if found is not None:
        for line in found.lines():
            say(line)
        chosen = found if track is None else found.of_track(track)
        return cells_of(chosen)
    tracks = read_tracks_of(file, **reading)
    for line in tracks.lines():
        say(line)
    picked: Any = tracks if track is None else tracks[track]
    if outlines is None:
        return cells_of(picked)
    found = cc.read_outlines(outlines, **told)
    for line in found.lines():
        say(line)
    return cells_of(picked, found)


def _may_have_outlines(file: Path) -> bool:
    """Whether a file of tracks may be one of outlines too, such as a label image."""
    from cellcrawl.microscopy.recognise import form_of_file

    kinds = ("tiff", "cellpose masks", "geojson", "imagej roi", "trackmate")
    return form_of_file(file) in kinds


def _pixel(reading: dict[str, Any]) -> float | None:
    from cellcrawl.infer.cells import micrometres

    return micrometres(reading.get("pixel_size"))
