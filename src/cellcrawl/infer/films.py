"""What a bank keeps of a run: the path of its centroid and its outline as Fourier modes."""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np
import xarray as xr

from cellcrawl.simulation.description import RunDescription
from cellcrawl.sweeps import worker
from cellcrawl.sweeps.worker import Outcome

MODES: Final = 10
"""Highest wavenumber kept, of either sign: waves of a tenth of the outline."""
WAVES: Final = np.arange(-MODES, MODES + 1)
TRANSIENT: Final = 10.0
"""Time that films leave out, in 1/k_off0: a cell at rest breaks its symmetry meanwhile."""
SAVE_EVERY: Final = 0.125
"""Time between records, in 1/k_off0: between them an edge goes along cubics, to 1e-5 of R_0."""
NODES: Final = 64
QUANTUM: Final = 1e-4
"""Step in which modes are kept, in R_0: a thousandth of a usual pixel."""
_DENSE: Final = 256
_LIMIT: Final = 32767
_TINY: Final = 1e-9


def modes_of_edge(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Fourier modes of closed outlines in equal arclength about their centroid.

    Parameters
    ----------
    x, y : ndarray, shape (..., node)
        Points equally spaced along each outline, counter-clockwise, about any origin.

    Returns
    -------
    ndarray of complex, shape (..., 2 MODES + 1)
        Of wavenumbers `WAVES`; that of wavenumber 0 is the mean point of the outline.
    """
    spectrum = np.fft.fft(x + 1j * y, axis=-1) / x.shape[-1]
    return np.asarray(spectrum[..., WAVES])


def edge_of_modes(modes: np.ndarray, nodes: int = NODES) -> np.ndarray:
    """Return the outlines that modes describe, complex, shape (..., nodes)."""
    spectrum = np.zeros((*modes.shape[:-1], nodes), complex)
    spectrum[..., WAVES] = modes
    return np.asarray(np.fft.ifft(spectrum, axis=-1) * nodes)


def film_of(run: xr.Dataset) -> xr.Dataset:
    """Return what a bank keeps of a run: centroid, and modes about it in steps of `QUANTUM`."""
    late = run.isel(time=run["time"].values >= TRANSIENT - 1e-9)
    x = late["x"].values - late["centroid_x"].values[:, None]
    y = late["y"].values - late["centroid_y"].values[:, None]
    modes = modes_of_edge(x, y)
    steps = np.stack([modes.real, modes.imag], axis=-1) / QUANTUM
    whole = np.clip(np.rint(steps), -_LIMIT, _LIMIT).astype(np.int16)
    path = np.stack([late["centroid_x"].values, late["centroid_y"].values], axis=-1)
    return xr.Dataset(
        {
            "centroid": (("time", "axis"), path.astype(np.float32)),
            "modes": (("time", "wave", "part"), whole),
        }
    )


def execute(run: RunDescription, keep: str) -> Outcome:
    """Make one run and keep its film; what a worker of a bank calls."""
    made = worker.execute(run, "fields")
    assert made.dataset is not None
    return Outcome(made.columns, film_of(made.dataset))


def settings(t_end: float) -> dict[str, Any]:
    """Return what the runs of a bank share."""
    return {
        "t_end": t_end,
        "save_every": SAVE_EVERY,
        "nodes": NODES,
        "options": {"rtol": 1e-3},
    }


def records_of(t_end: float) -> int:
    """Return how many records a film of a whole run has."""
    return 1 + math.floor((t_end - TRANSIENT) / SAVE_EVERY + 1e-9)


def equal_arclength(edge: np.ndarray, nodes: int = NODES) -> np.ndarray:
    """Return points equally spaced along closed outlines, complex, shape (..., nodes).

    What comes from pixels has sides in few directions only, whose arclength is not that of the
    edge: the outline is made of its long waves first, and measured then.
    """
    count = edge.shape[-1]
    spectrum = np.fft.fft(edge, axis=-1) / count
    return evenly(edge_of_modes(spectrum[..., WAVES], _DENSE), nodes)


def evenly(edge: np.ndarray, nodes: int) -> np.ndarray:
    """Return points equally spaced along closed polygons, complex, shape (..., nodes)."""
    corners = edge.reshape(-1, edge.shape[-1])
    corners = np.concatenate([corners, corners[:, :1]], axis=1)
    at = np.zeros(corners.shape)
    np.cumsum(np.abs(np.diff(corners, axis=1)), axis=1, out=at[:, 1:])
    # All polygons one after the other, each one long, so that one call interpolates them all.
    number = np.arange(len(at))[:, None]
    at = number + at / np.maximum(at[:, -1:], _TINY) * (1.0 - _TINY)
    along = number + (np.arange(nodes) / nodes)[None]
    found = np.interp(along.ravel(), at.ravel(), corners.ravel())
    return np.asarray(found.reshape(*edge.shape[:-1], nodes))
