"""The command group, and how errors become one line and an exit code."""

from __future__ import annotations

import gc
import importlib
import sys
import warnings
from collections.abc import Sequence
from typing import Any, Final

import click

USER_MISTAKE: Final = 2
RUN_FAILED: Final = 3
CANCELLED: Final = 130

# Importing and compiling make many objects that all stay: looking for garbage among them as often
# as Python does costs an eighth of a first start.
_OBJECTS_BETWEEN_COLLECTIONS = 100_000

# Commands live in modules of their own, imported only when they are asked for.
_COMMANDS: Final[dict[str, tuple[str, str]]] = {
    "simulate": ("simulate", "Simulate one cell; leave its data, a picture and a movie."),
    "resume": ("resume", "Go on with a saved run."),
    "sweep": ("sweep", "Run a grid of cells; leave a table and a diagram of their modes."),
    "dispersion": ("theory", "Growth rates of every wavenumber, as a table and a picture."),
    "stability": ("theory", "Which wavenumbers grow where, over two parameters."),
    "branches": ("branches", "Follow gliding and turning cells to where they lose their hold."),
    "reproduce": ("reproduce", "Make the figures and movies of the paper."),
    "classify": ("classify", "Name the motility modes of runs and of tracks."),
    "tracks": ("tracks", "Draw a sheet about tracks: modes, headings, displacements."),
    "fit": ("fit", "Say what tracks and outlines of cells tell of their adhesions."),
    "bank": ("bank", "Make a bank of runs for fit."),
    "plot": ("draw", "Draw a saved run, or the tracks of a table."),
    "movie": ("draw", "Film a saved run."),
    "explore": ("explore", "Open the live cell: the solver at work in your browser."),
    "info": ("info", "Say what a file holds."),
    "verify": ("verify", "Verify the package and the paper's claims."),
    "bench": ("bench", "Measure accuracy and speed on this machine."),
    "cite": ("cite", "Say what to cite, for the package and for saved runs."),
    "completion": ("completion", "Print the shell completion script."),
}


class _LazyGroup(click.Group):
    """A group whose commands are imported when used, so that --help answers at once."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(_COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in _COMMANDS:
            return None
        module = importlib.import_module(f"cellcrawl.command_line.{_COMMANDS[cmd_name][0]}")
        command: click.Command = getattr(module, cmd_name)
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        if args and args[0] not in _COMMANDS and not args[0].startswith("-"):
            from cellcrawl.errors import nearest_name
            from cellcrawl.validation import shown

            ctx.fail(f"no command {shown(args[0])}: {nearest_name(args[0], _COMMANDS)}")
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl([(name, text) for name, (_, text) in _COMMANDS.items()])


def _version(ctx: click.Context, parameter: click.Parameter, value: bool) -> None:
    if value and not ctx.resilient_parsing:
        from importlib.metadata import version

        click.echo(f"cellcrawl {version('cellcrawl')}")
        ctx.exit()


@click.group(cls=_LazyGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.option(
    "--version",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_version,
    help="Print the version and stop.",
)
def commands() -> None:
    """Simulate how single cells crawl.

    A deformable edge, adhesions that stick and slip, and one membrane tension: out of these a round
    cell breaks its symmetry and glides, zigzags or turns.

    \b
    Start with
      cellcrawl simulate                            a zigzagging cell of the paper
      cellcrawl simulate --r-on 24 --zeta-1 540     one that turns
      cellcrawl info cellcrawl-run/run.nc           what the file holds
    """


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line; ends the process with an exit code.

    0: ended as the model allows. 2: a mistake in what was asked. 3: a run that failed. 130: Ctrl-C,
    with what was computed kept.
    """
    warnings.showwarning = _one_line
    gc.set_threshold(_OBJECTS_BETWEEN_COLLECTIONS, 20, 100)
    code = run(arguments)
    gc.freeze()  # the process ends: a last search for garbage would cost a fifth of a warm start
    sys.exit(code)


def run(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code."""
    from cellcrawl.errors import CellcrawlError, InputError

    try:
        result: Any = commands.main(
            args=None if arguments is None else list(arguments),
            prog_name="cellcrawl",
            standalone_mode=False,
        )
    except click.exceptions.Abort:
        complain("stopped")
        return CANCELLED
    except click.ClickException as error:
        context = getattr(error, "ctx", None)
        path = context.command_path if context is not None else "cellcrawl"
        complain(f"{error.format_message()} (see {path} --help)")
        return USER_MISTAKE
    except InputError as error:
        complain(str(error))
        return USER_MISTAKE
    except CellcrawlError as error:
        complain(str(error))
        return RUN_FAILED
    except KeyboardInterrupt:
        complain("stopped")
        return CANCELLED
    except BrokenPipeError:
        return 0
    return result if isinstance(result, int) else 0


def _one_line(message: Warning | str, *_: Any, **__: Any) -> None:
    """Print a warning as the terminal should have it: without the place in our code."""
    complain(f"note: {message}")


def complain(message: str) -> None:
    """Print a line of complaint."""
    click.echo(f"cellcrawl: {message}", err=True)
