"""The cell edge as a closed curve with equally spaced nodes, held by tangent angle and length.

Counter-clockwise; tangent ``(cos theta, sin theta)``, outward normal ``(sin theta, -cos theta)``,
curvature ``kappa = d theta / ds`` (positive on a circle). Derivatives and integrals are spectral:
exact to rounding on a smooth resolved curve.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.numerics import fourier
from cellcrawl.validation import real_array, real_number, whole_number

FEWEST_NODES = 16
MOST_NODES = 1_000_000
_CLOSED = 1e-13  # closure error that rounding leaves


@dataclass(frozen=True, eq=False)
class Curve:
    """A closed curve with equally spaced nodes; immutable.

    Parameters
    ----------
    theta : array, shape (nodes,)
        Tangent angle at the nodes, continuous; it gains ``2 pi`` once round the curve.
    length : float
        Total length, above 0.
    origin : array, shape (2,), optional
        Position of node 0; (0, 0) unless given.

    Raises
    ------
    InputError
        For wrong shapes, values that are not finite, or a length that is not positive.
    """

    theta: np.ndarray
    length: float
    origin: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros(2))

    def __post_init__(self) -> None:
        theta = real_array("Curve theta", self.theta, (None,))
        whole_number("Curve nodes", theta.size, FEWEST_NODES)
        origin = real_array("Curve origin", self.origin, (2,))
        length = real_number("Curve length", self.length, 0.0, math.inf, open_low=True)
        for array in (theta, origin):
            array.setflags(write=False)
        object.__setattr__(self, "theta", theta)
        object.__setattr__(self, "origin", origin)
        object.__setattr__(self, "length", length)

    @property
    def nodes(self) -> int:
        """Number of nodes."""
        return self.theta.size

    @property
    def spacing(self) -> float:
        """Arclength between neighbouring nodes."""
        return self.length / self.nodes

    @cached_property
    def arclength(self) -> np.ndarray:
        """Arclength of each node from node 0, shape (nodes,)."""
        return self.spacing * np.arange(self.nodes)

    @cached_property
    def curvature(self) -> np.ndarray:
        """``kappa = d theta / ds`` at the nodes, shape (nodes,)."""
        winding = 2.0 * math.pi * np.arange(self.nodes) / self.nodes
        slope = fourier.derivative(self.theta - winding, 2.0 * math.pi)
        kappa: np.ndarray = (1.0 + slope) * (2.0 * math.pi / self.length)
        return kappa

    @cached_property
    def points(self) -> np.ndarray:
        """Positions of the nodes, shape (nodes, 2); a closure error is spread evenly."""
        positions: np.ndarray = self._arms + self.origin
        return positions

    @cached_property
    def _arms(self) -> np.ndarray:
        """Positions relative to node 0, as exact far from (0, 0) as near it."""
        tangent = np.exp(1j * self.theta)
        path = fourier.integral(tangent - tangent.mean(), self.length)
        return np.column_stack([path.real, path.imag])

    @cached_property
    def normals(self) -> np.ndarray:
        """Outward unit normals at the nodes, shape (nodes, 2)."""
        return np.column_stack([np.sin(self.theta), -np.cos(self.theta)])

    @cached_property
    def area(self) -> float:
        """Enclosed area, positive for a counter-clockwise curve."""
        return float(0.5 * self.spacing * np.sum(self._arms * self.normals))

    @cached_property
    def centroid(self) -> np.ndarray:
        """Centroid of the enclosed area, shape (2,)."""
        moments: np.ndarray = self.spacing * np.sum(self._arms**2 * self.normals, axis=0)
        center: np.ndarray = moments / (2.0 * self.area) + self.origin
        return center

    @property
    def circularity(self) -> float:
        """``4 pi A / L**2``: 1 for a circle, less for anything else."""
        return 4.0 * math.pi * self.area / self.length**2

    @property
    def closure_error(self) -> float:
        """Distance between the two ends, over the length."""
        return float(abs(np.exp(1j * self.theta).mean()))

    @property
    def turning_number(self) -> int:
        """Turns of the tangent once round: 1 for a simple counter-clockwise curve."""
        steps = np.diff(np.append(self.theta, self.theta[0] + 2.0 * math.pi))
        return round(float(np.sum(np.angle(np.exp(1j * steps)))) / (2.0 * math.pi))

    def closed(self) -> Curve:
        """Return the curve projected to close: the least change of theta (in the mean square).

        Raises
        ------
        InputError
            For a curve too far from closing, such as a straight line.
        """
        theta = self.theta.copy()
        for _ in range(20):
            cosine, sine = np.cos(theta), np.sin(theta)
            gap = np.array([cosine.mean(), sine.mean()])
            if np.hypot(*gap) < 1e-16:
                break
            cross = np.mean(sine * cosine)
            slope = np.array([[-np.mean(sine * sine), -cross], [cross, np.mean(cosine * cosine)]])
            if abs(np.linalg.det(slope)) < 1e-12:
                break  # a straight line
            a, b = np.linalg.solve(slope, -gap)
            theta += a * sine + b * cosine
        result = dataclasses.replace(self, theta=theta)
        if result.closure_error > _CLOSED:
            raise InputError(
                f"the curve does not close: its ends are {self.closure_error:.3g} of its length "
                "apart and no small change of its tangent brings them together"
            )
        return result

    def moved(self, shift: Any) -> Curve:
        """Return the curve translated by ``shift``, shape (2,)."""
        return dataclasses.replace(self, origin=self.origin + real_array("shift", shift, (2,)))

    @checked
    def resampled(self, nodes: int) -> Curve:
        """Return the same curve on another number of equally spaced nodes, node 0 in place."""
        whole_number("Curve nodes", nodes, FEWEST_NODES, MOST_NODES)
        winding = 2.0 * math.pi * np.arange(self.nodes) / self.nodes
        wobble = fourier.resample(self.theta - winding, nodes)
        theta = wobble + 2.0 * math.pi * np.arange(nodes) / nodes
        return Curve(theta, self.length, self.origin).closed()
