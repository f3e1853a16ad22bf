"""Theory of two edges: growth rates of the still cell, crawling states and where they are stable.

Linearised about the still state, the sum and the difference of the edges decouple. The sum feels
the tension and grows as the breathing mode of the round cell; the difference does not, and grows as
its translation without diffusion. ``a, b, c, q`` are those of `linear.base_state`, for the paper's
laws, whose rates are the roots of a quadratic; those of other laws are eigenvalues.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, Final, NamedTuple

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.laws import as_law
from cellcrawl.laws.law import PAPER, Law
from cellcrawl.laws.rest import RestState, local_values, rest_state
from cellcrawl.linear.any_law import matrix_rates
from cellcrawl.linear.characteristic import (
    Characteristic,
    characteristic,
    checked_shapes,
    checked_values,
)
from cellcrawl.numerics.bracketing import all_roots
from cellcrawl.numerics.quadratic import ordered_roots
from cellcrawl.one_dimensional.cell import (
    FREE,
    Anchoring,
    checked_cell,
    length_stiffness,
)
from cellcrawl.one_dimensional.moving_edges import Branch, MovingEdges
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
    parameters: Parameters,
    symmetry: str,
    *,
    anchoring: Anchoring = FREE,
    laws: Any = PAPER,
    **values: Any,
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
    laws : Law or str
        The law set; the paper's unless given.
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
        For an unknown symmetry or name, values out of range, shapes that do not broadcast, or a
        law under which no edge stands still.
    """
    checked_cell(parameters, anchoring)
    law = as_law(laws)
    given = checked_values("growth_rates", values)
    checked_shapes(np.zeros(()), given)
    one_of("symmetry", symmetry, SYMMETRIES)
    if law != PAPER:
        return matrix_rates(_matrices(parameters, symmetry, anchoring, given, law))
    damping, restoring, a = _coefficients(parameters, symmetry, anchoring, given)
    half, product = np.broadcast_arrays(0.5 * damping / a, restoring / a)
    return ordered_roots(half, product, half**2 - product)


def margin(
    parameters: Parameters,
    symmetry: str,
    anchoring: Anchoring,
    values: dict[str, np.ndarray],
    laws: Law = PAPER,
) -> np.ndarray:
    """Return a number above 0 where a symmetry grows and below 0 where it decays."""
    shifts = symmetry == "antisymmetric" and anchoring.stiffness == 0.0
    if laws != PAPER:
        rates = matrix_rates(_matrices(parameters, symmetry, anchoring, values, laws)).real
        nearer = np.argmin(np.abs(rates), axis=-1)[..., None]
        other: np.ndarray = np.take_along_axis(rates, 1 - nearer, axis=-1)[..., 0]
        return other if shifts else rates[..., 0]
    damping, restoring, a = _coefficients(parameters, symmetry, anchoring, values)
    by_damping = -damping / a
    grows: np.ndarray = by_damping if shifts else np.maximum(by_damping, -restoring / a)
    return grows


