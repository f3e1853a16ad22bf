"""States and orbits as a dataset of the run contract."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from cellcrawl.data import FIELDS
from cellcrawl.laws.law import PAPER
from cellcrawl.simulation.dataset import (
    SCHEMA_VERSION,
    arrays_to_dataset,
    encode_attributes,
    package_version,
)

if TYPE_CHECKING:
    from cellcrawl.branches.setting import Setting
    from cellcrawl.branches.state import SteadyState
    from cellcrawl.starts.base import CellState

Record = dict[str, np.ndarray | float]


def as_dataset(states: Sequence[SteadyState], nodes: int) -> xr.Dataset:
    """Return states one after the other as records of a run, a unit of time apart.

    The time is the place in the list: such a dataset is for pictures and for what is measured of
    one record, not for what is measured along time.
    """
    first = states[0]
    return run_of(
        [state.record(nodes) for state in states],
        np.arange(len(states), dtype=float),
        first.setting,
        first.describe(),
        "steady states",
        "steady states, by Newton's method; records are no times",
    )


def record_of(setting: Setting, cell: CellState, guess: float) -> Record:
    """Return the fields of the run contract of a cell, from a guess of the force on its bonds."""
    curve, n, sigma = cell.curve, cell.bound_fraction, cell.tension
    at = setting.pointwise(np.full(curve.nodes, guess), n, sigma, curve.curvature)
    r, friction = setting.friction(at.phi, n)
    points, (x, y) = curve.points, curve.centroid
    found: Record = {
        "x": points[:, 0], "y": points[:, 1], "theta": curve.theta,
        "curvature": curve.curvature, "bound_fraction": n, "off_rate": r,
        "normal_velocity": at.speed, "friction": friction, "tension": sigma,
        "length": curve.length, "area": curve.area, "centroid_x": x, "centroid_y": y,
    }  # fmt: skip
    return {name: found[name] for name in FIELDS}


def run_of(
    records: Sequence[Record],
    times: np.ndarray,
    setting: Setting,
    start: dict[str, Any],
    kind: str,
    message: str,
) -> xr.Dataset:
    """Return records as a dataset of the run contract."""
    arrays = {name: np.array([record[name] for record in records]) for name in FIELDS}
    arrays["time"] = times
    attributes: dict[str, Any] = {
        "kind": kind,
        "parameters": setting.parameters.to_dict(),
        "schedule": {},
        "start": start,
        "seed": -1,
        "solver": "branches",
        "solver_options": {"nodes": int(arrays["x"].shape[1])},
        "diagnostics": {},
        "save_every": float(times[1] - times[0]) if times.size > 1 else 1.0,
        "records_on_grid": len(records),
        "status": "completed",
        "status_message": message,
        "end_time": float(times[-1]),
        "cellcrawl_version": package_version(),
        "schema_version": SCHEMA_VERSION,
    }
    if setting.laws != PAPER:
        attributes["laws"] = setting.laws.describe()
    return arrays_to_dataset(arrays, encode_attributes(attributes))
