"""What a solver is: something that holds a cell's state and moves it on in time.

A solver knows nothing of files, plots or progress bars. The simulation asks it to `advance` to a
time, takes a `Frame` of any time in its last step, and can save and restore it by `checkpoint`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from cellcrawl.laws.law import Law
from cellcrawl.solvers.conditions import Conditions
from cellcrawl.starts.base import CellState


@dataclass(eq=False, kw_only=True)
class Instant:
    """The cell as a whole at one instant."""

    time: float
    tension: float
    length: float
    area: float
    centroid_x: float
    centroid_y: float
    surely_simple: bool = False
    """Whether it is plain that the edge does not cross itself; if not, look."""
    closure_gap: float = 0.0
    """Distance between the ends of the edge as the solver holds it, over its length."""


@dataclass(eq=False, kw_only=True)
class Frame(Instant):
    """The cell at one instant, on nodes equally spaced in arclength.

    Arrays have shape (nodes,). ``normal_velocity`` and ``friction`` follow from the rest.
    """

    x: np.ndarray
    y: np.ndarray
    theta: np.ndarray
    curvature: np.ndarray
    bound_fraction: np.ndarray
    off_rate: np.ndarray
    normal_velocity: np.ndarray
    friction: np.ndarray

    @property
    def points(self) -> np.ndarray:
        """Positions of the nodes, shape (nodes, 2)."""
        return np.column_stack([self.x, self.y])


@dataclass(frozen=True)
class Breakdown:
    """Why a solver could not go on: a status, when, and where on the edge."""

    status: str
    time: float
    message: str


class Solver(ABC):
    """A numerical scheme at work on one cell.

    Parameters
    ----------
    start : CellState or None
        The first state; None when `restore` follows.
    conditions : Conditions
        The parameters and how they change.
    time : float
        Time of the first state.
    **options
        The scheme's own numbers, named in `OPTIONS`.
    """

    def __init__(
        self,
        start: CellState | None,
        conditions: Conditions,
        time: float = 0.0,
        *,
        nodes: int,
        **options: Any,
    ) -> None:
        raise NotImplementedError

    name: ClassVar[str]
    OPTIONS: ClassVar[dict[str, str]]
    """Names of the scheme's options with a line on each, for help and error messages."""

    TIMES_AT_ONCE: ClassVar[int] = 1
    """How many times to give `instants`: between two calls a run looks whether it is to stop."""

    time: float
    """Time of the solver's current state: the end of its last step."""

    @classmethod
    @abstractmethod
    def checked_nodes(cls, nodes: Any) -> int:
        """Return the number of nodes in a frame, the usual one for None, or raise `InputError`."""

    @classmethod
    @abstractmethod
    def start_nodes(cls, nodes: int, **options: Any) -> int:
        """Return on how many nodes the start should be given, with these options."""

    @abstractmethod
    def advance(self, target: float) -> Breakdown | None:
        """Step on until ``time >= target``, without shortening a step to hit it.

        Where the steps fall never depends on ``target``, so that a run may be stopped and resumed
        anywhere to the same bits. On a breakdown the state is the last valid one.
        """

    @abstractmethod
    def frame(self, time: float) -> Frame:
        """Return the cell at ``time``, which must lie within the last step."""

    def instant(self, time: float) -> Instant:
        """Return the cell as a whole at ``time``, with the bits of its `frame`; may be cheaper."""
        return self.frame(time)

    def instants(self, times: Sequence[float]) -> tuple[list[Instant], Breakdown | None]:
        """Advance to one time after another; return the cell as a whole there, and a breakdown.

        Goes no further than to the first at which it is not sure that the edge is simple, so that
        a `frame` can be taken and looked at.
        """
        seen: list[Instant] = []
        for time in times:
            ended = self.advance(time)
            if ended is not None:
                return seen, ended
            seen.append(self.instant(time))
            if not seen[-1].surely_simple:
                break
        return seen, None

    @abstractmethod
    def checkpoint(self) -> dict[str, np.ndarray]:
        """Return arrays from which `restore` goes on to the same bits."""

    @abstractmethod
    def restore(self, checkpoint: dict[str, np.ndarray]) -> None:
        """Take up the state a `checkpoint` holds."""

    @property
    def invariant_tolerance(self) -> float:
        """How far a run may be from what the model keeps before it ends as "inconsistent".

        Of area against tension, relative, and of the gap in the edge over its length. A scheme that
        keeps them says a number of its own.
        """
        return 0.05

    @abstractmethod
    def options(self) -> dict[str, Any]:
        """Return the options in force, complete, as plain values."""

    @abstractmethod
    def diagnostics(self) -> dict[str, float]:
        """Return what the solver did so far: steps, right-hand sides, largest closure error."""


def pointwise(
    laws: Law,
    phi: np.ndarray,
    bound_fraction: np.ndarray,
    tension: np.ndarray | float,
    curvature: np.ndarray | float,
    edge: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Off-rate, normal velocity and friction of the edge where bonds bear ``phi``.

    Arrays broadcast to shape (..., nodes), ``edge`` has (rows of the law, nodes).
    """
    values = dict(zip(laws.rows, edge, strict=True))
    values |= {"phi": phi, "n": bound_fraction, "sigma": tension, "kappa": curvature}
    values["r"] = laws.compiled.evaluate("off_rate", values)
    velocity = laws.compiled.evaluate("velocity", values)
    return values["r"], velocity, laws.compiled.evaluate("friction", values)
