"""Runs to begin with, by the words of a link, each with what the package says comes of it."""

from __future__ import annotations

from typing import Any, Final, NamedTuple

from cellcrawl.parameters import PhysicalParameters
from cellcrawl.reproduction.cells import NINE

SEED: Final = 2
CHANGES_AT: Final = 40.0
COLD, WARM = 278.15, 298.15  # kelvin: 5 and 25 degrees


class Preset(NamedTuple):
    """A run to begin with.

    Attributes
    ----------
    key, title, words : str
        For the page.
    link : str
        The run by the words of a link.
    mode : str
        What `classify` calls it after the last change, or "fragmented".
    until : float
        Time up to which that holds.
    point : tuple of float, optional
        Where it is on the map, if it is a point of the paper's.
    """

    key: str
    title: str
    words: str
    link: str
    mode: str
    until: float
    point: tuple[float, float] | None = None

    def as_content(self) -> dict[str, Any]:
        """Return it as plain values."""
        return self._asdict()


_WORDS: Final = {
    (16, 600): "A fan with two corners at the rear; it glides straight on.",
    (56, 560): "Nearly round, slow and straight.",
    (24, 540): "Turns to one side only, on a wide circle.",
    (26, 600): "Left, right, left: a zigzag as regular as a clock.",
    (36, 560): "A zigzag whose way bends into a wide arc.",
    (38, 580): "Loops and swings that fit no one word.",
    (40, 540): "Its turns differ in size and in time.",
    (40, 600): "Quick turns, now to this side, now to that.",
    (44, 560): "Spins within its own outline.",
}


def _link(r_on: float, zeta_1: float, *more: str, seed: int = SEED, version: int = 1) -> str:
    return "&".join(
        [f"v={version}", f"r_on={r_on:.10g}", f"zeta_1={zeta_1:.10g}", f"seed={seed}", *more]
    )


def _jump(first: tuple[float, float], second: tuple[float, float]) -> str:
    change = f"changes={CHANGES_AT:g},r_on:{second[0]:g},zeta_1:{second[1]:g}"
    return _link(*first, change)


def _heated() -> str:
    """Return a cold cell that is warmed to the paper's temperature, by the package's scaling."""
    cell = PhysicalParameters(on_rate=3.3)
    cold, warm = (cell.at_temperature(kelvin).dimensionless() for kelvin in (COLD, WARM))
    changed = [
        name
        for name in ("r_on", "epsilon", "sigma_c", "r_p")
        if getattr(cold, name) != getattr(warm, name)
    ]
    own = [f"{name}={getattr(cold, name):.10g}" for name in changed if name != "r_on"]
    change = ",".join(f"{name}:{getattr(warm, name):.10g}" for name in changed)
    return _link(cold.r_on, cold.zeta_1, *own, f"changes={CHANGES_AT:g},{change}")


NAMED: Final = tuple(
    Preset(
        f"p{cell.r_on:g}-{cell.zeta_1:g}",
        f"({cell.r_on:g}, {cell.zeta_1:g})",
        _WORDS[int(cell.r_on), int(cell.zeta_1)],
        _link(cell.r_on, cell.zeta_1),
        cell.mode,
        100.0,
        (cell.r_on, cell.zeta_1),
    )
    for cell in NINE
)
OTHERS: Final = (
    Preset(
        "zigzag-rotation",
        "Zigzag, then circles",
        "At t = 40 the cell is moved from (26, 600) to (24, 540).",
        _jump((26, 600), (24, 540)),
        "rotational",
        120.0,
    ),
    Preset(
        "rotation-gliding",
        "Circles, then straight",
        "At t = 40 from (24, 540) to (16, 600).",
        _jump((24, 540), (16, 600)),
        "gliding",
        120.0,
    ),
    Preset(
        "stopped",
        "Stopped for good",
        "At t = 40 from (56, 560) to (26, 600), where cells zigzag. Not this one.",
        _jump((56, 560), (26, 600)),
        "stationary",
        120.0,
    ),
    Preset(
        "torn",
        "A cell that tears",
        "Two fronts pull apart: at t = 6.4 the edge crosses itself.",
        _link(16, 600, seed=7),
        "fragmented",
        20.0,
    ),
    Preset(
        "heated",
        "A heated cell",
        "At 5 °C it glides; at t = 40 it is warmed to 25 °C.",
        _heated(),
        "zigzag",
        120.0,
    ),
    Preset(
        "island",
        "On an island",
        "Linkers bind half as often off the island: it circles there.",
        _link(26, 600, "islands=0,0,3", "camera=whole"),
        "rotational",
        100.0,
    ),
    Preset(
        "soft",
        "Onto soft ground",
        "From t = 40 to 60 the ground goes soft: it does not hold the cell's pull, which stops.",
        _link(26, 600, "law=stiffness", "laws.chi=1", "changes=40~60,laws.chi:0.5", version=2),
        "stationary",
        140.0,
    ),
    Preset(
        "pillars",
        "Among pillars",
        "Walls push back: the cell has to find its way.",
        _link(
            36,
            560,
            "pillars=2.6,0,0.6;-2.6,0,0.6;0,2.6,0.6;0,-2.6,0.6;2.2,2.2,0.5;-2.2,2.2,0.5",
            "camera=whole",
        ),
        "",
        60.0,
    ),
)
PRESETS: Final = (*NAMED, *OTHERS)
