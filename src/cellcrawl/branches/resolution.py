"""How many nodes a shape needs, and where they crowd."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

import numpy as np

from cellcrawl.branches.equations import Fields
from cellcrawl.branches.mesh import Mesh
from cellcrawl.branches.system import System

Sampler = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
"""Angle less its winding and bound fraction at angles along the edge."""

COUNTS: Final = (49, 65, 97, 129, 193, 257, 321, 385, 513)
WANTED: Final = 3e-8
"""Share of the shortest waves that a mesh may leave."""
_WASTED: Final = 3e-12
_CROWDS: Final = ((0.9, 0.3), (0.8, 0.3), (0.7, 0.5), (0.5, 0.5))
_CORNER = 1.5  # times the mean curvature
_FINE = 2048


def choose(sampler: Sampler, mirror: bool) -> Mesh:
    """Return the smallest mesh that resolves a shape, or the best there is."""
    best: tuple[float, Mesh] | None = None
    places = corners(sampler, mirror)
    for count in COUNTS:
        candidates = [Mesh(count)]
        if places:
            candidates += [Mesh(count, places, rho, share) for rho, share in _CROWDS]
        for mesh in candidates:
            tail = tail_on(mesh, *sampler(mesh.alpha))
            if best is None or tail < best[0]:
                best = (tail, mesh)
        assert best is not None
        if best[0] < WANTED:
            break
    assert best is not None
    return best[1]


def tail_on(mesh: Mesh, w: np.ndarray, n: np.ndarray) -> float:
    """Return the share of the shortest waves of a shape on a mesh."""
    return mesh.tail(w, n, mesh.whole.angle_slope @ w)


def corners(sampler: Sampler, mirror: bool) -> tuple[float, ...]:
    """Return where an edge bends most: two places at most, mirror images for a mirror axis."""
    alpha = 2.0 * math.pi * np.arange(_FINE) / _FINE
    w, _ = sampler(alpha)
    k = np.fft.rfftfreq(_FINE, 1.0 / _FINE)
    kappa = 1.0 + np.fft.irfft(1j * k * np.fft.rfft(w), _FINE)
    if mirror:
        half = kappa[: _FINE // 2]
        place = float(alpha[int(np.argmax(half))])
        if half.max() < _CORNER or not 0.05 < place < math.pi - 0.05:
            return ()
        return (place, 2.0 * math.pi - place)
    peaks = (kappa > np.roll(kappa, 1)) & (kappa >= np.roll(kappa, -1)) & (kappa > _CORNER)
    found = sorted(np.flatnonzero(peaks), key=lambda i: -kappa[i])[:2]
    return tuple(sorted(float(alpha[i]) for i in found))


def resampled(system: System, y: np.ndarray, mesh: Mesh) -> tuple[System, np.ndarray]:
    """Return unknowns (or a change of them) on another mesh."""
    shape, slide, turn = system.unpack(y)
    whole = system.whole(shape)
    moved = System(mesh, system.mirror)
    w, n = (system.mesh.values(field, mesh.alpha) for field in (whole.w, whole.n))
    kept = moved.nodes
    fields = Fields(w[:kept], n[:kept], shape.length, shape.sigma)
    return moved, moved.pack(fields, slide, turn)


def better_mesh(system: System, y: np.ndarray) -> Mesh | None:
    """Return another mesh if the shape has outgrown its own, or needs far less."""
    whole = system.whole(system.unpack(y)[0])
    mesh = system.mesh
    tail = tail_on(mesh, whole.w, whole.n)
    if _WASTED < tail < WANTED:
        return None
    if tail <= _WASTED and mesh.nodes == COUNTS[0]:
        return None

    def sampler(alpha: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return mesh.values(whole.w, alpha), mesh.values(whole.n, alpha)

    found = choose(sampler, system.mirror)
    if found.nodes == mesh.nodes and tail >= WANTED:
        better = tail_on(found, *sampler(found.alpha)) < 0.5 * tail
        return found if better and found != mesh else None
    return None if found == mesh else found
