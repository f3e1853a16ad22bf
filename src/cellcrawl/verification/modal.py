"""Amplitude of a wavenumber in a frame of any solver."""

from __future__ import annotations

import math

import numpy as np

from cellcrawl.numerics import fourier
from cellcrawl.solvers import Frame


def modal_amplitudes(frame: Frame, k: int, bound_fraction: float) -> np.ndarray:
    """Return complex amplitudes of radius and bound fraction, shape (2,).

    ``f`` in ``Re f exp(i k phi)``, phi the polar angle about (0, 0), of what differs from the
    circle of radius 1 with the given bound fraction. The nodes are equally spaced in arclength;
    the integral over phi is taken along them, exact to rounding on a smooth resolved edge that
    every ray meets once.
    """
    place = frame.x + 1j * frame.y
    nodes = place.size
    around = 2.0 * math.pi * np.arange(nodes) / nodes
    phi = np.unwrap(np.angle(place))
    stretch = 1.0 + fourier.derivative(phi - around, 2.0 * math.pi)
    weight = np.exp(-1j * k * phi) * stretch * ((1.0 if k == 0 else 2.0) / nodes)
    change = np.stack([np.abs(place) - 1.0, frame.bound_fraction - bound_fraction])
    return np.asarray(change @ weight)
