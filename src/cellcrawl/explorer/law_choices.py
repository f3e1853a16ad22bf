"""The laws that the page holds: what it says of each, and where its sliders begin and end."""

from __future__ import annotations

from typing import Any, Final, NamedTuple

from cellcrawl.explorer.entries import LAWS


class Shown(NamedTuple):
    """How the page shows a number of a law.

    Attributes
    ----------
    label : str
        Short name.
    begin : float
        Value when the law is chosen.
    low, high, step : float
        Of the slider.
    """

    label: str
    begin: float
    low: float
    high: float
    step: float


_WORDS: Final = {
    "paper": (
        "the paper's",
        "Slip bonds on a rigid ground: the harder the pull, the sooner they let go.",
    ),
    "catch-slip": (
        "catch-slip bonds",
        "Bonds that hold longer under a moderate force: a second way to let go that force closes.",
    ),
    "stiffness": (
        "soft ground",
        "Bonds in series with springs of the ground: on a soft one the network flows back "
        "more easily, and the cell stops.",
    ),
    "load": (
        "growth under load",
        "The membrane's load slows the growth of the network, and stops it at the stall.",
    ),
    "swept-myosin": (
        "swept myosin",
        "The network gathers motors as it flows back: the faster it flows, the harder they pull.",
    ),
}
_NUMBERS: Final[dict[str, dict[str, Shown]]] = {
    "paper": {},
    "catch-slip": {
        "catch": Shown("catch path", 20.0, 0.0, 60.0, 0.5),
        "catch_force": Shown("its force scale", 0.8, 0.0, 3.0, 0.05),
        "slip": Shown("slip path", 1.0, 0.1, 3.0, 0.05),
        "slip_force": Shown("its force scale", 1.0, 0.5, 2.0, 0.05),
    },
    "stiffness": {"chi": Shown("stiffness χ", 0.7, 0.05, 1.0, 0.01)},
    "load": {
        "stall": Shown("stall load", 3000.0, 500.0, 10000.0, 50.0),
        "steepness": Shown("steepness", 2.0, 0.5, 16.0, 0.5),
    },
    "swept-myosin": {"sweep": Shown("sweep", 0.2, 0.0, 1.9, 0.05)},
}


def law_choices() -> dict[str, Any]:
    """Return the laws by their names as plain values."""
    found: dict[str, Any] = {}
    for name, law in LAWS.items():
        title, words = _WORDS[name]
        numbers = {
            key: {
                "usual": about.default,
                "limits": [about.low, about.high],
                "meaning": about.meaning,
                **_NUMBERS[name][key]._asdict(),
            }
            for key, about in law.parameters.items()
        }
        python = type(law).__name__
        found[name] = {"title": title, "words": words, "python": python, "numbers": numbers}
    return found
