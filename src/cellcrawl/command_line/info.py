"""`cellcrawl info`: what a file holds."""

from __future__ import annotations

from pathlib import Path

import click

from cellcrawl.command_line.options import say
from cellcrawl.command_line.report import report_run
from cellcrawl.simulation.dataset import decode_attribute
from cellcrawl.simulation.events import STATUSES


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
def info(file: Path) -> None:
    """Say what the run in FILE holds: parameters, start, how it ended, variables.

    \b
    Example
      cellcrawl info cellcrawl-run/run.nc
    """
    import cellcrawl as cc

    with cc.open_run(file) as dataset:
        report_run(dataset)
        attributes = dataset.attrs
        say(f"status   {attributes['status']} means: {STATUSES.get(attributes['status'], '?')}")
        for name in ("parameters", "schedule", "start", "solver_options", "diagnostics"):
            values = decode_attribute(dataset, name)
            shown = ", ".join(f"{item} = {_short(value)}" for item, value in values.items())
            say(f"{name}: {shown or 'none'}")
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


def _short(value: object) -> str:
    text = str(value)
    return text if len(text) <= 60 else text[:57] + "..."
