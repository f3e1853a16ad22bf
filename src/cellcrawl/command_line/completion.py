"""`cellcrawl completion`: tab completion for the shell."""

from __future__ import annotations

import click
from click.shell_completion import get_completion_class


@click.command()
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
def completion(shell: str) -> None:
    """Print the completion script for SHELL.

    \b
    Add to the shell's start-up file
      bash   eval "$(cellcrawl completion bash)"
      zsh    eval "$(cellcrawl completion zsh)"
      fish   cellcrawl completion fish | source
    """
    from cellcrawl.command_line.main import commands

    kind = get_completion_class(shell)
    if kind is not None:
        click.echo(kind(commands, {}, "cellcrawl", "_CELLCRAWL_COMPLETE").source())
