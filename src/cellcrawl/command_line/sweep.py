"""`cellcrawl sweep`: a grid of runs, from a TOML file to rows and a diagram."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from cellcrawl.command_line.main import CANCELLED
from cellcrawl.command_line.options import near, save_picture, say, wants_progress
from cellcrawl.command_line.report import report_sweep
from cellcrawl.errors import InputError

_PICTURE = "diagram.png"


@click.command()
@click.argument("grid", type=click.Path(path_type=Path), metavar="GRID")
@click.option(
    "--output",
    type=click.Path(path_type=Path, file_okay=False),
    metavar="DIR",
    help="Folder of the results; one that is there is gone on with.  [default: GRID without .toml]",
)
@click.option("--workers", type=int, metavar="NUMBER", help="Worker processes.  [default: cores]")
@click.option("--dask", metavar="ADDRESS", help="Use the workers of a Dask scheduler, tcp://…")
@click.option(
    "--keep",
    default="rows",
    show_default=True,
    metavar="WHAT",
    help="rows: a table with one row a run; tracks: also each cell's track; fields: also its edge.",
)
@click.option("--t-end", type=float, metavar="TIME", help="Wins over t_end of the file.")
@click.option(
    "--chunk", type=int, metavar="NUMBER", help="Make one part of the runs, from 0 (job arrays)."
)
@click.option("--of", "chunks", type=int, metavar="NUMBER", help="How many parts --chunk has.")
@click.option(
    "--refine",
    "levels",
    type=int,
    metavar="TIMES",
    help="Halve the spacing this often where the mode changes between neighbours.",
)
@click.option("--collect", is_flag=True, help="Make no runs; draw what the parts have left.")
@click.option("--status", is_flag=True, help="Make no runs; say how far the sweep is.")
@click.option("--extend", is_flag=True, help="Add these runs to a folder that has another grid.")
@click.option("--retry", is_flag=True, help="Make runs again that failed with an error.")
@click.option("--plot/--no-plot", "picture", default=True, help="Draw the diagram.")
def sweep(
    grid: Path,
    output: Path | None,
    workers: int | None,
    dask: str | None,
    keep: str,
    t_end: float | None,
    chunk: int | None,
    chunks: int | None,
    levels: int | None,
    collect: bool,
    status: bool,
    extend: bool,
    retry: bool,
    picture: bool,
) -> int:
    """Run every cell of GRID, a TOML file; leave one row a run and a diagram of the modes.

    Runs that have a row are not made again: after Ctrl-C, a crash or a full disk the same command
    goes on. With --status and --collect, GRID may also be the folder of results.

    \b
    A grid file
      [parameters]                             # shared by all runs
      D = 0.05
      [axes]                                   # every combination of
      r_on = { from = 10, to = 60, step = 2 }
      zeta_1 = [400, 500, 600]
      seed = [1, 2, 3, 4, 5]
      [run]
      t_end = 100

    \b
    Examples
      cellcrawl sweep grid.toml
      cellcrawl sweep grid.toml --status
      cellcrawl sweep coarse.toml --refine 3
      cellcrawl sweep grid.toml --dask tcp://node1:8786
      cellcrawl sweep grid.toml --chunk $SLURM_ARRAY_TASK_ID --of 200
      cellcrawl sweep grid.toml --collect
    """
    from cellcrawl import sweeps

    folder = output or _folder(grid)
    if status or collect:
        found = sweeps.open_sweep(folder)
        if not grid.is_dir() and not found.is_of(_read(grid, t_end)):
            say(f"note     {grid} has changed since: this is the grid that was swept")
        if collect:
            found.collect()
        report_sweep(found)
        return _finish(found, collect and picture)
    if grid.is_dir():
        raise InputError(f"{grid} is a folder: give the grid file, or ask for its --status")
    if (chunk is None) != (chunks is None):
        raise InputError("--chunk and --of go together, as in --chunk 3 --of 200")
    part = None
    if chunk is not None and chunks is not None:
        if not 0 <= chunk < chunks:
            raise InputError(
                f"--chunk {chunk} must be from 0 to {chunks - 1} with --of {chunks}: number the "
                f"tasks of the array so, as in --array=0-{chunks - 1}"
            )
        part = (chunk, chunks)
    shared: dict[str, Any] = {"workers": workers, "keep": keep, "progress": wants_progress()}
    if levels is not None:
        if part is not None or extend or retry:
            raise InputError("--refine does not go with --chunk, --extend or --retry")
        made = sweeps.refine(_read(grid, t_end), folder, dask, levels=levels, **shared)
    else:
        made = sweeps.sweep(
            _read(grid, t_end), folder, dask, extend=extend, retry=retry, part=part, **shared
        )
    report_sweep(made)
    if made.interrupted:
        say("stopped  the rows above are saved; the same command goes on")
        return CANCELLED
    return _finish(made, picture and part is None)


def _folder(grid: Path) -> Path:
    return grid if grid.is_dir() else Path(grid.stem)


def _read(grid: Path, t_end: float | None) -> Any:
    from cellcrawl.sweeps import Grid

    settings = {} if t_end is None else {"t_end": t_end}
    return Grid.from_toml(grid, **settings)


def _finish(found: Any, picture: bool) -> int:
    if picture and found.can_be_drawn():
        from cellcrawl import plot
        from cellcrawl.plot.style import figure_of

        save_picture(figure_of(plot.diagram(found)), near(found.path / _PICTURE), 200)
    return 0
