"""Theory of the flat edge: uniform states, growth rates and waves, and the speed of fronts."""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.laws import as_law, functions
from cellcrawl.laws.force_balance import bond_force
from cellcrawl.laws.law import PAPER, Law
from cellcrawl.laws.rest import RestState, local_values, rest_state, zero_in
from cellcrawl.linear.any_law import edge_matrix, matrix_rates
from cellcrawl.linear.characteristic import checked_wavenumbers
from cellcrawl.numerics.bracketing import all_roots
from cellcrawl.numerics.kernels import kernel
from cellcrawl.one_dimensional.cell import checked_cell, edge_of
from cellcrawl.parameters import Parameters
from cellcrawl.validation import one_of, real_number

TENSION_LAWS: Final = ("fixed", "elastic")
LONGEST: Final = 1e4
_HIGHEST = 1e9
_STRONGEST = 700.0  # force on a bond at which an exponential ends
_STEPS = 4000


@checked
def uniform_states(parameters: Parameters, tension: float, laws: Any = PAPER) -> np.ndarray:
    """Return the off-rates at which a uniform flat edge can be at a tension.

    One, or three: the stuck state, an unstable one between, and the slipping state; in the order of
    the force on a bond.

    Parameters
    ----------
    parameters : Parameters
        The cell.
    tension : float
        Membrane tension; with contraction it must pull, ``sigma_c + tension >= 0``.
    laws : Law or str
        The law set; the paper's unless given.

    Raises
    ------
    InputError
        For a tension at which no force on the bonds balances the pull, as one below 0.
    """
    checked_cell(parameters)
    states = uniform_edges(parameters, real_number("tension", tension, -_HIGHEST, _HIGHEST), laws)
    return np.array([state.off_rate for state in states])


def uniform_edges(parameters: Parameters, tension: float, laws: Any = PAPER) -> list[RestState]:
    """Return the uniform flat edges at a tension, which need not rest; at least one."""
    law = as_law(laws)
    local = {**local_values(parameters, law), "sigma": tension, "kappa": 0.0}

    def at(phi: Any) -> dict[str, Any]:
        values = {**local, "phi": np.asarray(phi), "n": 0.0}
        values["r"] = law.compiled.evaluate("off_rate", values)
        values["n"] = zero_in(law, "binding", values, "n", 0.5)
        return values

    def excess(phi: np.ndarray) -> np.ndarray:
        found: np.ndarray = law.compiled.evaluate("balance", at(phi))
        return found

    def unbound(phi: float) -> float:
        """Excess of an edge without linkers: above the roots of any bound fraction."""
        return float(law.compiled.evaluate("balance", {**at(phi), "n": 0.0}))

    slack = float(excess(np.zeros(())))
    if slack > 0.0:
        least = f" is below -sigma_c = {-parameters.sigma_c:g}" if law == PAPER else ""
        raise InputError(
            f"tension = {tension:g}{least}: no force on the bonds balances the pull on a "
            "flat edge; give a higher tension"
        )
    high = 1.0
    with np.errstate(over="ignore", invalid="ignore"):
        while not (unbound(high) > 0.0 and excess(np.asarray(high)) > 0.0):
            high *= 1.5
            if not high < _STRONGEST:
                raise InputError(
                    f"under {law!r} no force on the bonds balances the pull on a flat edge at "
                    f"tension = {tension:g}"
                )
    forces = all_roots(excess, 1e-9 * high, high, 4001) if slack < 0.0 else np.zeros(1)
    states = [at(phi) for phi in forces]
    return [RestState(*(float(s[name]) for name in ("phi", "r", "n", "sigma"))) for s in states]


@checked
def flat_growth_rates(
    parameters: Parameters,
    k: Any,
    *,
    off_rate: float | None = None,
    tension_law: str = "fixed",
    length: float = 2.0 * math.pi,
    anchoring: float = 0.0,
    laws: Any = PAPER,
) -> np.ndarray:
    """Growth rates of waves of wavenumber ``k`` on a uniform flat edge.

    Parameters
    ----------
    parameters : Parameters
        The cell.
    k : float or array
        Wavenumbers; a wave of complex rate travels at ``Im(rate) / k`` along the edge.
    off_rate : float, optional
        That of the uniform edge, at least 1, under the paper's laws; that of the edge that stands
        still unless given, ``r_p`` under those laws.
    tension_law : {"fixed", "elastic"}
        Whether the tension is held or follows the area swept, which only ``k = 0`` feels.
    length : float
        Length of the edge, which matters to the elastic tension only.
    anchoring : float
        Stiffness of springs to a body that never moves.
    laws : Law or str
        The law set; the paper's unless given.

    Returns
    -------
    array, complex, shape (..., 2)
        The larger root first; of a complex pair the one with the positive imaginary part. At a
        fixed tension without springs ``k = 0`` has the roots ``b/a - q`` and 0.

    Raises
    ------
    InputError
        For values out of range.
    """
    checked_cell(parameters)
    wavenumbers = checked_wavenumbers(k)
    one_of("tension_law", tension_law, TENSION_LAWS)
    law, p = as_law(laws), parameters
    length = real_number("length", length, 0.0, LONGEST, open_low=True)
    springs = real_number("anchoring", anchoring, 0.0, _HIGHEST)
    if off_rate is None:
        state = rest_state(p, law, 0.0)
    elif law == PAPER:
        r = real_number("off_rate", off_rate, 1.0, 1e6)
        n = p.r_on / (p.r_on + r)
        state = RestState(math.log(r), r, n, math.log(r) * (r + p.zeta_1 * n) - p.sigma_c)
    else:
        raise InputError("off_rate tells the edge under the paper's laws alone: leave it out")
    edge = FlatWaves(p, law, state, length if tension_law == "elastic" else 0.0, springs)
    return edge.rates(wavenumbers)


