"""A straight edge that moves steadily under any law, by the force that its bonds bear."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final, NamedTuple

import numpy as np

from cellcrawl.laws.law import Law
from cellcrawl.laws.rest import RestState, edge_bearing, local_values
from cellcrawl.linear.bracketing import bracketed_roots
from cellcrawl.parameters import Parameters

_FORCES: Final = np.concatenate([np.linspace(0.0, 6.0, 2401), np.linspace(6.0, 40.0, 1700)[1:]])


class Branch(NamedTuple):
    """Edges over which the velocity rises or falls throughout, in the order of rising velocity."""

    forces: np.ndarray
    velocities: np.ndarray
    loads: np.ndarray

    @property
    def fastest(self) -> float:
        """Largest outward velocity."""
        return float(self.velocities[-1])

    def mirrored(self) -> Branch:
        """Return the same edges with their velocities inwards."""
        return Branch(self.forces[::-1], -self.velocities[::-1], self.loads[::-1])


class MovingEdges:
    """Edges in balance with their linkers in equilibrium, one for each force on a bond.

    Parameters
    ----------
    parameters : Parameters
        The cell.
    laws : Law
    drag : float
        What the springs of a crawling cell pull on an edge for each unit of outward velocity.
    every : int
        Leave out all but every so many of the forces: quicker, for what is interpolated.
    """

    def __init__(self, parameters: Parameters, laws: Law, drag: float, *, every: int = 1) -> None:
        self._grid = _FORCES[::every]
        self._laws, self._drag = laws, drag
        self._values: dict[str, Any] = {**local_values(parameters, laws), "kappa": 0.0}
        velocity, _, _, tension = self._at(self._grid)
        load = tension - drag * velocity
        usable = np.isfinite(velocity) & np.isfinite(load)
        outwards = velocity[usable & (velocity > 0.0)]
        fastest = float(outwards.max()) if outwards.size else 0.0
        self._usable = usable & (velocity > -2.0 * fastest)
        self._velocity, self._load = velocity, load

    def fronts(self) -> Iterator[Branch]:
        """Branches that hold edges that move outwards."""
        return (branch for branch in self._branches() if branch.fastest > 0.0)

    def rears(self) -> Iterator[Branch]:
        """Branches that hold edges that move inwards, with the velocity inwards."""
        mirrored = (branch.mirrored() for branch in self._branches())
        return (branch for branch in mirrored if branch.fastest > 0.0)

    def force(self, branch: Branch, velocity: np.ndarray, *, inwards: bool) -> np.ndarray:
        """Return the forces on a bond at which the edges of a branch have these velocities."""
        sign = -1.0 if inwards else 1.0
        place = np.searchsorted(branch.velocities, velocity) - 1
        place = np.clip(place, 0, branch.velocities.size - 2)
        ends = branch.forces[place], branch.forces[place + 1]

        def excess(phi: np.ndarray) -> np.ndarray:
            found: np.ndarray = sign * self._at(phi)[0] - velocity
            return found

        return bracketed_roots(excess, np.minimum(*ends), np.maximum(*ends))

    def load(self, force: np.ndarray) -> np.ndarray:
        """Return the tension less the pull of the springs, which front and rear share."""
        velocity, _, _, tension = self._at(force)
        load: np.ndarray = tension - self._drag * velocity
        return load

    def edge(self, force: float) -> tuple[float, RestState]:
        """Return the outward velocity of an edge and its state, with the whole pull on it."""
        velocity, r, n, tension = (float(value) for value in self._at(np.asarray(force)))
        return velocity, RestState(float(force), r, n, tension)

    def _at(self, phi: np.ndarray) -> tuple[np.ndarray, ...]:
        with np.errstate(all="ignore"):
            found = edge_bearing(self._laws, self._values, phi)
        return tuple(np.broadcast_to(np.asarray(value, float), np.shape(phi)) for value in found)

    def _branches(self) -> Iterator[Branch]:
        rising = np.sign(np.diff(self._velocity))
        joined = (rising != 0.0) & self._usable[1:] & self._usable[:-1]
        first = 0
        while first < joined.size:
            if not joined[first]:
                first += 1
                continue
            last = first
            while last < joined.size and joined[last] and rising[last] == rising[first]:
                last += 1
            part = slice(first, last + 1)
            order = slice(None, None, int(rising[first]))
            yield Branch(_FORCES[part][order], self._velocity[part][order], self._load[part][order])
            first = last
