"""Options for the look of pictures and movies, shared by commands."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple, TypeVar

import click

from cellcrawl.errors import InputError

F = TypeVar("F", bound=Callable[..., Any])


class Look(NamedTuple):
    """How pictures are to look; see `cellcrawl.plot.styled`."""

    width: float | None
    font_size: float | None
    colormap: str | None
    style: str | None
    settings: tuple[str, ...]

    @contextlib.contextmanager
    def used(self) -> Iterator[None]:
        """Draw pictures with this look meanwhile.

        Raises
        ------
        InputError
            For something that matplotlib does not know.
        """
        from cellcrawl.plot import styled

        settings = dict(_setting(text) for text in self.settings)
        with contextlib.ExitStack() as stack:
            if self.style is not None:
                stack.enter_context(_style_sheet(self.style))
            stack.enter_context(
                styled(settings, width=self.width, font_size=self.font_size, colormap=self.colormap)
            )
            yield


def look_options(function: F) -> F:
    """Add the options; the command takes a `Look` as ``look``."""
    options = (
        click.option("--width", type=float, metavar="INCHES", help="Width: 3.4 fills a column."),
        click.option("--font-size", type=float, metavar="POINTS", help="Size of the text."),
        click.option("--colormap", metavar="NAME", help="A colour map of matplotlib's."),
        click.option("--style", metavar="NAME", help="A style sheet of matplotlib's, or its file."),
        click.option(
            "--rc",
            "settings",
            multiple=True,
            metavar="NAME=VALUE",
            help="One of matplotlib's settings, as in lines.linewidth=2; more than once for more.",
        ),
    )

    def command(
        width: float | None,
        font_size: float | None,
        colormap: str | None,
        style: str | None,
        settings: tuple[str, ...],
        **others: Any,
    ) -> Any:
        return function(look=Look(width, font_size, colormap, style, settings), **others)

    command.__doc__, command.__name__ = function.__doc__, function.__name__
    if hasattr(function, "__click_params__"):
        command.__click_params__ = function.__click_params__  # type: ignore[attr-defined]
    decorated: Any = command
    for option in reversed(options):
        decorated = option(decorated)
    return decorated  # type: ignore[no-any-return]


def limits_from(text: str | None) -> tuple[float, float] | None:
    """Return the two ends of a colour scale from ``LOW,HIGH``."""
    if text is None:
        return None
    numbers = numbers_from("--limits", text)
    if len(numbers) != 2:
        raise InputError(f"--limits {text}: give two numbers, as in --limits 0.1,0.8")
    return numbers[0], numbers[1]


def numbers_from(option: str, text: str) -> list[float]:
    """Return numbers from a list with commas."""
    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise InputError(f"{option} {text}: give numbers with commas between them") from None


def _setting(text: str) -> tuple[str, Any]:
    name, equals, value = text.partition("=")
    if not equals:
        raise InputError(f"--rc {text}: give a name and a value, as in --rc lines.linewidth=2")
    return name.strip(), value.strip()


@contextlib.contextmanager
def _style_sheet(name: str) -> Iterator[None]:
    import matplotlib.style

    try:
        used = matplotlib.style.context(name)
        used.__enter__()
    except (OSError, ValueError) as error:
        raise InputError(f"--style {name}: {' '.join(str(error).split())}") from None
    try:
        yield
    finally:
        used.__exit__(None, None, None)
