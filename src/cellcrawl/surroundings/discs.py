"""Ground and obstacles made of discs, as one paints them, and a brief touch of the edge."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.laws.expressions import exp, maximum, minimum, tanh
from cellcrawl.laws.law import Parameter
from cellcrawl.surroundings.base import Place, Surrounding
from cellcrawl.validation import real_array

_MOST: Final = 1000
_ALWAYS: Final = (-1e12, 1e12)  # begin and end of a disc that has none
_WHOLE: Final = 8.0  # distances over which a ground changes, from which on it has


class _Discs(Surrounding):
    """Discs in the plane; where they overlap they are one."""

    def __init__(self, discs: Any, **values: float) -> None:
        made = real_array("discs", discs, (None, None))
        if made.shape[1] not in (3, 5):
            raise InputError(
                f"discs has {made.shape[1]} columns: x, y, radius, or these and begin and end"
            )
        if not 1 <= len(made) <= _MOST:
            raise InputError(f"there are {len(made)} discs: from 1 to {_MOST} can be given")
        if made[:, 2].min() <= 0.0:
            raise InputError("discs has a radius that is not above 0: rows are x, y, radius")
        super().__init__(**values)
        self.discs = made

    def grows_from(self) -> float:
        """Return how far below 0 the radius of a disc that comes begins."""
        return 0.0

    def table(self) -> np.ndarray:
        times = self.discs[:, 3:] if self.discs.shape[1] == 5 else [_ALWAYS] * len(self.discs)
        rows = np.column_stack([self.discs[:, :3], times])
        return np.concatenate([[self.grows_from(), len(rows)], rows.ravel()])

    def describe(self) -> dict[str, Any]:
        found = super().describe()
        return {**found, "values": {"discs": self.discs.tolist(), **found["values"]}}


@checked
class Islands(_Discs):
    """Discs of adhesive ground: elsewhere the on-rate is ``outside`` times as large.

    Before the first disc and after the last the whole ground is adhesive.

    Parameters
    ----------
    discs : array, shape (discs, 3) or (discs, 5)
        Middle and radius of each, in cell radii; and the times at which it begins to be there and
        to go, each of which takes 0.5.

    Raises
    ------
    InputError
        For no disc, more than 1000, rows of another length, or a radius that is not above 0.
    """

    outside = Parameter(0.5, 0.0, 10.0, "on-rate elsewhere over that on the discs")
    edge = Parameter(0.5, 1e-3, 10.0, "distance over which the ground changes, in cell radii")

    def change(self, at: Place, p: Any) -> Mapping[str, Any]:
        there = self.look_up("disc_presence", at, at.time)
        off = self.outside + (1.0 - self.outside) * (1.0 - there)
        on = 0.5 * (1.0 + tanh(self.look_up("disc_depth", at, at.time) / self.edge))
        return {"r_on": p.r_on * (off + (1.0 - off) * on)}

    def grows_from(self) -> float:
        return _WHOLE * self.values["edge"]


@checked
class Pillars(_Discs):
    """Round obstacles, as micropillars are: the edge is pushed back where it enters one.

    Parameters
    ----------
    discs : array, shape (discs, 3) or (discs, 5)
        Middle and radius of each, in cell radii; and the times at which it begins to be there and
        to go, each of which takes 0.5.

    Raises
    ------
    InputError
        For no disc, more than 1000, rows of another length, or a radius that is not above 0.
    """

    stiffness = Parameter(1e4, 0.0, 1e7, "pressure over how deep the edge is in a pillar")

    def change(self, at: Place, p: Any) -> Mapping[str, Any]:
        depth = maximum(self.look_up("disc_depth", at, at.time), 0.0)
        return {"pressure": p.pressure + self.stiffness * depth}


class LocalPulse(Surrounding):
    """A brief touch at one place: linkers do not bind there for a while, or the edge is pushed.

    In time it swells and fades as ``16 u^2 (1 - u)^2``, u from 0 to 1; in space as a Gaussian.
    """

    x = Parameter(0.0, -1e6, 1e6, "where it is")
    y = Parameter(0.0, -1e6, 1e6, "where it is")
    radius = Parameter(0.5, 0.01, 1e3, "distance at which it is exp(-1) as strong, in cell radii")
    begin = Parameter(0.0, -1e12, 1e12, "time at which it begins")
    duration = Parameter(0.5, 1e-3, 1e6, "how long it lasts")
    binding = Parameter(1.0, 0.0, 10.0, "on-rate in the middle over that elsewhere, at its height")
    push = Parameter(0.0, -1e6, 1e6, "inward pressure in the middle, at its height")

    def change(self, at: Place, p: Any) -> Mapping[str, Any]:
        u = minimum(maximum((at.time - self.begin) / self.duration, 0.0), 1.0)
        x, y = (at.x - self.x) / self.radius, (at.y - self.y) / self.radius
        strength = 16.0 * (u * u * ((1.0 - u) * (1.0 - u))) * exp(-(x * x + y * y))
        return {
            "r_on": p.r_on * (1.0 - (1.0 - self.binding) * strength),
            "pressure": p.pressure + self.push * strength,
        }
