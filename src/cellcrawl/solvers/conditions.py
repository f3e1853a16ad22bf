"""What a solver asks of the parameters: their values along the edge, now.

Solvers never see a constant: they get one row of values per local parameter, one value per node.
Parameters that vary along the edge or over the substrate need a class with these methods and no
change in any solver.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.laws.law import PAPER, Law
from cellcrawl.laws.rest import local_values
from cellcrawl.parameters.dimensionless import Parameters
from cellcrawl.parameters.schedule import CONSTANT, Schedule
from cellcrawl.validation import known_names

if TYPE_CHECKING:
    from cellcrawl.surroundings.base import CompiledSurroundings, Surroundings


@dataclass(frozen=True)
class Conditions:
    """Parameters of one run with their schedule, and the laws they belong to; immutable."""

    parameters: Parameters
    schedule: Schedule = CONSTANT
    laws: Law = PAPER
    surroundings: Surroundings | None = None

    def around(self) -> CompiledSurroundings | None:
        """Return the surroundings for kernels, None if there are none."""
        return None if self.surroundings is None else self.surroundings.compiled(self.laws)

    @property
    def uniform(self) -> bool:
        """Whether the parameters are the same all along the edge."""
        return True

    def at(self, time: float) -> Parameters:
        """Return the parameters that hold from ``time`` on."""
        return self._at(time)

    def laws_at(self, time: float, *, before: bool = False) -> Law:
        """Return the law set with the numbers that hold from ``time`` on, or up to it."""
        values = self.schedule.laws_at(time, before=before)
        return self.laws.replace(**values) if values else self.laws

    def check(self) -> None:
        """Raise `InputError` if the law set cannot be used with what the schedule makes of it."""
        names, own = self.schedule.law_numbers, self.laws.parameters
        if names and not own:
            raise InputError(
                f"{self.laws.name} has no numbers to schedule: laws.{names[0]} is none"
            )
        known_names(f"{self.laws.name} in the schedule", names, own)
        if self.laws == PAPER:
            return
        for time in (*self.schedule.breaks, -math.inf):
            for before in (False, True):
                law = self.laws_at(time, before=before)
                complaint = law.check(self._at(time, before=before))
                if complaint is not None:
                    raise InputError(f"{law.name} at t = {time:g}: {complaint}")

    def edge(self, time: float, nodes: int, *, before: bool = False) -> np.ndarray:
        """Return the local parameters at equal arclengths, shape (rows of the law, nodes).

        The first node is the edge's.

        With ``before``, a jump at ``time`` has not happened yet.
        """
        column = edge_column(self._at(time, before=before), self.laws)
        if self.schedule.law_numbers:
            column = column.copy()
            for name, value in self.schedule.laws_at(time, before=before).items():
                column[self.laws.rows.index(name)] = value
        return np.repeat(column, nodes, axis=1)

    def tension_rate(self, time: float, *, before: bool = False) -> float:
        """Return ``G`` of the tension law from ``time`` on, or up to it with ``before``."""
        return self._at(time, before=before).tension_rate

    def next_break(self, time: float) -> float:
        """Return the next time at which a parameter jumps or a ramp begins or ends."""
        return self.schedule.next_break(time) if self.schedule.breaks else math.inf

    def varies(self, start: float, end: float) -> bool:
        """Whether a parameter ramps between ``start`` and ``end``."""
        return bool(self.schedule.breaks) and self.schedule.varies(start, end)

    def extremes(self) -> list[Parameters]:
        """Return the parameters at the start and at both sides of every break."""
        found = [self.parameters if not self.schedule.breaks else self.at(-np.inf)]
        for time in self.schedule.breaks:
            found += [self.schedule.before(self.parameters, time), self.at(time)]
        return found

    def _at(self, time: float, *, before: bool = False) -> Parameters:
        if not self.schedule.breaks:
            return self.parameters
        return (self.schedule.before if before else self.schedule.at)(self.parameters, time)


@functools.lru_cache(maxsize=16)
def edge_column(parameters: Parameters, laws: Law) -> np.ndarray:
    """Return the local parameters of a cell, shape (rows of the law, 1); not to be written to."""
    values = local_values(parameters, laws)
    return np.array([[values[name]] for name in laws.rows])
