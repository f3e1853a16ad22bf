"""`cellcrawl cite`: what to cite for the package and for saved runs."""

from __future__ import annotations

from pathlib import Path

import click

from cellcrawl.command_line.folders import run_in, sweep_in
from cellcrawl.command_line.options import say


@click.command()
@click.argument("files", nargs=-1, type=click.Path(path_type=Path))
@click.option("--bibtex", is_flag=True, help="Entries for BibTeX instead of a list.")
def cite(files: tuple[Path, ...], bibtex: bool) -> None:
    """Say what to cite: the software, its model, and what stands behind the runs in FILES.

    FILES are runs, their folders, or the folders of sweeps; none: the package alone.

    \b
    Examples
      cellcrawl cite
      cellcrawl cite cellcrawl-run --bibtex > references.bib
    """
    import cellcrawl as cc

    used = [sweep_in(file) or cc.open_run(run_in(file)) for file in files]
    found = cc.cite(*used)
    say(found.bibtex() if bibtex else found.text())
