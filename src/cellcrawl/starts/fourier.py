"""Starts near the resting circle, given by Fourier modes of the polar radius and bound fraction."""

from __future__ import annotations

import dataclasses
import functools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.curve import Curve, from_path
from cellcrawl.curve.construct import polar_path
from cellcrawl.curve.equal_arclength import FEWEST_NODES
from cellcrawl.errors import InputError
from cellcrawl.parameters import Parameters
from cellcrawl.starts.base import CellState
from cellcrawl.starts.small_waves import HIGHEST, STEEPEST, random_start
from cellcrawl.validation import real_number, shown, table, whole_number

_HIGHEST_MODE = 1000
Modes = Mapping[int, tuple[float, float]]


@dataclass(frozen=True)
class PerturbedCircle:
    """The resting circle with chosen modes of shape and bound fraction; immutable.

    ``R(phi) = 1 + sum a_k cos(k phi) + b_k sin(k phi)`` and
    ``n(phi) = n_bar + sum c_k cos(k phi) + d_k sin(k phi)``, with phi the polar angle about the
    origin and the tension of the resting circle. Node 0 is at phi = 0.

    Parameters
    ----------
    radius : mapping of int to (a_k, b_k), optional
        Modes of the radius, k from 0.
    bound_fraction : mapping of int to (c_k, d_k), optional
        Modes of the bound fraction, k from 0.

    Raises
    ------
    InputError
        For a mode that is no whole number, amplitudes that are not finite, and, when the state is
        made, a radius that is not positive or a bound fraction outside [0, 1].
    """

    radius: Modes = dataclasses.field(default_factory=dict)
    bound_fraction: Modes = dataclasses.field(default_factory=dict)

    def __post_init__(self) -> None:
        for name in ("radius", "bound_fraction"):
            object.__setattr__(self, name, _checked_modes(name, getattr(self, name)))

    @checked
    def state(self, parameters: Parameters, nodes: int) -> CellState:
        """Return the first state on ``nodes`` nodes."""
        need_nodes(nodes, max([0, *self.radius, *self.bound_fraction]))
        return perturbed_circle(parameters, nodes, self.radius, self.bound_fraction)

    def describe(self) -> dict[str, Any]:
        """Return this start as plain values for JSON."""
        return {
            "kind": "PerturbedCircle",
            "radius": {str(k): list(pair) for k, pair in self.radius.items()},
            "bound_fraction": {str(k): list(pair) for k, pair in self.bound_fraction.items()},
        }


@dataclass(frozen=True)
class RandomPerturbation:
    """The resting circle with independent random modes of shape and bound fraction; immutable.

    The paper's start: the first 100 Fourier modes of each, amplitudes uniform within 1e-4. The
    off-rate follows from the force balance. The same seed gives the same bits.

    Parameters
    ----------
    seed : int
        Seed of the random numbers, 0 or more.
    amplitude : float
        Largest amplitude of a mode, 0 to 0.1.
    modes : int
        Number of modes from k = 1, 1 to 1000.
    """

    seed: int = 1
    amplitude: float = 1e-4
    modes: int = 100

    def __post_init__(self) -> None:
        object.__setattr__(self, "seed", whole_number("seed", self.seed, 0, 2**63 - 1))
        object.__setattr__(self, "amplitude", real_number("amplitude", self.amplitude, 0.0, 0.1))
        object.__setattr__(self, "modes", whole_number("modes", self.modes, 1, _HIGHEST_MODE))

    @checked
    def state(self, parameters: Parameters, nodes: int) -> CellState:
        """Return the first state on ``nodes`` nodes."""
        shape, waves = _random_shape(self.seed, self.amplitude, self.modes, nodes)
        return CellState(shape, parameters.n_bar + waves, parameters.sigma_bar)

    def describe(self) -> dict[str, Any]:
        """Return this start as plain values for JSON."""
        return {"kind": "RandomPerturbation", **dataclasses.asdict(self)}


