"""The resting circle under any law: forces in balance, linkers in equilibrium, no motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, Self

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.laws.law import LOCAL, PAPER, Law
from cellcrawl.parameters.dimensionless import Parameters

_FORCES: Final = np.concatenate([np.linspace(1e-6, 1.0, 400), np.linspace(1.0, 40.0, 2000)[1:]])
_HALVINGS = 200


@dataclass(frozen=True)
class RestState:
    """A resting circle of radius 1."""

    bond_force: float
    off_rate: float
    bound_fraction: float
    tension: float


def local_values(parameters: Parameters, laws: Law) -> dict[str, float]:
    """Return the local parameters of a cell under a law, far from any surroundings."""
    of_cell = {name: getattr(parameters, name) for name in LOCAL if name != "pressure"}
    return {**of_cell, "pressure": 0.0, **laws.values}


@checked
def rest_states(
    parameters: Parameters, laws: Law = PAPER, curvature: float = 1.0
) -> list[RestState]:
    """Return all resting circles of radius 1, the least force on a bond first.

    With ``curvature`` 0, the resting straight edges.

    Raises
    ------
    InputError
        If a law is used at a value where its own conditions do not hold.
    """
    complaint = laws.check(parameters)
    if complaint is not None:
        raise InputError(f"{laws.name}: {complaint}")
    p = {**local_values(parameters, laws), "kappa": curvature}
    with np.errstate(all="ignore"):
        speed = np.broadcast_to(edge_bearing(laws, p, _FORCES)[0], _FORCES.shape)
    out, finite = speed > 0.0, np.isfinite(speed)
    changes = np.flatnonzero((out[:-1] != out[1:]) & finite[:-1] & finite[1:])
    return [_between(laws, p, _FORCES[k], _FORCES[k + 1]) for k in changes]


@checked
def rest_state(parameters: Parameters, laws: Law = PAPER, curvature: float = 1.0) -> RestState:
    """Return the resting circle of radius 1, that of the least force on a bond if there are some.

    With ``curvature`` 0, the resting straight edge.

    Raises
    ------
    InputError
        If there is none.
    """
    if laws.compiled is PAPER.compiled:
        p = parameters
        tension = p.sigma_bar * ((1.0 + p.h) / (1.0 + curvature * p.h))
        return RestState(float(np.log(p.r_p)), p.r_p, p.n_bar, tension)
    found = rest_states(parameters, laws, curvature)
    if not found:
        shape = "edge" if curvature == 0.0 else "circle"
        raise InputError(
            f"under {laws!r} there is no resting {shape}: no force on the bonds makes the "
            f"retrograde flow as fast as polymerisation, {parameters.v_p:g}"
        )
    return found[0]


class CellAtRest(Parameters):
    """Parameters whose resting circle is that of another law than the paper's."""

    rest: RestState

    @classmethod
    def of(cls, parameters: Parameters, rest: RestState) -> Self:
        """Return the same parameters with another resting circle."""
        made = object.__new__(cls)
        made.__dict__.update(parameters.__dict__, rest=rest)
        return made

    @property
    def n_bar(self) -> float:
        """Bound fraction of the resting circle."""
        return self.rest.bound_fraction

    @property
    def sigma_bar(self) -> float:
        """Membrane tension of the resting circle of radius 1."""
        return self.rest.tension


def edge_bearing(laws: Law, p: dict[str, Any], phi: Any) -> tuple[Any, Any, Any, Any]:
    """Velocity, off-rate, bound fraction and tension of an edge that moves steadily.

    Its bonds bear ``phi`` and are in equilibrium; ``p`` holds the local parameters and the
    curvature, numbers or arrays.
    """
    evaluate = laws.compiled.evaluate
    values = {**p, "phi": phi, "sigma": 0.0, "n": 0.0}
    values["r"] = evaluate("off_rate", values)
    values["n"] = zero_in(laws, "binding", values, "n", 0.5)
    values["sigma"] = zero_in(laws, "balance", values, "sigma", 1000.0)
    return evaluate("velocity", values), values["r"], values["n"], values["sigma"]


def zero_in(laws: Law, what: str, values: dict[str, Any], name: str, guess: float) -> Any:
    """Where a formula is 0 in one variable, by Newton steps; exact at once where it is linear."""
    x = guess + 0.0 * np.asarray(values["phi"])
    for _ in range(30):
        at = {**values, name: x}
        step = laws.compiled.evaluate(what, at) / laws.compiled.evaluate(f"{what}/{name}", at)
        x = x - step
        if np.all(np.abs(step) <= 1e-14 * (1.0 + np.abs(x)), where=np.isfinite(x)):
            break
    return x


def _between(laws: Law, p: dict[str, Any], low: float, high: float) -> RestState:
    outward = edge_bearing(laws, p, low)[0] > 0.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        if (edge_bearing(laws, p, middle)[0] > 0.0) == outward:
            low = middle
        else:
            high = middle
    _, r, n, sigma = edge_bearing(laws, p, low)
    return RestState(float(low), float(r), float(n), float(sigma))
