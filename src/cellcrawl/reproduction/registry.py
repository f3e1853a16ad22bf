"""The figures and movies of the paper, by name."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from cellcrawl.errors import InputError, nearest_name
from cellcrawl.reproduction.cells import NINE, TRANSITIONS, said
from cellcrawl.reproduction.recipe import Recipe

_FIGURES: Final = (
    Recipe("fig2", "growth rate of every wavenumber, four families", "linear theory", 2, "fig2"),
    Recipe("fig3", "a cell at (25, 600) starts to move, t = 0 to 2", "25 short runs", 4, "fig3"),
    Recipe(
        "fig4",
        "the motility modes over (r_on, zeta_1), nine of their tracks",
        "a sweep of 286 points, five seeds each; 9 runs",
        110,
        "fig4",
    ),
    Recipe("fig5", "one period of a rotating and of a zigzagging cell", "2 runs", 3, "fig5"),
    Recipe("fig6", "a gliding cell becomes a zigzagging one", "10 runs", 10, "fig6"),
    Recipe(
        "fig7",
        "circularity, tension and distance over (r_on, zeta_1)",
        "the sweep of fig4",
        110,
        "fig7",
    ),
    Recipe(
        "short-time", "simulation against linear theory at short times", "2 runs", 4, "short_time"
    ),
)
_MOVIES: Final = (
    *(
        Recipe(f"movie-s{number}", said(cell), "1 run", 5, "movies")
        for number, cell in enumerate(NINE, start=1)
    ),
    *(
        Recipe(f"movie-s{number}", change.title, "1 run", 5, "movies")
        for number, change in enumerate(TRANSITIONS, start=len(NINE) + 1)
    ),
)
RECIPES: Final[dict[str, Recipe]] = {recipe.name: recipe for recipe in (*_FIGURES, *_MOVIES)}
GROUPS: Final[dict[str, tuple[str, ...]]] = {
    "figures": tuple(recipe.name for recipe in _FIGURES),
    "movies": tuple(recipe.name for recipe in _MOVIES),
    "all": tuple(RECIPES),
}


def recipes_named(names: Sequence[str]) -> list[Recipe]:
    """Return the recipes of these names and groups, each once, in order.

    Raises
    ------
    InputError
        For a name that is not known.
    """
    chosen: dict[str, Recipe] = {}
    for given in names:
        name = given.casefold()
        if name not in RECIPES and name not in GROUPS:
            raise InputError(
                f"there is nothing to reproduce named {given!r}: "
                f"{nearest_name(name, [*RECIPES, *GROUPS])}"
            )
        chosen |= {member: RECIPES[member] for member in GROUPS.get(name, (name,))}
    return list(chosen.values())
