"""The results of a sweep: read from its folder, whenever and by whomever it was made."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.data import MODEL_ENDINGS
from cellcrawl.errors import InputError
from cellcrawl.sweeps.axes import OPTIONS, plain, value_of
from cellcrawl.sweeps.grid import Grid, united
from cellcrawl.sweeps.kept import read_kept
from cellcrawl.sweeps.measures import MEASURES, described_columns
from cellcrawl.sweeps.parts import COLUMNS, NOT_RUN, schema
from cellcrawl.sweeps.planes import varied
from cellcrawl.sweeps.store import SweepStore, grids_of
from cellcrawl.validation import known_names, plain_number, shown

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa

MISSING = "missing"
"""Status of a run that has no row yet."""
_ROWS_AT_A_TIME = 1000
_RESULTS = ("mode", *MEASURES, "end_time", "status", "message", "steps", "wall_time", "key")


class Status(NamedTuple):
    """How far a sweep is."""

    runs: int
    done: int
    statuses: dict[str, int]
    modes: dict[str, int]
    at_work: bool
    """Whether a driver holds the folder."""


class Sweep:
    """The results of a sweep; nothing is read before it is asked for.

    Parameters
    ----------
    path : str or Path
        The sweep's folder.
    grid : Grid, optional
        The grid; read from the folder unless given.
    interrupted : bool
        Whether the call that returned this was stopped by Ctrl-C.

    Attributes
    ----------
    path : Path
    interrupted : bool
    """

    @checked
    def __init__(
        self, path: str | Path, grid: Grid | None = None, *, interrupted: bool = False
    ) -> None:
        self._store = SweepStore(path)
        self._manifest = self._store.manifest()
        self._grid = grid
        self.path = self._store.folder
        self.interrupted = interrupted

    @property
    def grid(self) -> Grid:
        """The grid whose runs these are; of a folder that was extended, all grids as one.

        Raises
        ------
        InputError
            If it has starts of a class of your own, which a folder cannot hold.
        """
        if self._grid is None:
            try:
                self._grid = united([Grid.from_dict(g) for g in grids_of(self._manifest)])
            except InputError as error:
                raise InputError(
                    f"the grid of {self.path} cannot be made from its folder ({error}): give it, "
                    "as in open_sweep(path, grid)"
                ) from None
        return self._grid

    @property
    def keep(self) -> str:
        """What is kept: "rows", "tracks" or "fields"."""
        return str(self._manifest["keep"])

    @checked
    def is_of(self, grid: Grid) -> bool:
        """Whether these are the results of ``grid``."""
        if self._manifest["digest"] == grid.digest:
            return True
        return grid.describe() in grids_of(self._manifest)[1:]

    @checked
    def table(self, columns: list[str] | None = None) -> pa.Table:
        """Return the rows there are, one a run, as a pyarrow Table.

        Parameters
        ----------
        columns : list of str, optional
            Which columns; all unless given.
        """
        import pyarrow as pa

        wanted = list(COLUMNS) if columns is None else list(columns)
        known_names("the rows", wanted, COLUMNS)
        read = list(dict.fromkeys([*wanted, "key", "status"]))
        tables = list(self._store.tables(read))
        if not tables:
            return schema().empty_table().select(wanted)
        table = pa.concat_tables(tables)
        return table.take(_one_a_key(table)).select(wanted)

    def to_pandas(self) -> pd.DataFrame:
        """Return the rows as a pandas DataFrame, in the order of the grid.

        Rows that are no points of the grid, those of `sweeps.refine`, come last.
        """
        table = self.table()
        places = self._places(table)
        order = sorted(range(len(table)), key=lambda row: places.get(row, len(places) + row))
        frame: pd.DataFrame = table.take(order).to_pandas()
        return frame

    def to_dataset(self) -> xr.Dataset:
        """Return the rows as a Dataset over the axes of the grid.

        Returns
        -------
        Dataset
            One dimension an axis, and first ``point`` if the grid has points. Numbers are NaN and
            ``status`` is "missing" where a run has no row; ``mode`` is "" where it has no mode.
        """
        grid = self.grid
        dims = (("point",) if grid.points else ()) + tuple(grid.axes)
        table = self.table()
        place = self._places(table)
        arrays = {name: _placed(name, table, place, grid.shape) for name in _RESULTS}
        variables = {
            name: (dims, values, {"long_name": MEASURES.get(name, name)})
            for name, values in arrays.items()
        }
        coords: dict[str, Any] = {name: _labels(values) for name, values in grid.axes.items()}
        for name in dict.fromkeys(name for point in grid.points for name in point):
            coords[name] = ("point", _labels([point.get(name) for point in grid.points]))
        return xr.Dataset(variables, coords, {"title": "cellcrawl sweep", "sweep": str(self.path)})

    def rows(self) -> Iterator[dict[str, Any]]:
        """Yield the rows one by one, as plain dicts; memory stays flat."""
        seen: set[str] = set()
        for table in self._store.tables():
            for batch in table.to_batches(_ROWS_AT_A_TIME):
                for row in batch.to_pylist():
                    if row["key"] not in seen:
                        seen.add(row["key"])
                        yield row

    def run(self, **selection: Any) -> xr.Dataset:
        """Return what was kept of one run, as `simulate` would return it.

        Parameters
        ----------
        **selection
            Columns or solver options and their values, enough to tell the run from all others, as
            in ``run(r_on=26, zeta_1=600, seed=1)``.

        Raises
        ------
        InputError
            If nothing was kept, or not exactly one run is meant.
        """
        if self.keep == "rows":
            raise InputError(f"{self.path} keeps rows only: sweep with keep='tracks' or 'fields'")
        known_names("the rows", selection, (*COLUMNS, *OPTIONS))
        wanted = {name: _as_in_a_row(name, value) for name, value in selection.items()}
        own = [name for name in selection if name in COLUMNS]
        names = ["key", "part", "status", "message", "options", *own]
        rows = self.table(list(dict.fromkeys(names))).to_pylist()
        found = [
            row
            for row in rows
            if all(
                row[name] == value if name in row else json.loads(row["options"]).get(name) == value
                for name, value in wanted.items()
            )
        ]
        if len(found) != 1:
            text = ", ".join(f"{name} = {shown(value)}" for name, value in selection.items())
            raise InputError(f"{len(found)} runs match {text or 'no value'}: one is needed")
        if found[0]["part"] is None:
            raise InputError(f"this run has no result: {found[0]['message']}")
        return read_kept(self._store.layout.kept(found[0]["part"]), found[0]["key"])

    def status(self) -> Status:
        """Return how many runs are done, and how they ended."""
        table = self.table(["status", "mode"])
        modes = Counter(mode for mode in table["mode"].to_pylist() if mode is not None)
        statuses = Counter(table["status"].to_pylist())
        runs, done = int(self._manifest["runs"]), len(table)
        if "grids" in self._manifest:
            names = list(described_columns(self.grid.run(0)))
            grids = [Grid.from_dict(found) for found in grids_of(self._manifest)]
            asked = {tuple(described_columns(run).values()) for grid in grids for run in grid}
            rows = self.table(names).to_pylist()
            runs, done = len(asked), len(asked & {tuple(row.values()) for row in rows})
        if "levels" in self._manifest:
            runs = done
        return Status(runs, done, dict(statuses), dict(modes), self._store.is_locked())

    def full_grid_runs(self) -> int | None:
        """Return the runs of the full grid that a refined one stands for; None if it is none."""
        if "levels" not in self._manifest:
            return None
        scale = 1 << int(self._manifest["levels"])
        x, y = self._manifest["refined"]
        runs = len(self.grid)
        for name in (x, y):
            coarse = len(self.grid.axes[name])
            runs = runs // coarse * ((coarse - 1) * scale + 1)
        return runs

    @checked
    def failures(self, most: int = 5) -> dict[str, int]:
        """Return the commonest reasons of runs that did not end as the model allows."""
        table = self.table(["status", "message"])
        reasons = Counter(
            row["message"] for row in table.to_pylist() if row["status"] not in MODEL_ENDINGS
        )
        return dict(reasons.most_common(most))

    def can_be_drawn(self) -> bool:
        """Whether there are rows, and one or two parameters that differ."""
        table = self.table()
        return len(table) > 0 and 1 <= len(varied(table)) <= 2

    def collect(self) -> None:
        """Make rows of what killed workers and drivers left behind."""
        self._store.recover_all("collect", rows_count=self.keep == "rows")

    def __repr__(self) -> str:
        return f"<Sweep {self.path}: {self._manifest['runs']} runs>"

    def _places(self, table: pa.Table) -> dict[int, int]:
        """Return where in the grid each row belongs, by number of the row."""
        names = list(described_columns(self.grid.run(0)))
        row_of = {
            tuple(row.values()): number
            for number, row in enumerate(table.select(names).to_pylist())
        }
        places = {}
        for place, run in enumerate(self.grid):
            number = row_of.get(tuple(described_columns(run).values()))
            if number is not None:
                places[number] = place
        return places


@checked
def open_sweep(path: str | Path, grid: Grid | None = None) -> Sweep:
    """Open the results of a sweep, finished or not.

    Parameters
    ----------
    path : str or Path
        The folder given to `sweep` as ``output``.
    grid : Grid, optional
        Needed only if the grid has starts of a class of your own.

    Raises
    ------
    InputError
        If there is no sweep.
    StorageError
        If it is damaged or was made by a newer version.
    """
    return Sweep(path, grid)


def _as_in_a_row(name: str, value: Any) -> Any:
    """Return a value of a run as the column of that name holds it, or raise `InputError`."""
    if name in ("laws", "surroundings") and value is not None:
        value = value_of(name, value)
    value = plain(plain_number(value))
    if (
        name in ("start", "schedule", "options", "laws", "surroundings")
        and value is not None
        and not isinstance(value, str)
    ):
        try:
            return json.dumps(value)
        except (TypeError, ValueError):
            raise InputError(f"{name} = {shown(value)} is no {name} of a run") from None
    if value is not None and not isinstance(value, (str, int, float)):
        raise InputError(f"{name} = {shown(value)} must be one value: one run is asked for")
    return value


def _one_a_key(table: pa.Table) -> np.ndarray:
    """Return which rows to keep of several with one key: one with a result, if there is."""
    keys, statuses = table["key"].to_pylist(), table["status"].to_pylist()
    kept: dict[str, int] = {}
    for number, (key, status) in enumerate(zip(keys, statuses, strict=True)):
        if key not in kept or (statuses[kept[key]] in NOT_RUN and status not in NOT_RUN):
            kept[key] = number
    return np.array(list(kept.values()), dtype=np.int64)


def _placed(
    name: str, table: pa.Table, places: Mapping[int, int], shape: tuple[int, ...]
) -> np.ndarray:
    values = table[name].to_pylist()
    size = int(np.prod(shape))
    placed: np.ndarray
    if name in ("mode", "status", "message", "key"):
        placed = np.full(size, MISSING if name == "status" else "", dtype=object)
        for number, place in places.items():
            placed[place] = values[number] or ""
        placed = placed.astype(str)
    else:
        placed = np.full(size, np.nan)
        for number, place in places.items():
            placed[place] = np.nan if values[number] is None else values[number]
    return placed.reshape(shape)


def _labels(values: Any) -> np.ndarray:
    """Return coordinates: numbers and words as they are, starts and schedules as text."""
    shown = [plain(value) for value in values]
    if all(isinstance(value, (int, float)) for value in shown):
        return np.array(shown)
    return np.array([value if isinstance(value, str) else str(value) for value in shown])
