"""What the pictures ask of a run and of a user's choice, refused in one line."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.data.units import in_micrometres
from cellcrawl.errors import InputError
from cellcrawl.simulation.dataset import check_run
from cellcrawl.validation import real_number

_SAME_TIME = 1e-6  # of the time between records


def drawable(dataset: Any) -> xr.Dataset:
    """Return ``dataset`` if it keeps the contract and has a record, or raise `InputError`.

    A run in SI is returned in micrometres, the units that pictures write.
    """
    run = in_micrometres(check_run(dataset))
    if run.sizes["time"] == 0:
        raise InputError("this run has no records: there is nothing to draw")
    return run


def record_at(dataset: xr.Dataset, time: Any) -> int:
    """Return the index of the record nearest ``time``, or raise `InputError` if it is outside."""
    times = dataset["time"].values
    first, last = float(times[0]), float(times[-1])
    slack = _SAME_TIME * max(abs(first), abs(last), 1.0)
    value = real_number("time", time, -np.inf, np.inf)
    if not first - slack <= value <= last + slack:
        raise InputError(
            f"time = {value:g} is outside the run, which goes from {first:g} to {last:g}"
        )
    return int(np.argmin(np.abs(times - value)))


def records_at(dataset: xr.Dataset, times: Any) -> list[int]:
    """Return the records nearest ``times``, one or more numbers."""
    if isinstance(times, str) or not isinstance(times, Iterable):
        times = [times]
    records = [record_at(dataset, time) for time in times]
    if not records:
        raise InputError("times is empty: give at least one time")
    return records