class FlatWaves(NamedTuple):
    """Small waves on a uniform flat edge."""

    parameters: Parameters
    laws: Law
    state: RestState
    length: float
    """That over which the edge stretches the tension; 0 holds it."""
    springs: float

    def rates(self, k: np.ndarray) -> np.ndarray:
        """Growth rates, complex, shape (..., 2), the larger first."""
        return matrix_rates(self._matrix(k))

    def height(self, k: float, rate: complex) -> complex:
        """Height of a wave of a growth rate whose bound fraction has amplitude 1."""
        (own, by_bound), _ = self._matrix(np.asarray(k))
        return complex(by_bound / (rate - own)) if rate != own else 0.0

    def _matrix(self, k: np.ndarray) -> np.ndarray:
        p = self.parameters
        stretching = np.where(np.equal(k, 0.0), p.tension_rate * self.length, 0.0)
        return edge_matrix(p, k, self.laws, self.state, 0.0, stretching, self.springs)


@checked
def front_speed(parameters: Parameters, tension: float, laws: Any = PAPER) -> float:
    """Speed at which the stuck state invades the slipping one along a flat edge without curvature.

    Below 0 where the slipping state invades. Found by shooting in the plane of bound fraction and
    its slope; ``h`` is taken as 0.

    Parameters
    ----------
    parameters : Parameters
        The cell.
    tension : float
        A tension at which both states exist.
    laws : Law or str
        The law set; the paper's unless given.

    Raises
    ------
    InputError
        Where the edge has only one uniform state.
    """
    checked_cell(parameters)
    law, tension = as_law(laws), real_number("tension", tension, -_HIGHEST, _HIGHEST)
    states = uniform_edges(parameters, tension, law)
    if len(states) != 3:
        raise InputError(
            f"at tension = {tension:g} a flat edge has one uniform state, not a stuck and a "
            "slipping one: no front joins them; give another tension"
        )
    p = parameters
    stuck, _, slipping = (state.bound_fraction for state in states)
    grid = np.linspace(slipping, stuck, 2 * _STEPS + 1)
    source = np.empty(grid.size)
    edge = edge_of(p.replace(h=0.0), law, 1)
    _sources(law.compiled, edge, grid, tension, source)
    source[[0, -1]] = 0.0
    slope = (source[1] - source[0]) / (grid[1] - grid[0])
    high = 2.0 * math.sqrt(p.D * float(np.abs(np.gradient(source, grid)).max()))
    low = -high
    for _ in range(60):
        middle = 0.5 * (low + high)
        if _reaches(source, grid[1] - grid[0], p.D, middle, slope):
            high = middle
        else:
            low = middle
    return 0.5 * (low + high)


@kernel
def _sources(laws: Any, edge: np.ndarray, n: np.ndarray, tension: float, out: np.ndarray) -> None:
    phi = np.nan
    for i in range(n.size):
        phi = bond_force(laws, phi, n[i], tension, 0.0, edge, 0)
        r = functions.off_rate(laws, phi, edge, 0)
        out[i] = functions.binding(laws, phi, r, n[i], edge, 0)


@kernel
def _reaches(source: np.ndarray, half: float, D: float, c: float, slope: float) -> bool:
    """Whether the path from the slipping state at speed ``c`` keeps a slope up to the stuck one.

    ``p = -n_s`` over n obeys ``D p p_n = c p - g``; the nodes of ``source`` are half steps.
    """
    step = 2.0 * half
    p = step * 0.5 * (c + np.sqrt(c * c - 4.0 * D * slope)) / D
    for i in range(2, source.size - 2, 2):
        k1 = (c - source[i] / p) / D
        p2 = p + half * k1
        if p2 <= 0.0:
            return False
        k2 = (c - source[i + 1] / p2) / D
        p3 = p + half * k2
        if p3 <= 0.0:
            return False
        k3 = (c - source[i + 1] / p3) / D
        p4 = p + step * k3
        if p4 <= 0.0:
            return False
        k4 = (c - source[i + 2] / p4) / D
        p += step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        if p <= 0.0:
            return False
    return True
