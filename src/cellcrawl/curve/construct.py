"""Equal-arclength curves from a parametric path, a polar radius or a polygon."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from cellcrawl.curve.crossing import first_crossing
from cellcrawl.curve.equal_arclength import FEWEST_NODES, MOST_NODES, Curve
from cellcrawl.errors import InputError
from cellcrawl.numerics import fourier
from cellcrawl.validation import real_array, real_number, whole_number

LARGEST = 1e12  # coordinates of an outline
_AREA_LOST = 0.01  # share of the area at which nodes are too few to show a shape


class SelfCrossing(InputError):
    """An outline that crosses or touches itself, as given or once smoothed."""


def from_path(path: np.ndarray, nodes: int) -> tuple[Curve, np.ndarray]:
    """Curve through a smooth closed path, and the path's parameter at each node.

    Parameters
    ----------
    path : complex array, shape (samples,)
        ``x + iy`` at equal steps of a parameter of period 2 pi, counter-clockwise, well resolved.
    nodes : int
        Number of nodes of the curve. Node 0 is sample 0.

    Returns
    -------
    Curve
        Spectrally accurate.
    array, shape (nodes,)
        The parameter, from 0 to 2 pi, at each node.

    Raises
    ------
    InputError
        For a path that stops, turns back, winds otherwise than once counter-clockwise, or has more
        detail than the nodes can show.
    """
    whole_number("nodes", nodes, FEWEST_NODES, MOST_NODES)
    velocity = fourier.derivative(path, 2.0 * math.pi)
    speed = np.abs(velocity)
    if not speed.min() > 1e-9 * speed.mean():
        raise InputError("the path stops or turns back on itself: its points must keep moving on")
    mean_speed = float(speed.mean())
    lead = fourier.integral(speed - mean_speed, 2.0 * math.pi)
    ahead = fourier.TrigonometricSeries(lead)
    pace = fourier.TrigonometricSeries(speed)
    target = 2.0 * math.pi * np.arange(nodes) / nodes
    parameter = np.interp(
        mean_speed * np.append(target, 2.0 * math.pi),
        mean_speed * np.linspace(0.0, 2.0 * math.pi, path.size + 1) + np.append(lead, 0.0),
        np.linspace(0.0, 2.0 * math.pi, path.size + 1),
    )[:-1]
    for _ in range(20):
        miss = parameter - target + ahead(parameter).real / mean_speed
        parameter = parameter - miss * mean_speed / pace(parameter).real
        if np.max(np.abs(miss)) < 1e-9:  # Newton squares it
            break
    if not np.max(np.abs(miss)) < 1e-9:
        raise InputError("the path has corners too sharp to follow: smooth it or give more samples")
    series = fourier.TrigonometricSeries(path - path.mean())
    theta = np.unwrap(np.angle(series(parameter, order=1)))
    start = complex(path[0])
    curve = Curve(theta, 2.0 * math.pi * mean_speed, np.array([start.real, start.imag]))
    if curve.turning_number != 1:
        raise InputError(
            "the path is not a simple counter-clockwise curve: its tangent turns "
            f"{curve.turning_number} times, not once"
        )
    curve = curve.closed()
    area = math.pi * float(np.mean((np.conj(path - path.mean()) * velocity).imag))
    if not abs(curve.area - area) <= _AREA_LOST * area:
        raise InputError(
            f"{nodes} nodes are too few for this shape: they show an area of {curve.area:.3g} "
            f"where it has {area:.3g}; give more nodes or a rounder shape"
        )
    return curve, parameter


def from_polar(radius: Callable[[np.ndarray], Any], nodes: int, samples: int = 4096) -> Curve:
    """Curve ``x = R(phi) cos phi, y = R(phi) sin phi`` with node 0 at ``phi = 0``.

    Parameters
    ----------
    radius : callable
        ``R`` of an array of angles; smooth, of period 2 pi, positive.
    nodes : int
        Number of nodes.
    samples : int
        Points at which ``R`` is read.
    """
    return from_path(polar_path(radius, samples), nodes)[0]


def polar_path(radius: Callable[[np.ndarray], Any], samples: int) -> np.ndarray:
    """``R(phi) exp(i phi)`` at equal steps of phi; raises `InputError` unless R is positive."""
    angle = 2.0 * math.pi * np.arange(samples) / samples
    values = real_array("radius", radius(angle), None)
    if values.shape not in ((), (samples,)):
        raise InputError(f"the radius has shape {values.shape} for angles of shape ({samples},)")
    values = np.broadcast_to(values, (samples,))
    if values.min() <= 0.0:
        at = angle[values.argmin()]
        raise InputError(
            f"the radius is {values.min():.3g} at phi = {at:.3g}: it must be positive everywhere"
        )
    path: np.ndarray = values * np.exp(1j * angle)
    return path


def from_polygon(xy: Any, nodes: int, smoothing: float = 0.01) -> Curve:
    """Smooth curve along any simple closed polygon, of the same area.

    The polygon is smoothed along its arclength by a Gaussian, so that corners get a curvature the
    nodes can show.

    Parameters
    ----------
    xy : array, shape (vertices, 2)
        Vertices in order, either way round; the first may be repeated at the end.
    nodes : int
        Number of nodes. Node 0 is near vertex 0.
    smoothing : float
        Width of the Gaussian over the polygon's length, 0.001 to 0.1. A corner of angle ``a``
        gets a radius of about ``2.5 * smoothing * length / a``.

    Raises
    ------
    InputError
        For fewer than three corners, values that are not finite, or a polygon that crosses or
        touches itself.
    """
    vertices = simple_polygon(xy)
    width = real_number("smoothing", smoothing, 0.001, 0.1)
    corners = np.append(vertices, vertices[:1], axis=0)
    at = np.append(0.0, np.cumsum(np.hypot(*np.diff(corners, axis=0).T)))
    whole_number("nodes", nodes, FEWEST_NODES, MOST_NODES)
    samples = max(8 * nodes, 4096)
    along = at[-1] * np.arange(samples) / samples
    path = np.interp(along, at, corners[:, 0]) + 1j * np.interp(along, at, corners[:, 1])
    k = fourier.wavenumbers(samples)
    smooth = np.fft.ifft(np.fft.fft(path) * np.exp(-0.5 * (2.0 * math.pi * width * k) ** 2))
    curve = from_path(smooth, nodes)[0]
    if first_crossing(curve.points) is not None:
        raise SelfCrossing("the outline crosses itself once smoothed: give a smaller smoothing")
    size = math.sqrt(polygon_area(vertices) / curve.area)
    origin = curve.centroid + size * (curve.origin - curve.centroid)
    return Curve(curve.theta, size * curve.length, origin)


def simple_polygon(xy: Any) -> np.ndarray:
    """Return the vertices of ``xy`` counter-clockwise without repeats, or raise `InputError`."""
    vertices = real_array("outline", xy, (None, 2))
    if len(vertices):
        keep = np.any(vertices != np.roll(vertices, -1, axis=0), axis=1)
        vertices = vertices[keep]
    if len(vertices) < 3:
        raise InputError(f"the outline has {len(vertices)} distinct vertices: it needs at least 3")
    reach = np.abs(vertices).max()
    if reach > LARGEST or reach < 1.0 / LARGEST:
        raise InputError(
            f"the outline reaches {reach:.3g} from the origin: give it in a unit in which it "
            f"reaches {1.0 / LARGEST:g} to {LARGEST:g}"
        )
    crossing = first_crossing(vertices)
    if crossing is not None:
        first, second = crossing.edges
        raise SelfCrossing(
            f"the outline crosses or touches itself: edges {first} and {second} meet near "
            f"({crossing.point[0]:.4g}, {crossing.point[1]:.4g})"
        )
    if polygon_area(vertices) < 0.0:
        vertices = np.concatenate([vertices[:1], vertices[:0:-1]])
    return vertices


def polygon_area(vertices: np.ndarray) -> float:
    """Signed area of a polygon, positive counter-clockwise."""
    x, y = (vertices - vertices.mean(axis=0)).T
    return float(0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
