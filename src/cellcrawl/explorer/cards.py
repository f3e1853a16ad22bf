"""Things to try on the page, each with the expected outcome and a check of it by the package."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np
import xarray as xr

import cellcrawl
from cellcrawl.explorer.links import read
from cellcrawl.explorer.presets import CHANGES_AT, PRESETS


class Card(NamedTuple):
    """Something to try.

    Attributes
    ----------
    title, task, expect : str
        For the page.
    link : str
        What "set it up" opens.
    check : callable
        Whether the package sees the expected outcome.
    """

    title: str
    task: str
    expect: str
    link: str
    check: Callable[[], bool]


def _run(link: str, t_end: float, **changed: object) -> xr.Dataset:
    found = read(link)
    return cellcrawl.simulate(found.parameters, t_end=t_end, **{**found.options(), **changed})


def _direction(run: xr.Dataset) -> float:
    """Return the direction in which a cell has got away, in rad."""
    x = float(run["centroid_x"][-1] - run["centroid_x"][0])
    return math.atan2(float(run["centroid_y"][-1] - run["centroid_y"][0]), x)


def _every_seed_its_own_way() -> bool:
    ways = np.array([_direction(_run(_GLIDES, 20.0, start=_start(seed))) for seed in (1, 2, 3, 4)])
    apart = np.abs(np.angle(np.exp(1j * (ways[:, None] - ways[None, :]))))
    return bool(np.min(apart[np.triu_indices(4, 1)]) > math.radians(5.0))


def _start(seed: int) -> cellcrawl.RandomPerturbation:
    return cellcrawl.RandomPerturbation(seed=seed)


def _turns_set_in() -> bool:
    run = _run(_TURNED_UP, 120.0)
    before = cellcrawl.classify(run.sel(time=slice(0, CHANGES_AT)))
    after = cellcrawl.classify(run.sel(time=slice(CHANGES_AT + 5.0, None)))
    return before.mode == "gliding" and after.mode == "zigzag"


def _tension_tells_the_turns() -> bool:
    run = _run(_ZIGZAGS, 100.0)
    beat = cellcrawl.observables.oscillation(run["time"].values, run["tension"].values).period
    cycle = cellcrawl.classify(run).measures.period
    return abs(cycle / beat - 2.0) < 0.1


def _history_counts() -> bool:
    stopped = next(preset for preset in PRESETS if preset.key == "stopped")
    late = _run(stopped.link, stopped.until).sel(time=slice(CHANGES_AT + 5.0, None))
    fresh = _run(_ZIGZAGS, 100.0)
    return (
        cellcrawl.classify(late).mode == "stationary" and cellcrawl.classify(fresh).mode == "zigzag"
    )


def _the_poke_turns_it() -> bool:
    straight, poked = _run(_GLIDES, 60.0), _run(_POKED, 60.0)
    late = slice(45.0, 60.0)
    ways = [_direction(run.sel(time=late)) for run in (straight, poked)]
    turned = abs(math.remainder(ways[1] - ways[0], 2.0 * math.pi))
    return turned > math.radians(5.0) and cellcrawl.classify(poked.sel(time=late)).mode == "gliding"


def _too_sticky_to_move() -> bool:
    run = _run(_STUCK, 60.0)
    theory = cellcrawl.linear.growth_rates(read(_STUCK).parameters, 1)[0].real
    return bool(theory <= 0.0) and cellcrawl.classify(run).mode == "stationary"


_GLIDES: Final = "v=1&r_on=16&zeta_1=600&seed=2"
_ZIGZAGS: Final = "v=1&r_on=26&zeta_1=600&seed=2"
_TURNED_UP: Final = f"{_GLIDES}&changes={CHANGES_AT:g},r_on:26"
_POKED: Final = "v=1&r_on=16&zeta_1=600&seed=2&pokes=release,30.5,0,0"
_STUCK: Final = "v=1&r_on=26&zeta_1=400&seed=2"

CARDS: Final = (
    Card(
        "Who told it where to go?",
        "Press “Another” a few times and watch in which direction the cell sets off.",
        "Each time in another one. The round cell has no front; chance picks it, and the feedback "
        "of tension and bonds keeps it.",
        _GLIDES,
        _every_seed_its_own_way,
    ),
    Card(
        "More eager linkers",
        "Let it glide until t = 40, then watch: the binding rate goes from 16 to 26.",
        "It starts to swing from side to side. Nothing but the binding rate has changed.",
        _TURNED_UP,
        _turns_set_in,
    ),
    Card(
        "The tension knows",
        "Watch the strip of the tension while the cell zigzags.",
        "It peaks at each turn: two peaks for one left-and-right.",
        _ZIGZAGS + "&field=friction",
        _tension_tells_the_turns,
    ),
    Card(
        "The past counts",
        "A slow round glider is moved, at t = 40, to where cells zigzag. What does it do?",
        "It stops for good, though a cell that starts there zigzags: the same numbers allow both.",
        next(preset.link for preset in PRESETS if preset.key == "stopped"),
        _history_counts,
    ),
    Card(
        "Too little grip",
        "Let the cell sit at an adhesive friction of 400. Then raise it slowly.",
        "It stays round: below the dashed line every disturbance of the circle dies out. Somewhere "
        "above, it breaks free.",
        _STUCK,
        _too_sticky_to_move,
    ),
)
