"""Theory of two edges: growth rates of the still cell, crawling states and where they are stable.

Linearised about the still state, the sum and the difference of the edges decouple. The sum feels
the tension and grows as the breathing mode of the round cell; the difference does not, and grows as
its translation without diffusion. ``a, b, c, q`` are those of `linear.base_state`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final, NamedTuple

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.laws.law import PAPER
from cellcrawl.laws.rest import local_values
from cellcrawl.linear.bracketing import all_roots
from cellcrawl.linear.characteristic import (
    Characteristic,
    characteristic,
    checked_shapes,
    checked_values,
)
from cellcrawl.linear.quadratic import ordered_roots
from cellcrawl.one_dimensional.cell import (
    FREE,
    Anchoring,
    checked_cell,
    length_stiffness,
    off_rates_at,
)
from cellcrawl.parameters import Parameters
from cellcrawl.validation import one_of

SYMMETRIES: Final = ("symmetric", "antisymmetric")
_PARTS: Final = 400


class CrawlingState(NamedTuple):
    """A cell that crawls steadily."""

    speed: float
    """Speed of the cell, in R_0 k_off0."""
    off_rates: tuple[float, float]
    """Front and rear."""
    bound_fractions: tuple[float, float]
    """Front and rear."""
    tension: float
    growth_rate: float
    """Largest real part of the growth rates about it; below 0 it is stable."""

    @property
    def stable(self) -> bool:
        """Whether small perturbations of it decay."""
        return self.growth_rate < 0.0


@checked
def growth_rates(
    parameters: Parameters, symmetry: str, *, anchoring: Anchoring = FREE, **values: Any
) -> np.ndarray:
    """Growth rates of the still cell for edges that move alike or against each other.

    Parameters
    ----------
    parameters : Parameters
        The cell; its ``elasticity`` is the tension law.
    symmetry : {"symmetric", "antisymmetric"}
        Both edges outwards together, which stretches the cell, or one out and one in.
    anchoring : Anchoring
        Springs to the cell body; none unless given.
    **values : float or array
        Parameters by name that replace those of the cell, as for `linear.growth_rates`.

    Returns
    -------
    array, complex, shape (..., 2)
        The larger root first; of a complex pair the one with the positive imaginary part. Without
        springs the antisymmetric roots are ``b/a - q`` and 0, which is a shift of the cell.

    Raises
    ------
    InputError
        For an unknown symmetry or name, values out of range, or shapes that do not broadcast.
    """
    checked_cell(parameters, anchoring)
    given = checked_values("growth_rates", values)
    checked_shapes(np.zeros(()), given)
    damping, restoring, a = _coefficients(parameters, symmetry, anchoring, given)
    half, product = np.broadcast_arrays(0.5 * damping / a, restoring / a)
    return ordered_roots(half, product, half**2 - product)


def margin(
    parameters: Parameters, symmetry: str, anchoring: Anchoring, values: dict[str, np.ndarray]
) -> np.ndarray:
    """Return a number above 0 where a symmetry grows and below 0 where it decays."""
    damping, restoring, a = _coefficients(parameters, symmetry, anchoring, values)
    shifts = symmetry == "antisymmetric" and anchoring.stiffness == 0.0
    by_damping = -damping / a
    grows: np.ndarray = by_damping if shifts else np.maximum(by_damping, -restoring / a)
    return grows


def _coefficients(
    parameters: Parameters, symmetry: str, anchoring: Anchoring, values: dict[str, np.ndarray]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return those of ``lam`` and 1, and of ``lam**2``, in the quadratic."""
    one_of("symmetry", symmetry, SYMMETRIES)
    at = {**parameters.to_dict(), **values}
    springs = at["epsilon"] * anchoring.stiffness
    flat = characteristic(parameters, 1.0, {**values, "D": np.zeros(())})
    if symmetry == "symmetric":
        gain = at["k_sigma"] / (at["epsilon"] if parameters.elasticity == "consistent" else 1.0)
        stretched = _with(flat, 2.0 * np.pi * at["epsilon"] * gain + springs)
        return stretched.damping, stretched.restoring, stretched.a
    if anchoring.stiffness == 0.0:
        free = _with(flat, np.zeros(()))
        return free.damping, free.restoring, free.a
    held, mu = _with(flat, springs), anchoring.relaxation
    return (
        held.damping + held.a * mu,
        held.restoring + mu * (held.a * held.q - held.b),
        held.a,
    )


def _with(flat: Characteristic, stiffness: np.ndarray) -> Characteristic:
    return flat._replace(stiffness=np.asarray(stiffness))


@checked
def crawling_states(parameters: Parameters, *, anchoring: Anchoring = FREE) -> list[CrawlingState]:
    """Return the states in which the cell crawls steadily, slowest first.

    The front sticks and the rear slips, ``v_p`` minus and plus the same speed, under one tension.
    They do not depend on the tension law or the contraction, only their stability does.

    Parameters
    ----------
    parameters : Parameters
        The cell.
    anchoring : Anchoring
        Springs to the cell body; none unless given. A body that never moves lets nothing crawl.

    Returns
    -------
    list of CrawlingState
        Empty where the cell cannot crawl; two where it can both stay and crawl.
    """
    checked_cell(parameters, anchoring)
    p = parameters
    if anchoring.stiffness > 0.0 and anchoring.relaxation == 0.0:
        return []
    found = all_roots(_force_difference(p, anchoring), 1e-6 * p.v_p, p.v_p, 4001)
    return [_state(p, anchoring, float(delta)) for delta in found]


