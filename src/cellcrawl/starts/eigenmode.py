"""Eigenmodes of the linear theory as starts."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Any

from cellcrawl.errors import InputError
from cellcrawl.linear import base_state, growth_rates
from cellcrawl.parameters import Parameters
from cellcrawl.starts.base import CellState
from cellcrawl.starts.fourier import need_nodes, perturbed_circle
from cellcrawl.validation import one_of, real_number, whole_number

BRANCHES = ("+", "-")
CARRIERS = ("radius", "bound_fraction")


@dataclass(frozen=True)
class Eigenmode:
    """The resting circle with one eigenmode of its linear theory; immutable.

    With growth rate ``lam`` the mode changes radius, bound fraction and off-rate as
    ``lam R = -epsilon c r`` and ``(lam + q) n = -n_bar r``; a complex one travels round the edge.

    Parameters
    ----------
    k : int
        Wavenumber; 0 is the breathing mode, which changes the tension too.
    amplitude : float
        Amplitude of the field named by ``carrier``.
    branch : {"+", "-"}
        Which root: the larger real part (of a complex pair, the positive imaginary part), or the
        other.
    carrier : {"radius", "bound_fraction"}
        The field that has the amplitude. A growing mode k = 1 has a bound fraction and off-rate far
        larger than its radius (off-rate over radius is about -2600 at r_on = 25, zeta_1 = 600), so
        small amplitudes of the radius are large ones of the rest. A mode with growth rate 0 (k = 1,
        the other branch) is a shift of the circle and has no bound fraction; without adhesive
        friction one branch has no radius.
    """

    k: int
    amplitude: float = 1e-4
    branch: str = "+"
    carrier: str = "radius"

    def __post_init__(self) -> None:
        object.__setattr__(self, "k", whole_number("k", self.k, 0, 1000))
        object.__setattr__(self, "amplitude", real_number("amplitude", self.amplitude, -0.5, 0.5))
        object.__setattr__(self, "branch", one_of("branch", self.branch, BRANCHES))
        object.__setattr__(self, "carrier", one_of("carrier", self.carrier, CARRIERS))

    def growth_rate(self, parameters: Parameters) -> complex:
        """Return the growth rate of this mode."""
        return complex(growth_rates(parameters, self.k)[BRANCHES.index(self.branch)])

    def state(self, parameters: Parameters, nodes: int) -> CellState:
        """Return the first state on ``nodes`` nodes, node 0 at the crest of the carrier.

        Raises
        ------
        InputError
            If the mode has nothing of the carrier, or the nodes are too few for its waves.
        """
        p, base = parameters, base_state(parameters)
        need_nodes(nodes, self.k)
        rate = self.growth_rate(p)
        q = p.r_on + p.r_p + p.D * self.k**2
        shape = {"radius": p.epsilon * base.c * (rate + q), "bound_fraction": p.n_bar * rate}
        if abs(rate if self.carrier == "bound_fraction" else rate + q) < 1e-12 * q:
            other = next(name for name in CARRIERS if name != self.carrier)
            raise InputError(
                f"mode k = {self.k}, branch {self.branch!r}, has no {self.carrier} at these "
                f"parameters: give carrier={other!r}"
            )
        scale = self.amplitude / shape[self.carrier]
        radius, bound = shape["radius"] * scale, shape["bound_fraction"] * scale
        tension = 2.0 * math.pi * p.tension_rate * radius.real if self.k == 0 else 0.0
        return perturbed_circle(
            p,
            nodes,
            {self.k: (radius.real, -radius.imag)},
            {self.k: (bound.real, -bound.imag)},
            tension,
        )

    def describe(self) -> dict[str, Any]:
        """Return this start as plain values for JSON."""
        return {"kind": "Eigenmode", **dataclasses.asdict(self)}
