"""Make figures and movies of the paper, each once, in a folder."""

from __future__ import annotations

import time as clock
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from cellcrawl.errors import InputError
from cellcrawl.locks import locked
from cellcrawl.reproduction.recipe import Recipe
from cellcrawl.reproduction.registry import recipes_named
from cellcrawl.validation import one_of, whole_number

if TYPE_CHECKING:
    from cellcrawl.reproduction.workspace import Workspace

FORMATS: Final = ("png", "pdf", "svg")


class Made(NamedTuple):
    """A recipe that is done."""

    recipe: Recipe
    files: list[Path]
    found: list[str]
    seconds: float
    reused: bool
    """Whether it was there already."""


def reproduce(
    names: Sequence[str],
    output: str | Path = "reproduction",
    *,
    quick: bool = False,
    formats: Sequence[str] = ("png",),
    dpi: int = 200,
    again: bool = False,
    progress: bool = False,
) -> Iterator[Made]:
    """Make figures and movies of the paper, one after another.

    Parameters
    ----------
    names : sequence of str
        Names from `RECIPES`, or "figures", "movies", "all".
    output : str or Path
        Folder of the results: one folder a name, with pictures and the data behind them, and
        ``runs`` with the runs that they share.
    quick : bool
        Shorter runs and fewer points, for a look at how it works.
    formats : sequence of str
        Of the pictures: "png", "pdf", "svg".
    dpi : int
        Resolution of a PNG.
    again : bool
        Make pictures and movies anew even where they are there; runs are still reused.
    progress : bool
        Show progress bars.

    Yields
    ------
    Made
        As each is done. What is there already, of the same content, is not made again.

    Raises
    ------
    InputError
        For an unknown name or format, before anything is made; or if another process works in
        ``output``.
    StorageError
        If something cannot be written.
    """
    recipes = recipes_named([names] if isinstance(names, str) else names)
    if not recipes:
        raise InputError("there is nothing to reproduce: give names, or 'all'")
    wanted = [one_of("format", suffix, FORMATS) for suffix in formats]
    dots = whole_number("dpi", dpi, 30, 1200)
    choices = {"quick": quick, "formats": wanted, "dpi": dots}
    return _each(recipes, Path(output), choices, again, progress)


def _each(
    recipes: list[Recipe], root: Path, choices: dict[str, Any], again: bool, progress: bool
) -> Iterator[Made]:
    from cellcrawl.reproduction.workspace import Workspace

    with locked(root / ".lock", root):
        for recipe in recipes:
            place = Workspace(root, recipe.name, progress=progress, **choices)
            yield _made(recipe, place, choices, again)


def _made(recipe: Recipe, place: Workspace, choices: dict[str, Any], again: bool) -> Made:
    from cellcrawl.simulation.dataset import package_version

    began = clock.monotonic()
    identity = recipe.identity(choices)
    record = None if again else place.finished(identity)
    if record is not None:
        files = [place.root / path for path in record["files"]]
        return Made(recipe, files, record["found"], clock.monotonic() - began, True)
    found = recipe.make(place)
    place.finish(
        {
            "name": recipe.name,
            "title": recipe.title,
            "found": found,
            "quick": choices["quick"],
            "cellcrawl_version": package_version(),
            "identity": identity,
        }
    )
    return Made(recipe, place.files, found, clock.monotonic() - began, False)
