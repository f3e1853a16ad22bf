"""Runs made by hand, whose answers are known exactly."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import xarray as xr

from cellcrawl.simulation.dataset import frames_to_dataset
from cellcrawl.solvers import Frame

NODES = 64
Track = Callable[[float], tuple[tuple[float, float], tuple[float, float]]]


def circle_on_track(
    times: np.ndarray, track: Track, *, nodes: int = NODES, node_0: float = 0.0, **fields: float
) -> xr.Dataset:
    """A rigid unit circle whose centroid has the given positions and velocities.

    Node 0 is at polar angle ``node_0``; n is highest at the front, 0.5 + 0.2 cos(angle to it).
    """
    angle = node_0 + 2.0 * np.pi * np.arange(nodes) / nodes
    normal = np.array([np.cos(angle), np.sin(angle)])
    frames = []
    for time in times:
        (x, y), (u, v) = track(float(time))
        towards = np.cos(angle - np.arctan2(v, u))
        frames.append(
            Frame(
                time=float(time),
                x=x + normal[0],
                y=y + normal[1],
                theta=angle + 0.5 * np.pi,
                curvature=np.ones(nodes),
                bound_fraction=0.5 + 0.2 * towards,
                off_rate=50.0 - 30.0 * towards,
                normal_velocity=u * normal[0] + v * normal[1],
                friction=1000.0 + 10.0 * towards,
                tension=900.0 + float(time),
                length=2.0 * np.pi,
                area=np.pi,
                centroid_x=x,
                centroid_y=y,
            )
        )
    return frames_to_dataset(frames, {"status": "completed", **fields})


def straight(
    velocity: tuple[float, float] = (0.12, 0.16),
    records: int = 11,
    step: float = 1.0,
    **options: float,
) -> xr.Dataset:
    """A circle that moves straight on."""
    u, v = velocity
    times = step * np.arange(records)
    return circle_on_track(times, lambda t: ((u * t, v * t), velocity), **options)  # type: ignore[arg-type]


def circling(rate: float, radius: float = 3.0, records: int = 401, step: float = 0.1) -> xr.Dataset:
    """A circle whose centroid goes round at ``rate``, counter-clockwise if positive."""

    def track(t: float) -> tuple[tuple[float, float], tuple[float, float]]:
        c, s = np.cos(rate * t), np.sin(rate * t)
        return (radius * c, radius * s), (-radius * rate * s, radius * rate * c)

    return circle_on_track(step * np.arange(records), track)
