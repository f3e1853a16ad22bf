"""The state of a saved run as the start of another."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.curve import Curve, fourier
from cellcrawl.data import records_with
from cellcrawl.data.units import DIMENSIONLESS, units_of
from cellcrawl.errors import InputError
from cellcrawl.parameters import Parameters
from cellcrawl.simulation.storage import open_run
from cellcrawl.starts import CellState
from cellcrawl.validation import whole_number

_NEEDED = ("x", "y", "theta", "length", "bound_fraction", "tension", "area")
_SMALLEST, _LARGEST = 0.03, 300.0  # areas of a cell that is in the model's units


@checked
@dataclass(frozen=True, eq=False)
class FromRun:
    """A state of a saved run as the first state of another; immutable.

    Parameters
    ----------
    run : Dataset, str or Path
        A run, or the file that holds it.
    record : int
        Which saved time; the last unless given.
    """

    run: xr.Dataset | str | Path
    record: int = -1

    @checked
    def state(self, parameters: Parameters, nodes: int) -> CellState:
        """Return the saved state on ``nodes`` nodes; its tension is kept."""
        frame = self.saved_record()
        area = float(frame["area"])
        if not _SMALLEST <= area <= _LARGEST:
            raise InputError(
                f"FromRun: the area of this record is {area:.3g}, and a cell's is about pi in the "
                "model's units: give a run without dimension"
            )
        origin = np.array([frame["x"][0].item(), frame["y"][0].item()])
        curve = Curve(frame["theta"].values, frame["length"].item(), origin)
        bound = frame["bound_fraction"].values
        if nodes != curve.nodes:
            curve = curve.resampled(nodes)
            bound = np.clip(fourier.resample(bound, nodes), 0.0, 1.0)
        return CellState(curve, bound, frame["tension"].item())

    def saved_record(self) -> xr.Dataset:
        """Return the saved record that is the start.

        Raises
        ------
        InputError
            If there is no such record, or the dataset is no run in the model's units.
        """
        dataset = records_with(self._dataset())
        if units_of(dataset) != DIMENSIONLESS:
            raise InputError(
                "FromRun needs a run in the model's units, and this one is in others: give the run "
                "that it was made from"
            )
        count = dataset.sizes["time"]
        record = whole_number("record", self.record, -count, count - 1)
        try:
            one = records_with(dataset.isel(time=[record]), *_NEEDED)
        except InputError as error:
            raise InputError(f"FromRun, of record {record} alone: {error}") from None
        return one.isel(time=0).load()

    def describe(self) -> dict[str, Any]:
        """Return this start as plain values for JSON."""
        source = self.run if isinstance(self.run, (str, Path)) else "a dataset in memory"
        return {"kind": "FromRun", "run": str(source), "record": self.record}

    def _dataset(self) -> xr.Dataset:
        if isinstance(self.run, xr.Dataset):
            return self.run
        if not isinstance(self.run, (str, Path)):
            raise InputError(f"FromRun needs a Dataset or a file, not {type(self.run).__name__}")
        return open_run(self.run)