def crawling_margin(
    parameters: Parameters, anchoring: Anchoring, values: dict[str, np.ndarray]
) -> np.ndarray:
    """Return a number above 0 where a steadily crawling state exists."""
    at = {**parameters.to_dict(), **values}
    shape = np.broadcast_shapes(*(np.shape(value) for value in values.values()))
    if anchoring.stiffness > 0.0 and anchoring.relaxation == 0.0:
        return np.full(shape, -1.0)
    drag = _drag(at["epsilon"], anchoring)
    r_on, zeta_1, r_p = (
        np.asarray(at[name], float)[..., None] for name in ("r_on", "zeta_1", "r_p")
    )
    v_p = r_p * np.log(r_p)
    part = np.linspace(0.0, 1.0, _PARTS + 1)[1:]
    slow, fast = (
        _pull(r_on, zeta_1, off_rates_at(v_p * (1.0 + way * part))) for way in (-1.0, 1.0)
    )
    lowest = np.min((fast - slow) / (v_p * part), axis=-1)
    return np.broadcast_to(-(lowest + drag), shape)


def _pull(r_on: Any, zeta_1: Any, off_rate: np.ndarray) -> np.ndarray:
    """Friction of an edge whose linkers are in equilibrium."""
    values = {"phi": np.log(off_rate), "r": off_rate, "n": r_on / (r_on + off_rate)}
    pull: np.ndarray = PAPER.compiled.evaluate("friction", {**values, "zeta_1": zeta_1})
    return pull


def _drag(epsilon: Any, anchoring: Anchoring) -> Any:
    """Return how much more the springs pull on the front, for each unit of the half difference."""
    if anchoring.stiffness == 0.0:
        return 0.0
    return 2.0 * anchoring.stiffness * epsilon / anchoring.relaxation


def _force_difference(p: Parameters, anchoring: Anchoring) -> Callable[[np.ndarray], np.ndarray]:
    """Return the function whose roots are the half differences of crawling edges' velocities."""
    drag = _drag(p.epsilon, anchoring)

    def difference(delta: np.ndarray) -> np.ndarray:
        slow, fast = (
            _pull(p.r_on, p.zeta_1, off_rates_at(p.v_p + way * delta)) for way in (-1.0, 1.0)
        )
        ratio: np.ndarray = (fast - slow) / delta + drag
        return ratio

    return difference


def _state(p: Parameters, anchoring: Anchoring, delta: float) -> CrawlingState:
    velocities = np.maximum([p.v_p - delta, p.v_p + delta], 0.0)
    front, rear = (float(r) for r in off_rates_at(velocities))
    n = tuple(p.r_on / (p.r_on + r) for r in (front, rear))
    pulls = [float(_pull(p.r_on, p.zeta_1, np.asarray(r))) for r in (front, rear)]
    rates = np.linalg.eigvals(_jacobian(p, anchoring, (front, rear), (n[0], n[1])))
    return CrawlingState(
        speed=p.epsilon * delta,
        off_rates=(front, rear),
        bound_fractions=(n[0], n[1]),
        tension=0.5 * (pulls[0] + pulls[1]) - p.sigma_c,
        growth_rate=float(rates.real.max()),
    )


def _jacobian(
    p: Parameters, anchoring: Anchoring, off_rates: tuple[float, float], n: tuple[float, float]
) -> np.ndarray:
    """Slopes of the rates of (n, n, tension[, imbalance]); shifts of the cell are left out."""
    tied = anchoring.stiffness > 0.0
    total = length_stiffness(p) + 0.5 * anchoring.stiffness
    matrix = np.zeros((4, 4))
    for edge, side in enumerate((1.0, -1.0)):
        r = off_rates[edge]
        values = {**local_values(p, PAPER), "phi": float(np.log(r)), "r": r, "n": n[edge]}
        values |= {"sigma": 0.0, "kappa": 0.0}  # the slopes do not depend on the tension

        def slope(what: str, values: dict[str, float] = values) -> float:
            return float(PAPER.compiled.evaluate(what, values))

        phi_n = -slope("balance/n") / slope("balance/phi")
        phi_sigma = -slope("balance/sigma") / slope("balance/phi")
        pulled = np.array([1.0, side])
        matrix[edge, edge] = slope("binding/n") + slope("binding/phi") * phi_n
        matrix[edge, 2:] = slope("binding/phi") * phi_sigma * pulled
        springs = np.array([total, 0.5 * anchoring.stiffness * side])
        matrix[2:, edge] = springs * slope("velocity/phi") * phi_n
        matrix[2:, 2:] += np.outer(springs, slope("velocity/phi") * phi_sigma * pulled)
    matrix[3, 3] -= anchoring.relaxation
    return matrix if tied else matrix[:3, :3]
