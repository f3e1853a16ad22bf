"""One colour and one marker for each mode, in every picture; told apart by colour-blind readers."""

from __future__ import annotations

from typing import Final, NamedTuple


class ModeSymbol(NamedTuple):
    """How a mode is drawn."""

    colour: str
    marker: str


# Okabe and Ito's colours, and greys for what is no mode of motion.
MODE_SYMBOLS: Final[dict[str, ModeSymbol]] = {
    "gliding": ModeSymbol("#0072b2", "o"),
    "rotational": ModeSymbol("#d55e00", "^"),
    "zigzag": ModeSymbol("#009e73", "D"),
    "other": ModeSymbol("#e6a8c8", "s"),
    "stationary": ModeSymbol("#bdbdbd", "o"),
    "fragmented": ModeSymbol("#222222", "X"),
    "too short": ModeSymbol("#ffffff", "v"),
    "failed": ModeSymbol("#ffffff", "o"),
}
EDGE: Final = "#222222"