def _coefficients(
    parameters: Parameters, symmetry: str, anchoring: Anchoring, values: dict[str, np.ndarray]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return those of ``lam`` and 1, and of ``lam**2``, in the quadratic."""
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


def _matrices(
    parameters: Parameters,
    symmetry: str,
    anchoring: Anchoring,
    values: dict[str, np.ndarray],
    laws: Law,
) -> np.ndarray:
    """Slopes of the still cell in one symmetry, shape (..., 2, 2), for each of the values."""
    shape = np.broadcast_shapes(*(np.shape(value) for value in values.values()))
    found = np.empty((*shape, 2, 2))
    for place, cell in _cells(parameters, values, shape):
        rest = rest_state(cell, laws, 0.0)
        found[place] = _parted(_jacobian(cell, laws, anchoring, (rest, rest)), symmetry)
    return found


def _cells(
    parameters: Parameters, values: dict[str, np.ndarray], shape: tuple[int, ...]
) -> Iterator[tuple[tuple[int, ...], Parameters]]:
    """Yield the place of each of the values, and the cell that has them."""
    spread = {name: np.broadcast_to(value, shape) for name, value in values.items()}
    for place in np.ndindex(shape):
        yield (
            place,
            parameters.replace(**{name: float(value[place]) for name, value in spread.items()}),
        )


def _parted(matrix: np.ndarray, symmetry: str) -> np.ndarray:
    """Return slopes of the sum or the difference of two equal edges and of what pulls on it.

    Without springs nothing pulls on the difference; its shift stands in, which has the rate 0.
    """
    way = 1.0 if symmetry == "symmetric" else -1.0
    tied = matrix.shape[0] == 4
    own = matrix[0, 0] + way * matrix[0, 1]
    if way < 0.0 and not tied:
        return np.array([[own, 0.0], [0.0, 0.0]])
    pull = 2 if way > 0.0 else 3
    return np.array(
        [[own, matrix[0, pull]], [matrix[pull, 0] + way * matrix[pull, 1], matrix[pull, pull]]]
    )


@checked
def crawling_states(
    parameters: Parameters, *, anchoring: Anchoring = FREE, laws: Any = PAPER
) -> list[CrawlingState]:
    """Return the states in which the cell crawls steadily, slowest first.

    The front sticks and the rear slips, at the same speed, under one tension. They do not depend on
    the tension law, only their stability does.

    Parameters
    ----------
    parameters : Parameters
        The cell.
    anchoring : Anchoring
        Springs to the cell body; none unless given. A body that never moves lets nothing crawl.
    laws : Law or str
        The law set; the paper's unless given.

    Returns
    -------
    list of CrawlingState
        Empty where the cell cannot crawl; two where it can both stay and crawl.
    """
    checked_cell(parameters, anchoring)
    law = as_law(laws)
    if anchoring.stiffness > 0.0 and anchoring.relaxation == 0.0:
        return []
    edges = MovingEdges(parameters, law, _drag(anchoring))
    states = []
    for front, rear in _pairs(edges):
        fastest = min(front.fastest, rear.fastest)
        slowest = max(1e-6 * fastest, front.velocities[0], rear.velocities[0])
        difference = _load_difference(edges, front, rear)
        for speed in all_roots(difference, slowest, fastest, 4001):
            forces = _forces(edges, front, rear, np.asarray(speed)[None])
            states.append(_state(parameters, law, anchoring, edges, forces))
    return sorted(states)


def crawling_margin(
    parameters: Parameters,
    anchoring: Anchoring,
    values: dict[str, np.ndarray],
    laws: Law = PAPER,
) -> np.ndarray:
    """Return a number above 0 where a steadily crawling state exists."""
    shape = np.broadcast_shapes(*(np.shape(value) for value in values.values()))
    if anchoring.stiffness > 0.0 and anchoring.relaxation == 0.0:
        return np.full(shape, -1.0)
    part = np.linspace(0.0, 1.0, _PARTS + 1)[1:]
    margins = np.full(shape, -np.inf)
    for place, cell in _cells(parameters, values, shape):
        edges = MovingEdges(cell, laws, _drag(anchoring), every=8)
        for front, rear in _pairs(edges):
            fastest = min(front.fastest, rear.fastest)
            speeds = fastest * part
            speeds = speeds[speeds >= max(front.velocities[0], rear.velocities[0])]
            loads = (np.interp(speeds, side.velocities, side.loads) for side in (front, rear))
            rise = np.subtract(*loads) / speeds
            margins[place] = max(margins[place], float(rise.max(initial=-np.inf)))
    return margins


def _drag(anchoring: Anchoring) -> float:
    """Return what the springs pull more on a crawling front than their mean, for its velocity."""
    return anchoring.stiffness / anchoring.relaxation if anchoring.stiffness > 0.0 else 0.0


def _pairs(edges: MovingEdges) -> Iterator[tuple[Branch, Branch]]:
    rears = list(edges.rears())
    return ((front, rear) for front in edges.fronts() for rear in rears)


def _forces(
    edges: MovingEdges, front: Branch, rear: Branch, speed: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the forces on a bond at the front and the rear of cells of these speeds."""
    return edges.force(front, speed, inwards=False), edges.force(rear, speed, inwards=True)


def _load_difference(
    edges: MovingEdges, front: Branch, rear: Branch
) -> Callable[[np.ndarray], np.ndarray]:
    """Return the function of the speed whose roots are crawling cells."""

    def difference(speed: np.ndarray) -> np.ndarray:
        ahead, behind = _forces(edges, front, rear, speed)
        ratio: np.ndarray = (edges.load(behind) - edges.load(ahead)) / speed
        return ratio

    return difference


def _state(
    p: Parameters,
    laws: Law,
    anchoring: Anchoring,
    edges: MovingEdges,
    forces: tuple[np.ndarray, np.ndarray],
) -> CrawlingState:
    speed, front = edges.edge(float(forces[0][0]))
    _, rear = edges.edge(float(forces[1][0]))
    rates = np.linalg.eigvals(_jacobian(p, laws, anchoring, (front, rear)))
    return CrawlingState(
        speed=speed,
        off_rates=(front.off_rate, rear.off_rate),
        bound_fractions=(front.bound_fraction, rear.bound_fraction),
        tension=0.5 * (front.tension + rear.tension),
        growth_rate=float(rates.real.max()),
    )


def _jacobian(
    p: Parameters, laws: Law, anchoring: Anchoring, edges: tuple[RestState, RestState]
) -> np.ndarray:
    """Slopes of the rates of (n, n, tension[, imbalance]); shifts of the cell are left out."""
    tied = anchoring.stiffness > 0.0
    total = length_stiffness(p) + 0.5 * anchoring.stiffness
    matrix = np.zeros((4, 4))
    for edge, (side, at) in enumerate(zip((1.0, -1.0), edges, strict=True)):
        values = {**local_values(p, laws), "phi": at.bond_force, "r": at.off_rate}
        values |= {"n": at.bound_fraction, "sigma": at.tension, "kappa": 0.0}

        def slope(what: str, values: dict[str, float] = values) -> float:
            return float(laws.compiled.evaluate(what, values))

        phi_n = -slope("balance/n") / slope("balance/phi")
        phi_sigma = -slope("balance/sigma") / slope("balance/phi")
        outwards = slope("velocity/phi") * phi_sigma + slope("velocity/sigma")
        pulled = np.array([1.0, side])
        matrix[edge, edge] = slope("binding/n") + slope("binding/phi") * phi_n
        matrix[edge, 2:] = slope("binding/phi") * phi_sigma * pulled
        springs = np.array([total, 0.5 * anchoring.stiffness * side])
        matrix[2:, edge] = springs * slope("velocity/phi") * phi_n
        matrix[2:, 2:] += np.outer(springs, outwards * pulled)
    matrix[3, 3] -= anchoring.relaxation
    return matrix if tied else matrix[:3, :3]