@functools.lru_cache(maxsize=32)
def _random_shape(seed: int, amplitude: float, modes: int, nodes: int) -> tuple[Curve, np.ndarray]:
    """Return edge and waves of the bound fraction, the same at all parameters.

    Kept, for a sweep asks for the same few many times.
    """
    waves = amplitude * np.random.default_rng(seed).uniform(-1.0, 1.0, (modes, 4))
    small = 0.5 * amplitude * modes * (modes + 1) <= STEEPEST and modes <= HIGHEST
    if small and nodes > 2 * modes and nodes >= FEWEST_NODES:
        theta, bound_waves = np.empty(nodes), np.empty(nodes)
        length, area = random_start(waves, 0.0, theta, bound_waves)
        origin = np.array([1.0 + float(np.add.accumulate(waves[::-1, 0])[-1]), 0.0])
        curve = Curve(theta, length, origin)
        curve.__dict__["area"] = area  # known exactly
        return curve, bound_waves
    amplitudes = waves.tolist()
    radius = {k: (a, b) for k, (a, b, _, _) in enumerate(amplitudes, start=1)}
    bound = {k: (c, d) for k, (_, _, c, d) in enumerate(amplitudes, start=1)}
    return _shape(nodes, radius, bound)


def perturbed_circle(
    parameters: Parameters,
    nodes: int,
    radius: Modes,
    bound_fraction: Modes,
    tension_change: float = 0.0,
) -> CellState:
    """Return the state of a circle with the given modes and the resting tension plus a change."""
    curve, waves = _shape(nodes, radius, bound_fraction)
    return CellState(curve, parameters.n_bar + waves, parameters.sigma_bar + tension_change)


def _shape(nodes: int, radius: Modes, bound_fraction: Modes) -> tuple[Curve, np.ndarray]:
    """Return the edge, and the waves of the bound fraction at its nodes."""
    highest = max([0, *radius, *bound_fraction])
    samples = 1 << max(12, math.ceil(math.log2(16 * highest + 1)))
    curve, angle = from_path(polar_path(lambda phi: 1.0 + _sum(radius, phi), samples), nodes)
    return curve, _sum(bound_fraction, angle)


def need_nodes(nodes: int, highest: int) -> None:
    """Raise `InputError` if a mode has fewer than two nodes a wave."""
    if nodes <= 2 * highest:
        raise InputError(
            f"nodes = {nodes} cannot show mode k = {highest}: it needs more than {2 * highest}"
        )


def _sum(modes: Modes, angle: np.ndarray) -> np.ndarray:
    """Sum of ``a_k cos(k angle) + b_k sin(k angle)``, by Horner's rule where most k are there."""
    if 2 * len(modes) > max(modes, default=0):
        turn = np.exp(1j * angle)
        total = np.zeros_like(turn)
        for k in range(max(modes, default=0), -1, -1):
            cosine, sine = modes.get(k, (0.0, 0.0))
            total *= turn
            total += complex(cosine, -sine)
        return np.asarray(total.real)
    waves = np.zeros_like(angle)
    for k, (cosine, sine) in modes.items():
        waves += cosine * np.cos(k * angle) + sine * np.sin(k * angle)
    return waves


def _checked_modes(name: str, modes: Any) -> dict[int, tuple[float, float]]:
    checked: dict[int, tuple[float, float]] = {}
    for given, pair in table(name, modes).items():
        k = int(given) if isinstance(given, str) and given.isdecimal() and len(given) < 9 else given
        k = whole_number(f"{name} mode", k, 0, _HIGHEST_MODE)  # TOML and JSON have them as text
        if k in checked:
            raise InputError(f"{name}[{k}] is given twice")
        if not isinstance(pair, (list, tuple, np.ndarray)) or len(pair) != 2:
            raise InputError(f"{name}[{k}] must be a pair of numbers, not {shown(pair)}")
        checked[k] = (
            real_number(f"{name}[{k}] cosine", pair[0], -10.0, 10.0),
            real_number(f"{name}[{k}] sine", pair[1], -10.0, 10.0),
        )
    return checked
