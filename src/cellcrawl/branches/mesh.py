"""Fourier nodes along the edge that crowd where a cell has corners.

The angle ``alpha = 2 pi s / L`` of a place on the edge is a smooth function of an even grid
``q = 2 pi j / nodes``, by the integral of a density made of Poisson kernels. Derivatives and
integrals stay exact for waves that the grid resolves. The number of nodes is odd: an even one has a
sawtooth whose derivative vanishes on the grid, a mode of the code and not of the cell.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from cellcrawl.numerics import fourier

_NEWTON_STEPS = 60
_ROUNDING = 1e-14  # an angle's, up to 2 pi: the step after is the last that does something


class Operators(NamedTuple):
    """What differentiates and integrates perturbations of one parity on the nodes.

    "Curvature-like" is the parity of curvature, speed and force; "angle-like" that of the tangent
    angle and of tangential motion. Without a symmetry all are the same. Shapes (kept, kept).
    """

    angle_slope: np.ndarray
    """Derivative in ``alpha``: angle-like to curvature-like."""
    speed_slope: np.ndarray
    """Curvature-like to angle-like."""
    bound_slope: np.ndarray
    bound_bend: np.ndarray
    """First and second derivative of the bound fraction."""
    slide: np.ndarray
    """Tangential velocity over the length that keeps arclengths equal, of ``kappa U``."""
    mean: np.ndarray
    """Weights of the mean over arclength of what is curvature-like, shape (kept,)."""


@dataclass(frozen=True)
class Mesh:
    """An odd number of nodes, and where they crowd.

    Parameters
    ----------
    nodes : int
        Odd.
    places : tuple of float
        Angles ``alpha`` at which nodes crowd; symmetric about 0 for a cell with a mirror axis.
    sharpness : float
        Of the crowds, from 0 (even nodes) to below 1.
    share : float
        Part of the nodes that are in crowds, 0 to below 1.
    """

    nodes: int
    places: tuple[float, ...] = ()
    sharpness: float = 0.0
    share: float = 0.0

    @property
    def kept(self) -> int:
        """Nodes of one half of a symmetric cell, both ends included."""
        return self.nodes // 2 + 1

    @cached_property
    def grid(self) -> np.ndarray:
        """Values of ``q``, shape (nodes,)."""
        return np.asarray(2.0 * math.pi * np.arange(self.nodes) / self.nodes)

    def at(self, alpha: np.ndarray) -> np.ndarray:
        """Return ``q`` at angles along the edge."""
        q = np.array(alpha, dtype=float)
        if not self.places:
            return q
        weight = 2.0 * self.share / len(self.places)
        for place in self.places:
            q += weight * (self._lead(alpha - place) - self._lead(np.asarray(-place)))
        return q

    def density(self, alpha: np.ndarray) -> np.ndarray:
        """Return the density ``dq / d alpha`` of nodes, of mean 1."""
        if not self.places:
            return np.ones_like(alpha)
        rho = self.sharpness
        crowded = np.zeros_like(alpha)
        for place in self.places:
            crowded += (1.0 - rho * rho) / (1.0 + rho * rho - 2.0 * rho * np.cos(alpha - place))
        return np.asarray(1.0 - self.share + self.share / len(self.places) * crowded)

    def _lead(self, x: np.ndarray) -> np.ndarray:
        rho = self.sharpness
        return np.asarray(np.arctan2(rho * np.sin(x), 1.0 - rho * np.cos(x)))

    @cached_property
    def alpha(self) -> np.ndarray:
        """Angles along the edge at the nodes, from 0, shape (nodes,)."""
        guess = np.linspace(0.0, 2.0 * math.pi, 40 * self.nodes + 1)
        alpha = np.asarray(np.interp(self.grid, self.at(guess), guess), dtype=float)
        for _ in range(_NEWTON_STEPS):
            step = (self.at(alpha) - self.grid) / self.density(alpha)
            alpha = alpha - step
            if np.max(np.abs(step)) < _ROUNDING:
                break
        return alpha

    @cached_property
    def stretch(self) -> np.ndarray:
        """``d alpha / dq`` at the nodes, of mean 1, shape (nodes,)."""
        return 1.0 / self.density(self.alpha)

    @cached_property
    def _slope(self) -> np.ndarray:
        """Derivative in ``q``: exact for an odd number of nodes."""
        step = np.arange(self.nodes)
        apart = step[:, None] - step[None, :]
        with np.errstate(divide="ignore"):
            made = 0.5 * np.where(apart % 2 == 0, 1.0, -1.0) / np.sin(apart * math.pi / self.nodes)
        np.fill_diagonal(made, 0.0)
        return made

    @cached_property
    def antiderivative(self) -> np.ndarray:
        """Integral in ``q`` without its mean; a constant becomes 0."""
        k = fourier.wavenumbers(self.nodes)
        k[0] = np.inf
        column = np.fft.ifft(-1j / k).real
        return np.asarray(column[(np.arange(self.nodes)[:, None] - np.arange(self.nodes))])

    @cached_property
    def whole(self) -> Operators:
        """Operators on the whole edge."""
        slope = self._slope / self.stretch[:, None]
        g = self.stretch / self.nodes
        centred = self.antiderivative - (g @ self.antiderivative)[None, :]
        slide = (np.outer(centred @ self.stretch, g) - centred * self.stretch) / (2.0 * math.pi)
        return Operators(slope, slope, slope, slope @ slope, slide, g)

    @cached_property
    def symmetric(self) -> Operators:
        """Operators on half an edge for what keeps the mirror axis through node 0."""
        slope, slide = self.whole.angle_slope, self.whole.slide
        from_odd, from_even = self._folded(slope, -1.0), self._folded(slope, 1.0)
        mean = self._folded(self.whole.mean[None, :], 1.0)[0]
        return Operators(
            from_odd, from_even, from_even, from_odd @ from_even, self._folded(slide, 1.0), mean
        )

    @cached_property
    def antisymmetric(self) -> Operators:
        """Operators on half an edge for what breaks the mirror axis."""
        slope, slide = self.whole.angle_slope, self.whole.slide
        from_odd, from_even = self._folded(slope, -1.0), self._folded(slope, 1.0)
        nothing = np.zeros(self.kept)
        return Operators(
            from_even, from_odd, from_odd, from_even @ from_odd, self._folded(slide, -1.0), nothing
        )

    def _folded(self, matrix: np.ndarray, parity: float) -> np.ndarray:
        """Return a matrix that acts on the first half of what is even (1) or odd (-1)."""
        kept = self.kept
        made = np.array(matrix[:kept, :kept])
        made[:, 1:] += parity * matrix[:kept, : kept - 1 : -1]
        if parity < 0.0:
            made[:, 0] = 0.0
        return made

    def unfolded(self, half: np.ndarray, parity: float) -> np.ndarray:
        """Return what half an edge says of the whole edge, shape (nodes,)."""
        return np.concatenate([half, parity * half[:0:-1]])

    def values(self, samples: np.ndarray, alpha: np.ndarray) -> np.ndarray:
        """Return what is known at the nodes at other angles along the edge."""
        apart = self.at(alpha)[:, None] - self.grid[None, :]
        apart = (apart + math.pi) % (2.0 * math.pi) - math.pi
        half = 0.5 * apart
        small = np.abs(half) < 1e-9
        kernel = np.where(
            small, 1.0, np.sin(self.nodes * half) / (self.nodes * np.sin(half + small))
        )
        return np.asarray(kernel @ samples)

    def tail(self, *fields: np.ndarray) -> float:
        """Return the largest share of the shortest waves in some fields."""
        worst = 0.0
        for field in fields:
            waves = np.abs(np.fft.rfft(field))
            last = waves[-max(4, waves.size // 12) :]
            worst = max(worst, float(last.max() / max(waves[1:].max(), 1e-8 * self.nodes)))
        return worst


def even_samples(samples: Sequence[float] | np.ndarray, alpha: np.ndarray) -> np.ndarray:
    """Return samples at equal arclengths (any number) at other angles along the edge."""
    values = np.asarray(samples, dtype=float)
    waves = np.fft.rfft(values) / values.size
    k = np.arange(waves.size)
    doubled = np.where((k == 0) | (2 * k == values.size), 1.0, 2.0)
    return np.asarray((np.exp(1j * np.outer(alpha, k)) @ (doubled * waves)).real)
