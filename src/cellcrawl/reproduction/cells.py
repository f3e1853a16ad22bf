"""The cells that the paper names: nine points of the plane, and changes between modes."""

from __future__ import annotations

from typing import Final, NamedTuple

from cellcrawl.parameters import Parameters, Schedule
from cellcrawl.parameters.paper_cells import PAPER_MODES

LONG: Final = 100.0
"""Time of the paper's runs."""


class Cell(NamedTuple):
    """A named point of the (r_on, zeta_1) plane."""

    r_on: float
    zeta_1: float
    mode: str
    """The paper's name for what it does."""
    apart: float
    """Time between the contours in the paper's Fig. 4."""

    @property
    def parameters(self) -> Parameters:
        """All parameters; the rest are the paper's."""
        return Parameters(r_on=self.r_on, zeta_1=self.zeta_1)


_APART: Final = (10, 10, 10, 10, 15, 20, 20, 20, 20)

NINE: Final = tuple(
    Cell(*point, mode, apart)
    for (point, mode), apart in zip(PAPER_MODES.items(), _APART, strict=True)
)
"""In the order of the paper's Fig. 4 B-J and Movies S1-S9."""


class Change(NamedTuple):
    """A cell that is one, then, from a time on, another."""

    first: tuple[float, float]
    second: tuple[float, float]
    title: str
    time: float = 30.0
    over: float = 0.0
    """How long the change takes; 0 for a jump."""

    @property
    def parameters(self) -> Parameters:
        """Parameters before the change."""
        return Parameters(r_on=self.first[0], zeta_1=self.first[1])

    @property
    def schedule(self) -> Schedule:
        """Both parameters over time."""
        return through([(self.time, self.first), (self.time + self.over, self.second)])


TRANSITIONS: Final = (
    Change((26, 600), (24, 540), "from zigzag (26, 600) to rotation (24, 540) at t = 30"),
    Change((24, 540), (56, 560), "from rotation (24, 540) to gliding (56, 560) at t = 30"),
    Change(
        (56, 560), (26, 600), "from gliding (56, 560) to zigzag (26, 600), t = 30 to 40", 30, 10
    ),
)
"""Movies S10-S12: the paper's main text does not say which changes they show; this is our choice.

The last is gradual: an abrupt one leaves the cell at rest, see Fig. 6 C."""


def through(points: list[tuple[float, tuple[float, float]]]) -> Schedule:
    """Return the schedule through points (r_on, zeta_1) at times; a repeated time is a jump."""
    return Schedule(
        {
            name: [(time, point[index]) for time, point in points]
            for index, name in enumerate(("r_on", "zeta_1"))
        }
    )


def said(cell: Cell) -> str:
    """Return what a movie of the cell shows."""
    return f"({cell.r_on:g}, {cell.zeta_1:g}), {cell.mode}, t = 0 to {LONG:g}"
