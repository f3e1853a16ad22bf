"""How a flat edge begins. A start gives bound fraction and height at the nodes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.laws.law import PAPER, Law
from cellcrawl.laws.rest import RestState
from cellcrawl.one_dimensional.flat_theory import FlatWaves, uniform_edges
from cellcrawl.parameters import Parameters
from cellcrawl.validation import real_array, real_number, whole_number

_MOST_WAVES = 1000
Fields = tuple[np.ndarray, np.ndarray]
"""Bound fraction and height, each of shape (nodes,)."""


class FlatSetting(NamedTuple):
    """The edge a start is made for."""

    parameters: Parameters
    tension: float
    s: np.ndarray
    length: float
    tension_law: str
    anchoring: float
    laws: Law = PAPER

    @property
    def edges(self) -> list[RestState]:
        """The uniform edges at this tension."""
        return uniform_edges(self.parameters, self.tension, self.laws)

    @property
    def uniform(self) -> RestState:
        """The only uniform edge, or of three the unstable one between."""
        return self.edges[len(self.edges) // 2]

    @property
    def off_rate(self) -> float:
        """That of the uniform edge."""
        return self.uniform.off_rate

    @property
    def bound_fraction(self) -> float:
        """That of the uniform edge."""
        return self.uniform.bound_fraction


class FlatStart(Protocol):
    """What a start is."""

    def fields(self, setting: FlatSetting) -> Fields:
        """Return bound fraction and height at the nodes."""
        ...


@dataclass(frozen=True, kw_only=True)
class FlatNoise:
    """Random waves in the bound fraction of a uniform edge; immutable.

    Parameters
    ----------
    seed : int
        The same seed gives the same start, whatever the nodes.
    amplitude : float
        Largest amplitude of a wave, 0 to 0.5.
    waves : int
        How many wavenumbers, from one wave along the edge on.
    """

    seed: int = 1
    amplitude: float = 0.02
    waves: int = 12

    def __post_init__(self) -> None:
        whole_number("seed", self.seed, 0)
        real_number("amplitude", self.amplitude, 0.0, 0.5)
        whole_number("waves", self.waves, 1, _MOST_WAVES)

    @checked
    def fields(self, setting: FlatSetting) -> Fields:
        rng = np.random.default_rng(self.seed)
        n = np.full(setting.s.size, setting.bound_fraction)
        for wave in range(1, self.waves + 1):
            phase = 2.0 * math.pi * wave / setting.length * setting.s
            a, b = rng.uniform(-self.amplitude, self.amplitude, 2)
            n += a * np.cos(phase) + b * np.sin(phase)
        return np.clip(n, 0.0, 1.0), np.zeros(setting.s.size)


@dataclass(frozen=True, kw_only=True)
class FlatWave:
    """A wave of linear theory on a uniform edge, on its faster growing root; immutable.

    Parameters
    ----------
    waves : int
        How many fit along the edge.
    amplitude : float
        Of the bound fraction, 0 to 0.5.
    direction : {1, -1}
        Along which way of the edge it travels, where its rate is complex.
    """

    waves: int = 1
    amplitude: float = 1e-3
    direction: int = 1

    def __post_init__(self) -> None:
        whole_number("waves", self.waves, 1, _MOST_WAVES)
        real_number("amplitude", self.amplitude, 0.0, 0.5)
        if whole_number("direction", self.direction, -1, 1) == 0:
            raise InputError("direction = 0 is out of range: it must be 1 or -1")

    @checked
    def fields(self, setting: FlatSetting) -> Fields:
        k = 2.0 * math.pi * self.waves / setting.length
        length = setting.length if setting.tension_law == "elastic" else 0.0
        uniform = setting.uniform
        waves = FlatWaves(setting.parameters, setting.laws, uniform, length, setting.anchoring)
        rate = complex(waves.rates(np.asarray(k))[0])
        wave = self.amplitude * np.exp(-1j * self.direction * k * setting.s)
        n = uniform.bound_fraction + wave.real
        return np.clip(n, 0.0, 1.0), (waves.height(k, rate) * wave).real


@dataclass(frozen=True, kw_only=True)
class StuckPatch:
    """A stuck stretch in the middle of a slipping edge, with soft ends; immutable.

    Parameters
    ----------
    part : float
        Of the length that is stuck, above 0, up to 1.
    """

    part: float = 0.5

    def __post_init__(self) -> None:
        real_number("part", self.part, 0.0, 1.0, open_low=True)

    @checked
    def fields(self, setting: FlatSetting) -> Fields:
        states = setting.edges
        if len(states) != 3:
            raise InputError(
                f"at tension = {setting.tension:g} a flat edge has one uniform state: it cannot "
                "be stuck here and slip there; give another tension or start"
            )
        p = setting.parameters
        stuck, _, slipping = (state.bound_fraction for state in states)
        soft = 2.0 * math.sqrt(p.D / (p.r_on + p.r_p))
        away = np.abs(setting.s - 0.5 * setting.length) - 0.5 * self.part * setting.length
        inside = 0.5 * (1.0 - np.tanh(away / soft))
        return slipping + (stuck - slipping) * inside, np.zeros(setting.s.size)


@dataclass(frozen=True, eq=False, kw_only=True)
class FlatFields:
    """Fields of your own at the nodes; immutable.

    Parameters
    ----------
    bound_fraction : array, shape (nodes,)
        0 to 1.
    height : array, shape (nodes,), optional
        How far the edge is out; 0 unless given.
    """

    bound_fraction: Any
    height: Any = None

    @checked
    def fields(self, setting: FlatSetting) -> Fields:
        nodes = setting.s.size
        n = real_array("bound_fraction", self.bound_fraction, (nodes,))
        if n.min() < 0.0 or n.max() > 1.0:
            raise InputError("bound_fraction is out of range: it must be from 0 to 1 everywhere")
        if self.height is None:
            return n, np.zeros(nodes)
        return n, real_array("height", self.height, (nodes,))
