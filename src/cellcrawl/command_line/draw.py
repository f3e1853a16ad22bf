"""`cellcrawl plot` and `cellcrawl movie`: pictures of saved runs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from cellcrawl.command_line.options import save_picture, say, wants_progress
from cellcrawl.validation import one_of

_KINDS = ("summary", "path", "kymographs", "time_series")


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option(
    "--kind",
    default="summary",
    show_default=True,
    metavar="KIND",
    help=f"What to draw: {', '.join(_KINDS)}.",
)
@click.option(
    "--origin",
    default="front",
    show_default=True,
    metavar="ORIGIN",
    help="Origin of kymographs: front or material.",
)
@click.option(
    "--output",
    type=click.Path(path_type=Path),
    metavar="PICTURE",
    help="Picture file (.png, .pdf, .svg).  [default: KIND.png beside FILE]",
)
@click.option(
    "--dpi",
    type=click.IntRange(30, 1200),
    default=200,
    show_default=True,
    help="Resolution of a .png.",
)
def plot(file: Path, kind: str, origin: str, output: Path | None, dpi: int) -> None:
    """Draw the run in FILE, or the tracks in it as `cellcrawl tracks` does.

    \b
    Examples
      cellcrawl plot run.nc                                the summary page
      cellcrawl plot cells.csv                             a sheet of tracks
      cellcrawl plot run.nc --kind path --output path.pdf  contours along the cell's path
      cellcrawl plot run.nc --kind kymographs --origin material
    """
    import cellcrawl as cc
    from cellcrawl.command_line.tracks import RUNS, draw_sheet

    one_of("--kind", kind, _KINDS)
    if file.suffix not in RUNS and file.is_file():
        draw_sheet(file, output, dpi)
        return
    target = output or file.with_name(f"{kind}.png")
    with cc.open_run(file) as dataset:
        draw: Callable[..., Any] = getattr(cc.plot, kind)
        figure = draw(dataset, origin=origin) if kind == "kymographs" else draw(dataset)
        figure = getattr(figure, "figure", figure)
        save_picture(figure, target, dpi)


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option(
    "--output",
    type=click.Path(path_type=Path),
    metavar="MOVIE",
    help="Movie file, .mp4 or .gif.  [default: cell.mp4 beside FILE]",
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
def movie(
    file: Path, output: Path | None, fps: int, seconds: float | None, view: str | None
) -> None:
    """Film the run in FILE.

    \b
    Examples
      cellcrawl movie run.nc
      cellcrawl movie run.nc --output cell.gif --seconds 5
    """
    import cellcrawl as cc

    target = output or file.with_name("cell.mp4")
    chosen: dict[str, Any] = {"seconds": seconds, "view": view}
    chosen = {name: value for name, value in chosen.items() if value is not None}
    with cc.open_run(file) as dataset:
        cc.movie(dataset, target, fps=fps, progress=wants_progress(), **chosen)
    say(f"movie    {target}")
