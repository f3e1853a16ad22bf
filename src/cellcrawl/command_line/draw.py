"""`cellcrawl plot` and `cellcrawl movie`: pictures of saved runs and sweeps."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from cellcrawl.command_line.folders import run_in, sweep_in
from cellcrawl.command_line.look import Look, limits_from, look_options, numbers_from
from cellcrawl.command_line.options import save_picture, say, wants_progress
from cellcrawl.errors import InputError
from cellcrawl.validation import one_of

_KINDS = ("summary", "path", "cell", "snapshots", "kymograph", "kymographs", "time_series")
_DIAGRAM = "diagram"
# An option's name in the functions that draw, where it has another one there.
_OTHER_NAMES = {"time": ("time", "times"), "field": ("field", "fields", "quantities")}


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option(
    "--kind",
    metavar="KIND",
    help=f"What to draw of a run: {', '.join(_KINDS)}.  [default: summary]  "
    "Of a sweep: diagram, or a measure such as speed.  [default: diagram]",
)
@click.option("--field", metavar="NAME", help="The field on the edge; for time_series a quantity.")
@click.option("--limits", metavar="LOW,HIGH", help="Ends of the colour scale.")
@click.option("--every", type=float, metavar="TIME", help="Time between contours along a path.")
@click.option("--time", metavar="TIMES", help="Of cell, or of snapshots as in 0,10,20.")
@click.option("--origin", metavar="ORIGIN", help="Origin of kymographs: front or material.")
@click.option(
    "--output",
    type=click.Path(path_type=Path),
    metavar="PICTURE",
    help="Picture file (.png, .pdf, .svg).  [default: KIND.png beside the data]",
)
@click.option(
    "--dpi",
    type=click.IntRange(30, 1200),
    default=200,
    show_default=True,
    help="Resolution of a .png.",
)
@look_options
def plot(
    file: Path,
    kind: str | None,
    output: Path | None,
    dpi: int,
    limits: str | None,
    time: str | None,
    look: Look,
    **options: Any,
) -> None:
    """Draw the run in FILE, which may be the folder that holds it, or a sweep's folder.

    The tracks in a table are drawn as `cellcrawl tracks` does.

    \b
    Examples
      cellcrawl plot cellcrawl-run                         the summary page
      cellcrawl plot cells.csv                             a sheet of tracks
      cellcrawl plot run.nc --kind path --output path.pdf  contours along the cell's path
      cellcrawl plot run.nc --kind kymographs --origin material
      cellcrawl plot run.nc --kind snapshots --time 0,5,10 --width 3.4 --font-size 9
      cellcrawl plot phase_diagram --kind speed            a map of a sweep
    """
    import cellcrawl as cc
    from cellcrawl.command_line.tracks import RUNS, draw_sheet

    chosen: dict[str, Any] = {"limits": limits_from(limits), "time": _times(time), **options}
    if file.suffix not in RUNS and file.is_file():
        given = [name for name, value in {"kind": kind, **chosen}.items() if value is not None]
        if given:
            raise InputError(f"--{given[0]} means nothing for tracks")
        with look.used():
            draw_sheet(file, output, dpi)
        return
    found = sweep_in(file)
    if found is not None:
        kind = kind or _DIAGRAM
        draw, arguments = _of_sweep(kind, found)
        with look.used():
            _save(draw(*arguments, **_fitting(kind, draw, chosen)), output or file, kind, dpi)
        return
    data = run_in(file)
    kind = one_of("--kind", kind or "summary", _KINDS)
    draw = getattr(cc.plot, kind)
    fitting = _fitting(kind, draw, chosen)
    with cc.open_run(data) as dataset, look.used():
        _save(draw(dataset, **fitting), output or data.parent, kind, dpi)


def _of_sweep(kind: str, found: Any) -> tuple[Callable[..., Any], tuple[Any, ...]]:
    import cellcrawl as cc
    from cellcrawl.sweeps.measures import MEASURES

    one_of("--kind of a sweep", kind, (_DIAGRAM, *MEASURES))
    if kind == _DIAGRAM:
        return cc.plot.diagram, (found,)
    return cc.plot.measure_map, (found, kind)


def _fitting(kind: str, draw: Callable[..., Any], chosen: dict[str, Any]) -> dict[str, Any]:
    """Return the options given as the function takes them; refuse those it does not."""
    known = dict(inspect.signature(draw).parameters)
    if "times" in known and known["times"].default is False:
        del known["times"]  # of a path: whether to write them
    fitting: dict[str, Any] = {}
    for option, value in chosen.items():
        if value is None:
            continue
        names = [name for name in _OTHER_NAMES.get(option, (option,)) if name in known]
        if not names:
            raise InputError(f"--{option} means nothing for --kind {kind}")
        fitting[names[0]] = value
    if "times" in known and "times" not in fitting:
        raise InputError(f"--kind {kind} needs --time, as in --time 0,10,20")
    if "time" in fitting:
        if len(fitting["time"]) != 1:
            raise InputError(f"--kind {kind} shows one --time")
        fitting["time"] = fitting["time"][0]
    for name in ("fields", "quantities"):
        if name in fitting:
            fitting[name] = fitting[name].split(",")
    if "fields" in known and "limits" in fitting:
        if len(fitting.get("fields", ())) != 1:
            raise InputError("--limits of kymographs needs the one --field that they are for")
        fitting["limits"] = {fitting["fields"][0]: fitting["limits"]}
    return fitting


def _times(text: str | None) -> list[float] | None:
    return None if text is None else numbers_from("--time", text)


def _save(drawn: Any, target: Path, kind: str, dpi: int) -> None:
    """Write a picture, under its kind's name if ``target`` is a folder, and say so."""
    figure = getattr(drawn, "figure", drawn)
    if target.is_dir():
        target = target / f"{kind}.png"
    save_picture(figure, target, dpi)


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option(
    "--output",
    type=click.Path(path_type=Path),
    metavar="MOVIE",
    help="Movie file, .mp4 or .gif.  [default: cell.mp4 beside the data]",
)
@click.option(
    "--fps", type=click.IntRange(1, 120), default=25, show_default=True, help="Frames per second."
)
@click.option(
    "--seconds",
    type=click.FloatRange(0.1, 3600),
    metavar="SECONDS",
    help="Length of the movie.  [default: 10]",
)
@click.option("--view", metavar="VIEW", help="Where the camera looks: path or follow.")
@click.option("--field", metavar="NAME", help="The field on the edge that colours it.")
@click.option("--limits", metavar="LOW,HIGH", help="Ends of the colour scale.")
@click.option("--size", metavar="WIDTH,HEIGHT", help="In pixels.  [default: 960,720]")
@look_options
def movie(
    file: Path,
    output: Path | None,
    fps: int,
    limits: str | None,
    size: str | None,
    look: Look,
    **options: Any,
) -> None:
    """Film the run in FILE, which may be the folder that holds it.

    \b
    Examples
      cellcrawl movie cellcrawl-run
      cellcrawl movie run.nc --output cell.gif --seconds 5
      cellcrawl movie run.nc --field curvature --limits=-5,5 --colormap PuOr
    """
    import cellcrawl as cc

    data = run_in(file)
    target = output or data.with_name("cell.mp4")
    if look.width is not None:
        raise InputError("--width is for pictures: a movie has a --size in pixels")
    pixels = None if size is None else tuple(numbers_from("--size", size))
    chosen: dict[str, Any] = {"limits": limits_from(limits), "size": pixels, **options}
    chosen = {name: value for name, value in chosen.items() if value is not None}
    with cc.open_run(data) as dataset, look.used():
        cc.movie(dataset, target, fps=fps, progress=wants_progress(), **chosen)
    say(f"movie    {target}")
