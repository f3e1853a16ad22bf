"""`cellcrawl resume`: go on with a saved run."""

from __future__ import annotations

from pathlib import Path

import click

from cellcrawl.command_line.options import say, wants_progress
from cellcrawl.command_line.report import exit_code, report_run


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--t-end", type=float, required=True, metavar="TIME", help="New time to stop at.")
def resume(file: Path, t_end: float) -> int:
    """Go on with the run in FILE, to the same bits as if it had never stopped.

    FILE may be finished, interrupted or left by a killed run (then FILE.part holds its blocks).

    \b
    Example
      cellcrawl resume cellcrawl-run/run.nc --t-end 200
    """
    import cellcrawl as cc
    from cellcrawl.command_line.compiling import announce_compilation

    announce_compilation()

    with cc.resume(file, t_end, progress=wants_progress()) as dataset:
        report_run(dataset)
        say(f"data     {file}")
        return exit_code(str(dataset.attrs["status"]))
