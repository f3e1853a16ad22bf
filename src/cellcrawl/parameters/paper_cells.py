"""The nine cells that the paper names in its Fig. 4."""

from __future__ import annotations

from typing import Final

PAPER_MODES: Final = {
    (16, 600): "gliding",
    (56, 560): "gliding",
    (24, 540): "rotational",
    (26, 600): "zigzag",
    (36, 560): "zigzag",
    (38, 580): "other",
    (40, 540): "other",
    (40, 600): "other",
    (44, 560): "other",
}
"""(r_on, zeta_1) of each, in the order of Fig. 4 B-J, and what the paper calls it."""
