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

COUNTS: Final = (49, 65, 97, 129, 193, 225, 257, 289, 321, 385, 513)
_WASTED: Final = 1e-13
_CROWDS: Final = ((0.93, 0.25), (0.93, 0.5), (0.85, 0.35), (0.6, 0.5))
_MOST = 3
_CORNER = 1.5  # times the mean curvature
_FINE = 2048


def choose(sampler: Sampler, mirror: bool) -> Mesh:
    """Return the smallest mesh that resolves a shape, or the best there is."""
    best: tuple[float, Mesh] | None = None
    places = corners(sampler, mirror)
    sets = [kept for kept in dict.fromkeys((places, places[:2])) if kept]
    for count in COUNTS:
        candidates = [Mesh(count)]
        for crowded in sets:
            candidates += [Mesh(count, crowded, rho, share) for rho, share in _CROWDS]
        for mesh in candidates:
            tail = tail_on(mesh, *sampler(mesh.alpha))
            if best is None or tail < best[0]:
                best = (tail, mesh)
        assert best is not None
        if best[0] < wanted(count):
            break
    assert best is not None
    return best[1]


def wanted(count: int) -> float:
    """Return the share of the shortest waves that a mesh may leave; few nodes cost nothing."""
    return 1e-10 if count <= 129 else 1e-9 if count <= 225 else 1e-8


def tail_on(mesh: Mesh, w: np.ndarray, n: np.ndarray) -> float:
    """Return the share of the shortest waves of a shape on a mesh."""
    return mesh.tail(w, n)


def corners(sampler: Sampler, mirror: bool) -> tuple[float, ...]:
    """Return where an edge bends most, three places at most, the sharpest first."""
    alpha = 2.0 * math.pi * np.arange(_FINE) / _FINE
    w, _ = sampler(alpha)
    k = np.fft.rfftfreq(_FINE, 1.0 / _FINE)
    kappa = 1.0 + np.fft.irfft(1j * k * np.fft.rfft(w), _FINE)
    peaks = (kappa > np.roll(kappa, 1)) & (kappa >= np.roll(kappa, -1)) & (kappa > _CORNER)
    found = [float(alpha[i]) for i in sorted(np.flatnonzero(peaks), key=lambda i: -kappa[i])]
    if not mirror:
        return tuple(found[:_MOST])
    places: list[float] = []
    for place in (min(one, 2.0 * math.pi - one) for one in found):
        if min(place, math.pi - place) < 0.02:
            pair = [0.0 if place < 1.0 else math.pi]
        else:
            pair = [place, 2.0 * math.pi - place]
        if len(places) + len(pair) <= _MOST and not any(abs(pair[0] - p) < 0.05 for p in places):
            places += pair
    return tuple(places)


def resampled(system: System, y: np.ndarray, mesh: Mesh) -> tuple[System, np.ndarray]:
    """Return unknowns (or a change of them) on another mesh."""
    shape, slide, turn = system.unpack(y)
    whole = system.whole(shape)
    moved = System(mesh, system.mirror)
    w, n = (system.mesh.values(field, mesh.alpha) for field in (whole.w, whole.n))
    kept = moved.nodes
    fields = Fields(w[:kept], n[:kept], shape.length, shape.sigma)
    return moved, moved.pack(fields, slide, turn)


def better_mesh(system: System, y: np.ndarray, *, anew: bool = False) -> Mesh | None:
    """Return another mesh if the shape has outgrown its own or needs far less, or ``anew``."""
    whole = system.whole(system.unpack(y)[0])
    mesh = system.mesh
    tail = tail_on(mesh, whole.w, whole.n)
    fits = tail < wanted(mesh.nodes)
    if fits and (mesh.nodes == COUNTS[0] or (tail > _WASTED and not anew)):
        return None

    def sampler(alpha: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return mesh.values(whole.w, alpha), mesh.values(whole.n, alpha)

    found = choose(sampler, system.mirror)
    if not fits and found.nodes <= mesh.nodes:
        return found if tail_on(found, *sampler(found.alpha)) < 0.5 * tail else None
    return None if found == mesh else found
