"""A run without its edge: the cell as a whole over time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple

import numpy as np
import xarray as xr

from cellcrawl.simulation.dataset import FIELDS, TIME, decode_attribute, encode_attributes
from cellcrawl.simulation.recorder import Checkpoint
from cellcrawl.solvers import Instant


class Track(NamedTuple):
    """The cell as a whole over time: arrays of shape (records,), and the run's attributes."""

    time: np.ndarray
    centroid_x: np.ndarray
    centroid_y: np.ndarray
    tension: np.ndarray
    length: np.ndarray
    area: np.ndarray
    attributes: dict[str, Any]

    def to_dataset(self) -> xr.Dataset:
        """Return the track as a Dataset, named as in a run's."""
        variables = {
            name: ("time", getattr(self, name), _described(FIELDS[name]))
            for name in _ARRAYS
            if name != "time"
        }
        time = ("time", self.time, _described(TIME))
        return xr.Dataset(variables, {"time": time}, encode_attributes(self.attributes))


_ARRAYS = Track._fields[:-1]


def track_of(run: xr.Dataset) -> Track:
    """Return the track of a run, to the same bits as a `TrackRecorder` would keep."""
    arrays = {name: np.ascontiguousarray(run[name].values) for name in _ARRAYS}
    attributes = {**run.attrs, "diagnostics": decode_attribute(run, "diagnostics")}
    return Track(**arrays, attributes=attributes)


class TrackRecorder:
    """Keeps the cell as a whole, not its edge: the cheapest run, for sweeps."""

    edges: ClassVar[bool] = False

    def __init__(self) -> None:
        self._rows: list[tuple[float, ...]] = []

    def record(self, record: Instant) -> bool:
        self._rows.append(tuple(getattr(record, name) for name in _ARRAYS))
        return False

    def commit(self, checkpoint: Checkpoint, attributes: Mapping[str, Any]) -> None:
        return

    def finish(
        self, closing: Instant | None, checkpoint: Checkpoint, attributes: Mapping[str, Any]
    ) -> Track:
        if closing is not None:
            self.record(closing)
        columns = np.ascontiguousarray(np.array(self._rows).T)
        return Track(**dict(zip(_ARRAYS, columns, strict=True)), attributes=dict(attributes))


def _described(field: Any) -> dict[str, str]:
    return {"long_name": field.long_name, "units": field.units}
