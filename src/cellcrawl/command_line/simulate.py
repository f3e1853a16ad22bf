"""`cellcrawl simulate`: one cell, from parameters to data, picture and movie."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from cellcrawl.command_line.options import (
    make_folder,
    parameter_options,
    save_picture,
    say,
    wants_progress,
)
from cellcrawl.errors import InputError
from cellcrawl.parameters import Parameters

# The cell that `cellcrawl simulate` alone shows: the paper's zigzag.
SHOWN = Parameters(r_on=26.0, zeta_1=600.0)
_FITS_IN_MEMORY = 500_000_000  # bytes


@click.command(context_settings={"show_default": True})
@click.option(
    "--t-end", type=float, metavar="TIME", help="Stop at this time, in 1/k_off0.  [default: 100]"
)
@click.option(
    "--save-every", type=float, metavar="TIME", help="Time between saved records.  [default: 0.1]"
)
@click.option("--seed", type=int, metavar="NUMBER", help="Seed of the random start.  [default: 1]")
@click.option("--solver", metavar="NAME", help="Numerical scheme.")
@click.option("--nodes", type=int, metavar="NUMBER", help="Nodes on the edge.")
@click.option("--laws", metavar="NAME", help="A law set: a shipped one, or module:Class of yours.")
@click.option(
    "--rtol",
    type=float,
    metavar="NUMBER",
    help="Relative tolerance of --solver adaptive.  [default: 1e-4]",
)
@click.option("--dt", type=float, metavar="TIME", help="Time step of --solver paper.")
@click.option(
    "--config",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="TOML file with tables [parameters], [start], [schedule], [run]; options given "
    "here win over it.",
)
@click.option(
    "--output",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Folder for the results.  [default: cellcrawl-run, or the next free number]",
)
@click.option("--overwrite", is_flag=True, help="Replace a run that is already there.")
@click.option("--movie/--no-movie", default=True, help="Make a movie of the cell.")
@click.option("--plot/--no-plot", "picture", default=True, help="Draw a summary picture.")
@parameter_options(SHOWN)
def simulate(
    t_end: float | None,
    save_every: float | None,
    seed: int | None,
    solver: str | None,
    nodes: int | None,
    laws: str | None,
    rtol: float | None,
    dt: float | None,
    config: Path | None,
    output: Path | None,
    overwrite: bool,
    movie: bool,
    picture: bool,
    **parameters: Any,
) -> int:
    """Simulate one cell; leave its data, a summary picture and a short movie.

    With no options it is the zigzagging cell of the paper, (r_on, zeta_1) = (26, 600), from a
    randomly perturbed circle.

    \b
    Examples
      cellcrawl simulate --r-on 56 --zeta-1 560          glides nearly straight
      cellcrawl simulate --r-on 24 --zeta-1 540 --seed 3 turns one way
      cellcrawl simulate --t-end 20 --no-movie           a quick look
      cellcrawl simulate --config cell.toml --output my-cell

    \b
    A config file
      [parameters]
      r_on = 16
      [schedule]
      r_on = [[25.0, 16.0], [25.0, 30.0]]     # jumps to 30 at t = 25
      [start]
      kind = "RandomPerturbation"
      seed = 4
      [run]
      t_end = 60
      laws = { kind = "cellcrawl.laws:Stiffness", values = { chi = 0.6 } }
      surroundings = [ { kind = "stripes", period = 1.5 } ]

    Ctrl-C keeps what was computed; `cellcrawl resume` goes on from there.
    """
    from cellcrawl.solvers.adaptive import AdaptiveSolver, ahead

    if solver in (None, AdaptiveSolver.name) and ahead.nothing_kept():
        ahead.start()  # before what takes seconds to import the first time

    import cellcrawl as cc
    from cellcrawl.command_line.compiling import announce_compilation
    from cellcrawl.command_line.config import Configuration, read_configuration
    from cellcrawl.command_line.report import exit_code, report_run
    from cellcrawl.simulation.description import DEFAULT_SOLVER

    given = read_configuration(config) if config is not None else Configuration({}, {}, None, None)
    chosen = {name: value for name, value in parameters.items() if value is not None}
    flags = {
        "t_end": t_end,
        "save_every": save_every,
        "solver": solver,
        "nodes": nodes,
        "laws": laws,
        "rtol": rtol,
        "dt": dt,
    }
    settings = {**given.run, **{name: value for name, value in flags.items() if value is not None}}
    adaptive = settings.get("solver", DEFAULT_SOLVER) == AdaptiveSolver.name
    announce_compilation(ahead.start if adaptive else None)
    start = given.start
    if seed is not None:
        if start is not None and not isinstance(start, cc.RandomPerturbation):
            raise InputError("--seed is for a random start, and the config has another one")
        start = cc.RandomPerturbation(seed=seed)
    cell = Parameters.from_dict({**SHOWN.to_dict(), **given.parameters, **chosen})
    folder = _folder(output, overwrite)
    make_folder(folder)
    data = folder / "run.nc"
    try:
        dataset = cc.simulate(
            cell,
            start=start,
            schedule=given.schedule,
            output=data,
            overwrite=overwrite,
            progress=wants_progress(),
            **settings,
        )
    except InputError:
        if not any(folder.iterdir()):
            folder.rmdir()
        raise
    with dataset:
        if dataset.nbytes < _FITS_IN_MEMORY:
            dataset.load()  # drawing and filming read it piece by piece
        report_run(dataset)
        say(f"data     {data}")
        if picture:
            save_picture(cc.plot.summary(dataset), folder / "summary.png", 200)
        if movie and dataset.attrs["status"] != "interrupted":
            cc.movie(dataset, folder / "cell.mp4", progress=wants_progress())
            say(f"movie    {folder / 'cell.mp4'}")
        return exit_code(str(dataset.attrs["status"]))


def _folder(output: Path | None, overwrite: bool) -> Path:
    """Return the folder asked for, or the first free one of the usual name."""
    if output is not None:
        return output
    usual = Path("cellcrawl-run")
    number = 1
    folder = usual
    while folder.exists() and not overwrite:
        number += 1
        folder = usual.with_name(f"{usual.name}-{number}")
    return folder
