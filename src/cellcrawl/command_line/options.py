"""Options shared by commands, one for every model parameter."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any, TypeVar

import click

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
