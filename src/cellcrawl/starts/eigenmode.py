"""Eigenmodes of the linear theory as starts."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.linear import growth_rates
from cellcrawl.linear.eigenmodes import Amplitudes, linear_mode, second_order
from cellcrawl.parameters import Parameters
from cellcrawl.starts.base import CellState
from cellcrawl.starts.fourier import need_nodes, perturbed_circle
from cellcrawl.validation import one_of, real_number, whole_number

BRANCHES = ("+", "-")
CARRIERS = ("radius", "bound_fraction")


@dataclass(frozen=True)
class Eigenmode:
    """The resting circle with one eigenmode, exact to second order in the amplitude; immutable.

    With growth rate ``lam`` the mode changes radius, bound fraction and off-rate as
    ``lam R = -epsilon c r`` and ``(lam + q) n = -n_bar r``, in the polar angle; a complex one
    travels round the edge. To it are added the mean and the second harmonic, of second order in the
    amplitude, that grow in step with it at twice its rate. So the state lies on the mode's
    invariant manifold up to terms of third order: the mode alone would differ from the model's
    own growth at second order, and leave free modes behind. The tension is that of the resting
    circle plus ``G`` times the change of area, exactly: a mode k >= 1 changes both at second order
    only, and by little where ``G`` is large.

    Parameters
    ----------
    k : int
        Wavenumber; 0 is the breathing mode, which changes the tension too.
    amplitude : float
        Amplitude of the field named by ``carrier``; for k = 0, its part of first order.
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

    @checked
    def growth_rate(self, parameters: Parameters) -> complex:
        """Return the growth rate of this mode."""
        return complex(growth_rates(parameters, self.k)[BRANCHES.index(self.branch)])

    @checked
    def state(self, parameters: Parameters, nodes: int) -> CellState:
        """Return the first state on ``nodes`` nodes, node 0 at the crest of the carrier.

        The second harmonic is left out where the nodes cannot show it.

        Raises
        ------
        InputError
            If the mode has nothing of the carrier, the nodes are too few for its waves, or the
            amplitude is too large for a cell.
        """
        p = parameters
        need_nodes(nodes, self.k)
        mode = self._mode(p)
        harmonics = second_order(p, self.k, self.growth_rate(p), mode)
        mean = harmonics.pop(0, Amplitudes(0.0, 0.0, 0.0))
        waves = {m: wave for m, wave in harmonics.items() if nodes > 2 * m}
        if self.k > 0:
            waves[self.k] = mode
            mode = Amplitudes(0.0, 0.0, 0.0)
        # the mean radius and the tension from the area, so that the tension law holds exactly
        ripple = 0.5 * sum(abs(wave.radius) ** 2 for wave in waves.values())
        first = abs(waves[self.k].radius) ** 2 / 2.0 if self.k > 0 else mode.radius.real**2
        grown = math.pi * (2.0 * mode.radius.real + 2.0 * mean.radius.real + first)
        square = 1.0 + grown / math.pi - ripple
        if square <= 0.0:
            raise InputError(
                f"amplitude = {self.amplitude:g} is too large for mode k = {self.k}, branch "
                f"{self.branch!r}: the cell would have no area"
            )
        bound = mode.bound_fraction.real + mean.bound_fraction.real
        return perturbed_circle(
            p,
            nodes,
            {0: (math.sqrt(square) - 1.0, 0.0), **_pairs("radius", waves)},
            {0: (bound, 0.0), **_pairs("bound_fraction", waves)},
            p.tension_rate * grown,
        )

    def _mode(self, parameters: Parameters) -> Amplitudes:
        """Return the linear mode in the size asked for."""
        rate = self.growth_rate(parameters)
        mode = linear_mode(parameters, self.k, rate)
        q = parameters.r_on + parameters.r_p + parameters.D * self.k**2
        if abs(rate if self.carrier == "bound_fraction" else rate + q) < 1e-12 * q:
            other = next(name for name in CARRIERS if name != self.carrier)
            raise InputError(
                f"mode k = {self.k}, branch {self.branch!r}, has no {self.carrier} at these "
                f"parameters: give carrier={other!r}"
            )
        scale = self.amplitude / getattr(mode, self.carrier)
        return Amplitudes(*(complex(part * scale) for part in mode))

    def describe(self) -> dict[str, Any]:
        """Return this start as plain values for JSON."""
        return {"kind": "Eigenmode", **dataclasses.asdict(self)}


def _pairs(field: str, waves: Mapping[int, Amplitudes]) -> dict[int, tuple[float, float]]:
    """Return the cosine and sine amplitudes of a field."""
    amplitudes = {m: complex(getattr(wave, field)) for m, wave in waves.items()}
    return {m: (amplitude.real, -amplitude.imag) for m, amplitude in amplitudes.items()}
