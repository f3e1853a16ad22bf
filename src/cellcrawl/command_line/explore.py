"""`cellcrawl explore`: the live cell in the browser."""

from __future__ import annotations

from pathlib import Path

import click

from cellcrawl.command_line.folders import run_in
from cellcrawl.command_line.options import say


@click.command()
@click.argument("file", required=False, type=click.Path(path_type=Path), metavar="[FILE]")
@click.option("--r-on", type=float, default=26.0, show_default=True, help="Binding rate.")
@click.option("--zeta-1", type=float, default=600.0, show_default=True, help="Adhesive friction.")
@click.option("--seed", type=int, default=2, show_default=True, help="Seed of the random start.")
@click.option("--view", default="full", show_default=True, help="How much: full, small or bare.")
@click.option(
    "--output",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="Write the page there and open no browser.",
)
def explore(
    file: Path | None, r_on: float, zeta_1: float, seed: int, view: str, output: Path | None
) -> int:
    """Open the live cell: a page on which the solver runs in your browser.

    With FILE, a saved run, the page plays it back. The page is one file that needs no network: keep
    it with --output, send it, or put it on any web server.

    \b
    Examples
      cellcrawl explore
      cellcrawl explore --r-on 24 --zeta-1 540
      cellcrawl explore cellcrawl-run/run.nc
    """
    import cellcrawl

    what = (
        cellcrawl.Parameters(r_on=r_on, zeta_1=zeta_1)
        if file is None
        else cellcrawl.open_run(run_in(file))
    )
    page = cellcrawl.explore(what, seed=seed, view=view)
    if output is not None:
        say(f"the live cell is in {page.save(output)}: open it in a browser")
    else:
        say(f"the live cell is in {page.open()}, which your browser should show now")
    return 0
