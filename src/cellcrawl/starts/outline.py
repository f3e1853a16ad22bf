"""Starts from a given shape, such as an outline from a microscope."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.curve import Curve
from cellcrawl.errors import InputError, OutlineChangedWarning
from cellcrawl.numerics import fourier
from cellcrawl.parameters import Parameters
from cellcrawl.starts.base import CellState
from cellcrawl.starts.holding import held_polygon
from cellcrawl.validation import real_array, real_number

_TIMES = 3.0  # larger or smaller than the resting circle, an outline is in other units
_NODES = 512  # at which an outline is tried when it is given


@dataclass(frozen=True, eq=False)
class FromOutline:
    """Any closed polygon as the edge, with uniform or given bound fraction; immutable.

    An outline from a microscope may touch or cross itself, or have retraction fibres that the model
    cannot hold. It is then opened: what is thinner than a disk that grows until the rest can be
    held is taken off. What was changed is in ``changes``, and a warning tells it.

    Parameters
    ----------
    xy : array, shape (vertices, 2), or Outline
        Vertices in order, either way round, in units of the cell radius (see ``radius``).
    bound_fraction : float or array, shape (vertices,), optional
        Bound fraction at the vertices, 0 to 1; that of the resting circle unless given.
    tension : float, optional
        Membrane tension; that of the resting circle unless given.
    radius : float, optional
        Rescale the outline about its centroid to the area of a circle of this radius, so that an
        outline in micrometres or pixels may be given as it is. The resting circle has radius 1;
        without ``radius`` an outline of another size than a cell's is refused.
    smoothing : float
        Width of the Gaussian that rounds the corners, over the outline's length, 0.001 to 0.1.

    Attributes
    ----------
    changes : tuple of str
        What was done to the outline so that the model can hold it; empty if nothing was.

    Raises
    ------
    InputError
        For fewer than three corners, values that are not finite, an outline that would lose
        more than a fifth of its area where it crosses or touches itself, or one in other units than
        cell radii.

    Notes
    -----
    An outline in image coordinates, with y downwards, stays as it is: the run is then the mirror
    image of what is seen on the screen.
    """

    xy: np.ndarray
    bound_fraction: Any = None
    tension: float | None = None
    radius: float | None = None
    smoothing: float = 0.01
    changes: tuple[str, ...] = field(default=(), init=False)

    def __post_init__(self) -> None:
        xy = real_array("outline", self.xy, (None, 2))
        xy.setflags(write=False)
        object.__setattr__(self, "xy", xy)
        if self.bound_fraction is not None:
            bound = self._checked_bound()
            bound.setflags(write=False)
            object.__setattr__(self, "bound_fraction", bound)
        if self.radius is not None:
            radius = real_number("radius", self.radius, 0.0, 1e6, open_low=True)
            object.__setattr__(self, "radius", radius)
        if self.tension is not None:
            object.__setattr__(self, "tension", real_number("tension", self.tension, -1e12, 1e12))
        smoothing = real_number("smoothing", self.smoothing, 0.001, 0.1)
        object.__setattr__(self, "smoothing", smoothing)
        curve, changes = held_polygon(xy, _NODES, smoothing)
        if self.radius is None:
            _check_size(curve.area)
        object.__setattr__(self, "changes", changes)
        for change in changes:
            warnings.warn(f"the outline was changed: {change}", OutlineChangedWarning, stacklevel=3)

    @checked
    def state(self, parameters: Parameters, nodes: int) -> CellState:
        """Return the first state on ``nodes`` nodes."""
        curve = held_polygon(self.xy, nodes, self.smoothing)[0]
        bound = np.full(nodes, parameters.n_bar)
        if self.bound_fraction is not None:
            bound = self._bound_along(curve)
        if self.radius is not None:
            size = self.radius * math.sqrt(math.pi / curve.area)
            origin = curve.centroid + size * (curve.origin - curve.centroid)
            curve = Curve(curve.theta, size * curve.length, origin)
        tension = parameters.sigma_bar if self.tension is None else self.tension
        return CellState(curve, bound, tension)

    def describe(self) -> dict[str, Any]:
        """Return this start as plain values for JSON."""
        bound = None if self.bound_fraction is None else self.bound_fraction.tolist()
        return {
            "kind": "FromOutline",
            "xy": self.xy.tolist(),
            "bound_fraction": bound,
            "tension": self.tension,
            "radius": self.radius,
            "smoothing": self.smoothing,
        }

    def _checked_bound(self) -> np.ndarray:
        bound = real_array("bound_fraction", self.bound_fraction, None)
        if bound.shape not in ((), (len(self.xy),)):
            raise InputError(f"bound_fraction has shape {bound.shape}: it must have one a vertex")
        bound = np.broadcast_to(bound, len(self.xy)).copy()
        for vertex in np.flatnonzero((bound < 0.0) | (bound > 1.0))[:1]:
            raise InputError(
                f"bound_fraction is {bound[vertex]:.4g} at vertex {vertex}: it must be from 0 to 1"
            )
        return bound

    def _bound_along(self, curve: Curve) -> np.ndarray:
        """Bound fraction at the nodes: that of the nearest point of the polygon, smoothed."""
        start, end = self.xy, np.roll(self.xy, -1, axis=0)
        edge = end - start
        size = np.maximum((edge**2).sum(axis=1), 1e-300)
        arm = curve.points[:, None, :] - start[None]
        part = np.clip((arm * edge[None]).sum(axis=2) / size, 0.0, 1.0)
        gap = arm - part[..., None] * edge[None]
        nearest = (gap**2).sum(axis=2).argmin(axis=1)
        along = part[np.arange(curve.nodes), nearest]
        following = np.roll(self.bound_fraction, -1)
        values = (1.0 - along) * self.bound_fraction[nearest] + along * following[nearest]
        damping = np.exp(
            -0.5 * (2.0 * math.pi * self.smoothing * fourier.wavenumbers(curve.nodes)) ** 2
        )
        smooth: np.ndarray = np.fft.ifft(np.fft.fft(values) * damping).real
        bound: np.ndarray = np.clip(smooth, 0.0, 1.0)
        return bound


def _check_size(area: float) -> None:
    """Refuse an outline in micrometres, pixels or metres: it would run as a cell of that size."""
    radius = math.sqrt(area / math.pi)
    if not 1.0 / _TIMES <= radius <= _TIMES:
        raise InputError(
            f"the outline has the area of a circle of radius {radius:.4g}, a resting cell has "
            f"radius 1: are its units others? Give radius=1 to make it a cell's size, or "
            f"radius={radius:.4g} to keep it"
        )
