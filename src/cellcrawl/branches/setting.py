"""What a branch holds fixed or moves: parameters, law set, and the family of tension and area."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from cellcrawl.errors import InputError, nearest_name
from cellcrawl.laws import as_law
from cellcrawl.laws.force_balance import SOLVED, solve_bonds
from cellcrawl.laws.law import PAPER, Law
from cellcrawl.laws.rest import RestState, local_values, rest_state
from cellcrawl.parameters import DESCRIPTIONS, Parameters


class OutOfRange(Exception):
    """No force on the bonds balances the pull somewhere, or a value left the model."""


class Pointwise(NamedTuple):
    """The law at each node, and its slopes with the balance of forces kept; shape (nodes,)."""

    phi: np.ndarray
    speed: np.ndarray
    binding: np.ndarray
    speed_by: tuple[np.ndarray, np.ndarray, np.ndarray]
    """By curvature, bound fraction and tension."""
    binding_by: tuple[np.ndarray, np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Setting:
    """Parameters, laws and the area at which a cell has the tension of the resting circle.

    ``tension = sigma_bar + G (area - rest_area)`` labels the family; it is pi for a cell that began
    as a circle of radius 1.
    """

    parameters: Parameters
    laws: Law = PAPER
    rest_area: float = math.pi
    _values: dict[str, Any] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "laws", as_law(self.laws))
        if self.parameters.k_sigma == 0.0:
            raise InputError(
                "k_sigma = 0: tension then does not hang on area, and there is no family of states "
                "to follow; give a value above 0"
            )
        object.__setattr__(self, "_values", local_values(self.parameters, self.laws))

    @property
    def tension_rate(self) -> float:
        """``G`` of the tension law."""
        return self.parameters.tension_rate

    @functools.cached_property
    def rest(self) -> RestState:
        """The resting circle of radius 1."""
        return rest_state(self.parameters, self.laws)

    def tension(self, area: float) -> float:
        """Tension of a cell of some area in this family."""
        return self.rest.tension + self.tension_rate * (area - self.rest_area)

    def value(self, name: str) -> float:
        """Value of a parameter of the model or of the law."""
        bounds_of(self.laws, name)
        found = self.laws.values if name in self.laws.parameters else self.parameters.to_dict()
        return float(found[name])

    def replace(self, name: str, value: float) -> Setting:
        """Return the same with one parameter changed."""
        parameters, laws = self.parameters, self.laws
        if name in laws.parameters:
            laws = laws.replace(**{name: float(value)})
        else:
            parameters = parameters.replace(**{name: float(value)})
        return Setting(parameters, laws, self.rest_area)

    def bonds(self, phi: np.ndarray, n: np.ndarray, sigma: float, kappa: np.ndarray) -> np.ndarray:
        """Return the force on the bonds at each node, from any guess.

        Raises
        ------
        OutOfRange
            If it has no value somewhere.
        """
        values = self._values
        column = np.array([[values[name]] for name in self.laws.rows])
        edge = np.repeat(column, n.size, axis=1)
        found = np.array(phi, dtype=float)
        if not (np.all(np.isfinite(n)) and np.all(np.isfinite(kappa)) and math.isfinite(sigma)):
            raise OutOfRange
        code = solve_bonds(self.laws.compiled, found, n, sigma, np.ascontiguousarray(kappa), edge)
        if code != SOLVED or not np.all(np.isfinite(found)):
            raise OutOfRange
        return found

    def pointwise(
        self, phi: np.ndarray, n: np.ndarray, sigma: float, kappa: np.ndarray
    ) -> Pointwise:
        """Return the law at each node, from a guess of the force on the bonds."""
        phi = self.bonds(phi, n, sigma, kappa)
        values: dict[str, Any] = {**self._values, "phi": phi, "n": n}
        values |= {"sigma": sigma, "kappa": kappa}
        evaluate = self.laws.compiled.evaluate
        values["r"] = evaluate("off_rate", values)

        def at(what: str) -> np.ndarray:
            return np.broadcast_to(np.asarray(evaluate(what, values), dtype=float), phi.shape)

        slope = at("balance/phi")
        by = tuple(-at(f"balance/{name}") / slope for name in ("kappa", "n", "sigma"))
        speed, bind = at("velocity/phi"), at("binding/phi")
        return Pointwise(
            phi,
            at("velocity"),
            at("binding"),
            (
                speed * by[0] + at("velocity/kappa"),
                speed * by[1],
                speed * by[2] + at("velocity/sigma"),
            ),
            (bind * by[0], bind * by[1] + at("binding/n"), bind * by[2]),
        )

    def friction(self, phi: np.ndarray, n: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Off-rate of the bonds, and friction on the ground."""
        evaluate = self.laws.compiled.evaluate
        values: dict[str, Any] = {**self._values, "phi": phi, "n": n}
        values["r"] = evaluate("off_rate", values)
        rate = np.broadcast_to(values["r"], phi.shape)
        return rate, np.broadcast_to(evaluate("friction", values), phi.shape)


def bounds_of(laws: Law, name: Any) -> tuple[float, float]:
    """Return the values that a parameter, of the model or of the law, may have."""
    known: dict[str, Any] = {**DESCRIPTIONS, **laws.parameters}
    if not isinstance(name, str) or name not in known:
        raise InputError(f"there is no parameter {name!r}: {nearest_name(name, known)}")
    described = known[name]
    return float(described.low), float(described.high)
