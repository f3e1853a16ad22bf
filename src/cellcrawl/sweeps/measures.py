"""One row a run: what was asked, how it ended, which mode it shows and what was measured."""

from __future__ import annotations

import json
import math
from typing import Any, Final

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.modes import classify_track
from cellcrawl.simulation.description import RunDescription
from cellcrawl.simulation.track import Track
from cellcrawl.sweeps.periods import dominant_period

TRANSIENT: Final = 5.0
"""Averages leave out the time before, as the paper's diagrams do."""
_FEWEST = 3

MEASURES: Final = {
    "confidence": "confidence in the mode, 0 to 1",
    "speed": "mean speed of the centroid, from t = 5 on (R_0 k_off0)",
    "turning_rate": "net turning rate after the transient, positive to the left (rad k_off0)",
    "tension": "mean tension, from t = 5 on",
    "tension_low": "least tension in the second half of the run",
    "tension_high": "largest tension in the second half of the run",
    "tension_period": "period of the tension in the second half; none if it does not oscillate",
    "circularity": "mean of 4 pi A / L^2, from t = 5 on",
    "x_c": "mean distance of the centroid from its start, from t = 5 on (R_0)",
    "area": "mean area, from t = 5 on (R_0^2)",
    "length": "mean length of the edge, from t = 5 on (R_0)",
}
"""Columns of a row that are measured, and what they mean."""


def described_columns(run: RunDescription) -> dict[str, Any]:
    """Return the columns that say what the run was."""
    described = run.describe()
    return {
        **described["parameters"],
        "seed": getattr(run.start, "seed", None),
        "start": json.dumps(described["start"]),
        "schedule": json.dumps(described["schedule"]),
        "solver": run.solver,
        "nodes": run.nodes,
        "options": json.dumps(described["options"]),
        "laws": _text(described.get("laws")),
        "surroundings": _text(described.get("surroundings")),
        "t_end": run.t_end,
        "save_every": run.save_every,
    }


def _text(value: Any) -> str | None:
    return None if value is None else json.dumps(value)


def measured_columns(track: Track) -> dict[str, Any]:
    """Return the columns that a run gives; None for what it is too short to show.

    A cell that tore keeps the measures of the time before; leave it out of averages by its mode.
    """
    attributes = track.attributes
    diagnostics = attributes["diagnostics"]
    status = str(attributes["status"])
    return {
        **_mode(track, status),
        **_averages(track),
        **_tension(track),
        "end_time": float(attributes["end_time"]),
        "status": status,
        "message": str(attributes["status_message"]),
        "steps": int(diagnostics["steps"]),
        "wall_time": float(diagnostics["wall_time"]),
    }


def _mode(track: Track, status: str) -> dict[str, Any]:
    radius = math.sqrt(float(np.median(track.area)) / math.pi)
    try:
        found = classify_track(
            track.time, track.centroid_x, track.centroid_y, cell_radius=radius, status=status
        )
    except InputError:  # too short for a mode
        return {"mode": None, "confidence": None, "turning_rate": None}
    turning = found.measures.turning_rate
    return {
        "mode": found.mode,
        "confidence": found.confidence,
        "turning_rate": turning if math.isfinite(turning) else None,
    }


def _averages(track: Track) -> dict[str, Any]:
    names = ("speed", "tension", "circularity", "x_c", "area", "length")
    late = track.time >= TRANSIENT
    if late.sum() < _FEWEST:
        return dict.fromkeys(names)
    time, x, y = track.time[late], track.centroid_x[late], track.centroid_y[late]
    path = float(np.hypot(np.diff(x), np.diff(y)).sum())
    away = np.hypot(x - track.centroid_x[0], y - track.centroid_y[0])
    area, length = track.area[late], track.length[late]
    averages = (
        path / float(time[-1] - time[0]),
        track.tension[late].mean(),
        (4.0 * math.pi * area / length**2).mean(),
        away.mean(),
        area.mean(),
        length.mean(),
    )
    return {name: float(value) for name, value in zip(names, averages, strict=True)}


def _tension(track: Track) -> dict[str, Any]:
    half = track.time >= 0.5 * track.time[-1]
    if half.sum() < _FEWEST:
        return dict.fromkeys(("tension_low", "tension_high", "tension_period"))
    time, tension = track.time[half], track.tension[half]
    return {
        "tension_low": float(tension.min()),
        "tension_high": float(tension.max()),
        "tension_period": dominant_period(time, tension),
    }
