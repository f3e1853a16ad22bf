"""Runs to begin with, and things to try, each with what the package says comes of it."""

from __future__ import annotations

from typing import Any, Final, NamedTuple

from cellcrawl.reproduction.cells import NINE, TRANSITIONS


class Preset(NamedTuple):
    """A run by the words of a link."""

    key: str
    title: str
    words: str
    link: str
    mode: str
    """What `classify` calls its end; "" where it is not asked."""
    until: float
    """Time at which the outcome is looked at."""
    point: tuple[float, float] | None = None

    def as_content(self) -> dict[str, Any]:
        """Return it as plain values."""
        return self._asdict()


class Card(NamedTuple):
    """Something to try, and what to expect."""

    title: str
    task: str
    expect: str
    link: str
    check: str
    """Name of the check in `cellcrawl.explorer.outcomes`."""


_WORDS: Final = {
    (16, 600): "A fan with two corners at the rear glides straight on.",
    (56, 560): "Nearly round, slow, and straight.",
    (24, 540): "Turns to one side only, on a wide circle.",
    (26, 600): "Left, right, left: a zigzag as regular as a clock.",
    (36, 560): "A zigzag whose way bends into a wide arc.",
    (38, 580): "Loops and swings that fit no one word.",
    (40, 540): "Wanders: its turns differ in size and time.",
    (40, 600): "Wanders with quick turns.",
    (44, 560): "Spins on the spot.",
}
_SEED: Final = 2

PRESETS: Final = tuple(
    Preset(
        f"p{cell.r_on:g}-{cell.zeta_1:g}",
        f"({cell.r_on:g}, {cell.zeta_1:g})",
        _WORDS[cell.r_on, cell.zeta_1],
        f"v=1&r_on={cell.r_on:g}&zeta_1={cell.zeta_1:g}&seed={_SEED}",
        cell.mode,
        100.0,
        (cell.r_on, cell.zeta_1),
    )
    for cell in NINE
)
CARDS: Final[tuple[Card, ...]] = ()
