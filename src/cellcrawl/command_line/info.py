"""`cellcrawl info`: what a file holds."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cellcrawl.command_line.folders import run_in, sweep_in
from cellcrawl.command_line.options import say
from cellcrawl.command_line.report import report_run, report_sweep
from cellcrawl.data import STATUSES
from cellcrawl.parameters import Parameters
from cellcrawl.simulation.dataset import decode_attribute

if TYPE_CHECKING:
    from cellcrawl.sweeps import Sweep


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
def info(file: Path) -> None:
    """Say what the run in FILE holds: parameters, start, how it ended, variables.

    FILE may be the folder that holds the run. Of a sweep's folder: its grid and its modes.

    \b
    Examples
      cellcrawl info cellcrawl-run
      cellcrawl info phase_diagram
    """
    import cellcrawl as cc

    found = sweep_in(file)
    if found is not None:
        _say_sweep(found)
        return
    with cc.open_run(run_in(file)) as dataset:
        report_run(dataset)
        attributes = dataset.attrs
        say(f"status   {attributes['status']} means: {STATUSES.get(attributes['status'], '?')}")
        for name in ("parameters", "schedule", "start", "solver_options", "diagnostics"):
            values = decode_attribute(dataset, name)
            shown = ", ".join(f"{item} = {_short(value)}" for item, value in values.items())
            say(f"{name}: {shown or 'none'}")
        if "laws" in attributes:
            say(f"laws: {_described(decode_attribute(dataset, 'laws'))}")
        if "surroundings" in attributes:
            around = decode_attribute(dataset, "surroundings")
            say(f"surroundings: {'; '.join(map(_described, around))}")
        say(
            f"records: {dataset.sizes['time']} from t = {float(dataset['time'][0]):g} to "
            f"{float(dataset['time'][-1]):g}, every {attributes['save_every']:g}; "
            f"{dataset.sizes['node']} nodes"
        )
        for key, variable in dataset.variables.items():
            dims = ", ".join(str(dim) for dim in variable.dims)
            units, meaning = variable.attrs.get("units", ""), variable.attrs.get("long_name", "")
            say(f"  {key!s:16} ({dims:10})  {meaning} [{units}]")
        say(
            f"written by cellcrawl {attributes['cellcrawl_version']}, "
            f"schema {attributes['schema_version']}"
        )


def _say_sweep(found: Sweep) -> None:
    report_sweep(found)
    grid, usual = found.grid, Parameters().to_dict()
    shared = {
        name: value
        for name, value in grid.parameters.to_dict().items()
        if value != usual[name] and name not in grid.axes
    }
    listed = ", ".join(f"{name} = {value}" for name, value in shared.items())
    say(f"shared   {listed or 'the usual parameters'}, t_end = {grid.t_end:g}, {grid.solver}")
    say(f"keeps    {found.keep}: read them with cellcrawl.open_sweep")


def _described(content: dict[str, Any]) -> str:
    """Return a law or a surrounding with its numbers, though its class may not be here."""
    values = ", ".join(f"{name} = {_short(value)}" for name, value in content["values"].items())
    return f"{content['kind']} ({values})" if values else str(content["kind"])


def _short(value: object) -> str:
    text = str(value)
    return text if len(text) <= 60 else text[:57] + "..."
