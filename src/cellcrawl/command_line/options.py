"""Options shared by commands, one for every model parameter."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click

from cellcrawl.arguments import file_path
from cellcrawl.errors import InputError, StorageError
from cellcrawl.parameters import DESCRIPTIONS, ELASTICITIES, Parameters

F = TypeVar("F", bound=Callable[..., Any])


def parameter_options(usual: Parameters) -> Callable[[F], F]:
    """Add one option for every field of `Parameters`; its help names the ``usual`` value."""
    return lambda function: _with_options(function, usual)


def _with_options(function: F, usual: Parameters) -> F:
    option = click.option(
        "--elasticity",
        metavar="LAW",
        help=f"Tension law: {' or '.join(ELASTICITIES)}.  [default: {usual.elasticity}]",
    )
    function = option(function)
    for name, described in reversed(DESCRIPTIONS.items()):
        flags = dict.fromkeys(
            ["--" + name.replace("_", "-"), "--" + name.lower().replace("_", "-")]
        )
        text = (
            f"{described.meaning[0].upper()}{described.meaning[1:]}, "
            f"{described.low:g} to {described.high:g}.  [default: {getattr(usual, name):g}]"
        )
        function = click.option(*flags, name, type=float, metavar="NUMBER", help=text)(function)
    return function


def wants_progress() -> bool:
    """Whether a progress bar has somebody to look at it."""
    return sys.stderr.isatty()


def say(message: str) -> None:
    """Print a line of the result."""
    click.echo(message)


def near(path: Path) -> Path:
    """Return a path below the present folder as seen from there, another one as it is."""
    here = Path.cwd()
    return path.relative_to(here) if path.is_relative_to(here) else path


def save_picture(figure: Any, path: Path, dpi: int) -> None:
    """Write a picture and say so.

    Raises
    ------
    InputError
        For a suffix that is no kind of picture.
    StorageError
        If it cannot be written.
    """
    file_path("--output", path)
    kinds = figure.canvas.get_supported_filetypes()
    if path.suffix[1:].lower() not in kinds:
        raise InputError(f"cannot write {path}: a picture's name ends in .png, .pdf or .svg")
    try:
        figure.savefig(path, dpi=dpi)
    except (OSError, ValueError) as error:
        raise cannot_write(path, error) from None
    say(f"picture  {path}")


def make_folder(path: Path) -> None:
    """Make a folder for results, or raise `StorageError`."""
    file_path("--output", path)
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise StorageError(
            f"cannot make the folder {path}: {error.strerror or error}; give another --output"
        ) from None


def cannot_write(path: Path, error: Exception) -> StorageError:
    """Return the error to raise when a result cannot be written."""
    reason = getattr(error, "strerror", None) or " ".join(str(error).split())
    return StorageError(f"cannot write {path}: {reason}; give another --output")
