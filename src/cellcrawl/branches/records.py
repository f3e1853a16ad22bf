"""States as a dataset of the run contract."""

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
    from cellcrawl.branches.state import SteadyState


def as_dataset(states: Sequence[SteadyState], nodes: int) -> xr.Dataset:
    """Return states one after the other as records of a run, a unit of time apart.

    The time is the place in the list: such a dataset is for pictures and for what is measured of
    one record, not for what is measured along time.
    """
    records = [state.record(nodes) for state in states]
    arrays = {name: np.array([record[name] for record in records]) for name in FIELDS}
    arrays["time"] = np.arange(len(states), dtype=float)
    first = states[0]
    attributes: dict[str, Any] = {
        "kind": "steady states",
        "parameters": first.parameters.to_dict(),
        "schedule": {},
        "start": first.describe(),
        "seed": -1,
        "solver": "branches",
        "solver_options": {"nodes": nodes},
        "diagnostics": {},
        "save_every": 1.0,
        "records_on_grid": len(states),
        "status": "completed",
        "status_message": "steady states, by Newton's method; records are no times",
        "end_time": float(len(states) - 1),
        "cellcrawl_version": package_version(),
        "schema_version": SCHEMA_VERSION,
    }
    if first.setting.laws != PAPER:
        attributes["laws"] = first.setting.laws.describe()
    return arrays_to_dataset(arrays, encode_attributes(attributes))
