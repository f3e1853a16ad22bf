"""`cellcrawl verify`: every claim of the package, and of the paper, measured on this machine."""

from __future__ import annotations

import time
from pathlib import Path

import click

from cellcrawl.command_line.main import CANCELLED, RUN_FAILED
from cellcrawl.command_line.options import make_folder, say


@click.command()
@click.option(
    "--only",
    multiple=True,
    metavar="NAME",
    help="A part or check to run (--list names them); may be given more than once.",
)
@click.option("--full", is_flag=True, help="The long version: more cells, modes and runs.")
@click.option(
    "--workers",
    type=click.IntRange(1, 1024),
    default=2,
    show_default=True,
    metavar="NUMBER",
    help="Processes that share the checks.",
)
@click.option(
    "--output",
    type=click.Path(path_type=Path, file_okay=False),
    metavar="DIR",
    help="Write verification.json and verification.md there.",
)
@click.option("--list", "listed", is_flag=True, help="Name the parts and checks, and stop.")
def verify(
    only: tuple[str, ...], full: bool, workers: int, output: Path | None, listed: bool
) -> int:
    """Verify the package and the paper's claims: measure them anew and say what holds.

    Prints what was expected and what was measured. "ok" holds; "no" is a claim of the paper that is
    known not to hold and still does not; "FAILS" is anything else, and makes the exit code 3. The
    whole takes under six minutes on two cores.

    \b
    Examples
      cellcrawl verify
      cellcrawl verify --only growth --only claims-linear
      cellcrawl verify --full --output verification
    """
    from cellcrawl.verification import CHECKS, PARTS, report, run
    from cellcrawl.verification.check import Outcome

    if listed:
        for part, title in PARTS.items():
            say(f"{part}: {title}")
            for check in CHECKS:
                if check.part == part:
                    say(f"  {check.name}{' (with --full)' if check.only_in_full else ''}")
        return 0
    if output is not None:
        make_folder(output)  # before checking for minutes
    done: list[Outcome] = []

    def tell(outcome: Outcome) -> None:
        done.append(outcome)
        for line in report.lines(outcome):
            say(line)

    began = time.monotonic()
    complete = True
    try:
        done[:] = run(only, full=full, workers=workers, report=tell)
    except KeyboardInterrupt:
        complete = False
    content = report.record(done, full=full, complete=complete, seconds=time.monotonic() - began)
    say(report.summary(content))
    if output is not None:
        report.write(output, content)
        say(f"results  {output}")
    if not complete:
        return CANCELLED
    return 0 if content["status"] == "passed" else RUN_FAILED
