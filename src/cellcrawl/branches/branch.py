"""A branch: steady states in a row, with the points at which the cell's fate changes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.branches.points import SpecialPoint
from cellcrawl.branches.state import SteadyState

if TYPE_CHECKING:
    import pandas as pd

_GROWTH_RATES = 6  # of each symmetry in a table


class Branch:
    """Steady states followed in one parameter.

    Made by `continue_in`; `open_branch` reads one from a file.

    Attributes
    ----------
    name, to : str, float
        The parameter that was followed, and to where.
    states : list of SteadyState
        In the order in which they were found.
    special_points : list of SpecialPoint
        In the same order.
    status, message : str
        How the branch ended, one of `cellcrawl.branches.ENDS`, and what that means.
    spectra : bool
        Whether growth rates were found.
    """

    def __init__(
        self, name: str, to: float, states: list[SteadyState], *, spectra: bool = True
    ) -> None:
        self.name, self.to, self.states, self.spectra = name, to, states, spectra
        self.special_points: list[SpecialPoint] = []
        self.status, self.message = "running", ""

    def add_points(self, points: Iterable[SpecialPoint]) -> None:
        """Add special points, which come after those that are there."""
        self.special_points += sorted(points, key=lambda point: point.position)

    def end(self, status: str, step: float) -> None:
        """Say how the branch ended."""
        from cellcrawl.branches.continuation import ENDS

        last = self.states[-1]
        self.status = status
        self.message = f"{ENDS[status]}: {self.name} = {last.setting.value(self.name):.6g}, speed "
        self.message += f"{last.speed:.4g}, turning rate {last.turning_rate:.4g}"
        if status == "no convergence":
            self.message += (
                f"; the last step tried was {step:.1g}: the shape may have left the model (its "
                f"sharpest bend is {last.largest_curvature:.3g})"
            )

    @property
    def values(self) -> np.ndarray:
        """Values of the parameter, shape (states,)."""
        return np.array([state.setting.value(self.name) for state in self.states])

    def points(self, kind: str) -> list[SpecialPoint]:
        """Return the special points of a kind."""
        return [point for point in self.special_points if point.kind == kind]

    def table(self) -> pd.DataFrame:
        """Return a row for each state, with growth rates where they were found."""
        import pandas as pd

        rows = []
        for state in self.states:
            row: dict[str, Any] = {
                self.name: state.setting.value(self.name),
                "speed": state.speed,
                "turning_rate": state.turning_rate,
                "tension": state.tension,
                "length": state.length,
                "area": state.area,
                "circularity": state.circularity,
                "largest_curvature": state.largest_curvature,
                "nodes": state.mesh.nodes,
            }
            if self.spectra:
                row["unstable_modes"] = state.unstable_modes
                row["stable"] = state.stable
                for symmetry, values in state.eigenvalues_by_symmetry.items():
                    for k in range(min(_GROWTH_RATES, values.size)):
                        label = "_".join(part for part in (symmetry, f"growth_rate_{k}") if part)
                        row[label] = values[k].real
                        row[label.replace("growth_rate", "frequency")] = values[k].imag
            rows.append(row)
        return pd.DataFrame(rows)

    @checked
    def dataset(self, nodes: int = 256) -> xr.Dataset:
        """Return the cells as records of a run, a unit of time apart, with the parameter's values.

        For pictures and for what is measured of one record: the time is the number of the state.
        """
        from cellcrawl.branches.records import as_dataset

        made = as_dataset(self.states, nodes)
        return made.assign_coords({f"branch_{self.name}": ("time", self.values)})

    def __len__(self) -> int:
        return len(self.states)

    def __iter__(self) -> Iterator[SteadyState]:
        return iter(self.states)

    def __getitem__(self, index: int) -> SteadyState:
        return self.states[index]

    def __repr__(self) -> str:
        values = self.values
        points = ", ".join(f"{p.kind} at {p.value:.6g}" for p in self.special_points)
        return (
            f"Branch({self.name} from {values[0]:g} to {values[-1]:g}, {len(self)} states, "
            f"{self.status}{': ' + points if points else ''})"
        )
