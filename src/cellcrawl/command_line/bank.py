"""`cellcrawl bank`: runs of cells drawn from a prior, in one file, for `cellcrawl fit`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from cellcrawl.command_line.main import CANCELLED
from cellcrawl.command_line.options import say, wants_progress
from cellcrawl.errors import InputError


@click.command()
@click.option(
    "--output",
    type=click.Path(path_type=Path, dir_okay=False),
    default=Path("bank.h5"),
    show_default=True,
    metavar="FILE",
    help="The bank; one that is there with fewer runs is gone on with.",
)
@click.option("--runs", type=int, default=10_000, show_default=True, metavar="NUMBER")
@click.option(
    "--prior",
    "ranges",
    multiple=True,
    metavar="NAME=LOW,HIGH[,log]",
    help="A range, as r_on=15,40 or D=0.02,0.2,log; any parameter, laws.NAME of a law's own "
    "number, time_unit (s), length_unit (µm). Given once, the usual ranges are left out.",
)
@click.option("--laws", default="paper", show_default=True, metavar="LAW", help="As in simulate.")
@click.option("--t-end", type=float, default=70.0, show_default=True, metavar="TIME")
@click.option("--seed", type=int, default=1, show_default=True, metavar="NUMBER")
@click.option("--workers", type=int, metavar="NUMBER", help="Worker processes.  [default: cores]")
@click.option("--dask", metavar="ADDRESS", help="Use the workers of a Dask scheduler, tcp://…")
@click.option(
    "--adopt",
    is_flag=True,
    help="Go on with a bank of another version, if some of its runs made again are the same.",
)
@click.option("--show", is_flag=True, help="Make nothing; say what the file holds.")
def bank(
    output: Path,
    runs: int,
    ranges: tuple[str, ...],
    laws: str,
    t_end: float,
    seed: int,
    workers: int | None,
    dask: str | None,
    adopt: bool,
    show: bool,
) -> int:
    """Make a bank of runs for `cellcrawl fit`: one file, made once, shared by many.

    10,000 runs take some 19 minutes of two cores and 200 MB. After Ctrl-C the same command
    goes on.

    \b
    Examples
      cellcrawl bank --output paper.h5
      cellcrawl bank --output stiff.h5 --laws stiffness --prior laws.chi=0,1 --prior r_on=15,40
      cellcrawl bank --output paper.h5 --show
    """
    from cellcrawl import infer

    if show:
        say(infer.open_bank(output).summary())
        return 0
    made = infer.bank(
        _prior(ranges),
        runs,
        output,
        laws=laws,
        t_end=t_end,
        seed=seed,
        executor=dask,
        workers=workers,
        progress=wants_progress(),
        adopt=adopt,
    )
    say(made.summary())
    if made.interrupted:
        say("stopped  the runs above are saved; the same command goes on")
        return CANCELLED
    return 0


def _prior(ranges: tuple[str, ...]) -> Any:
    """Return the prior that options name, None for the usual one."""
    from cellcrawl.infer import Prior

    if not ranges:
        return None
    found: dict[str, Any] = {}
    for one in ranges:
        name, equals, text = one.partition("=")
        if not equals or name in found:
            what = "is given twice" if equals else "is no range"
            raise InputError(f"--prior {one} {what}: give it as r_on=15,40 or D=0.02,0.2,log")
        found[name] = numbers(f"--prior {name}", text)
    return Prior(found)


def numbers(what: str, text: str) -> Any:
    """Return ``LOW,HIGH[,log]`` as a range, a single number as it is."""
    words = [word.strip() for word in text.split(",")]
    try:
        if len(words) == 1:
            return float(words[0])
        return (float(words[0]), float(words[1]), *words[2:])
    except (ValueError, IndexError):
        raise InputError(
            f"{what} = {text} is no number or range: give it as 10, or as 5,20,log"
        ) from None
