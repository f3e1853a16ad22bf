"""Adaptive diagrams: runs are spent where the mode changes."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.parameters import DESCRIPTIONS
from cellcrawl.sweeps.driver import Sweeping
from cellcrawl.sweeps.grid import Grid, as_grid
from cellcrawl.sweeps.planes import majority, plane
from cellcrawl.sweeps.results import Sweep
from cellcrawl.validation import whole_number

Place = tuple[int, int]


class Cell(NamedTuple):
    """A rectangle of the finest lattice: its lower left corner and its size."""

    i: int
    j: int
    size: int

    @property
    def corners(self) -> tuple[Place, ...]:
        """The four corners."""
        i, j, size = self
        return (i, j), (i + size, j), (i, j + size), (i + size, j + size)

    @property
    def quarters(self) -> tuple[Cell, ...]:
        """The four cells of half the size."""
        half = self.size // 2
        return tuple(Cell(i, j, half) for i, j in Cell(self.i, self.j, half).corners)


@checked
def refine(
    grid: Any,
    output: str | Path = "diagram",
    executor: Any = None,
    *,
    levels: int = 2,
    x: str | None = None,
    y: str | None = None,
    workers: int | None = None,
    keep: str = "rows",
    progress: bool = False,
    **settings: Any,
) -> Sweep:
    """Sweep a coarse grid over two parameters, and finer and finer where the mode changes.

    A cell of the grid whose corners, or runs on its border, do not show the same mode is split in
    four, ``levels`` times. The result has the sharpness of the full grid with ``2**levels`` times
    the points along both axes, for a fraction of its runs.

    Parameters
    ----------
    grid : Grid, mapping, str or Path
        Axes as in `sweep`, among them two parameters of two values or more, which are refined.
        All others, seeds say, are combined with each point.
    output, executor, workers, keep, progress, **settings
        As in `sweep`. All runs are kept in the folder: a second call makes none, and one with more
        levels goes on.
    levels : int
        How often the spacing is halved, 1 to 10.
    x, y : str, optional
        The two parameters; the first two axes of several values unless given.

    Returns
    -------
    Sweep
        ``table()`` has all runs; ``to_dataset()`` those of the coarse grid.

    Raises
    ------
    InputError
        For a grid without two such axes; and as `sweep`.

    Notes
    -----
    A mode that is hidden inside a coarse cell whose four corners agree is not found: begin with a
    grid as fine as the smallest region that matters. A point's mode is that of most of its runs,
    torn cells left out.
    """
    coarse = as_grid(grid, **settings)
    whole_number("levels", levels, 1, 10)
    x, y = _refined_axes(coarse, x, y)
    lattice = Lattice(coarse, x, y, levels)
    with Sweeping(output, coarse, executor, workers, keep, "sweep") as at_work:
        at_work.store.note_refinement((x, y), levels)
        new: set[Place] = {corner for cell in lattice.cells for corner in cell.corners}
        while new and not at_work.interrupted:
            asked = lattice.runs_at(new)
            at_work.make(asked, range(len(asked)), progress)
            if at_work.interrupted:
                break
            lattice.learn(Sweep(at_work.store.folder))
            new = lattice.split()
        at_work.tidy()
    return Sweep(at_work.store.folder, interrupted=at_work.interrupted)


class Lattice:
    """The finest grid over two parameters, of which only some points are run."""

    def __init__(self, grid: Grid, x: str, y: str, levels: int) -> None:
        self._grid = grid
        self._names = (x, y)
        self._scale = 1 << levels
        self._values = tuple(_subdivided(sorted(grid.axes[name]), self._scale) for name in (x, y))
        self._modes: dict[Place, str] = {}
        across, up = (len(values) - 1 for values in self._values)
        self._finest = self._scale
        self.cells = {
            Cell(i, j, self._scale)
            for i in range(0, across, self._scale)
            for j in range(0, up, self._scale)
        }

    def runs_at(self, places: Iterable[Place]) -> Grid:
        """Return the runs at some places."""
        x, y = self._names
        points = [{x: self._values[0][i], y: self._values[1][j]} for i, j in sorted(places)]
        rest = {name: values for name, values in self._grid.axes.items() if name not in (x, y)}
        return self._grid.replace(axes=rest, points=points)

    def learn(self, sweep: Sweep) -> None:
        """Take note of the modes found."""
        columns = [*DESCRIPTIONS, "mode", "status", "confidence"]
        found = plane(sweep.table(columns), *self._names)
        where = [{value: k for k, value in enumerate(values)} for values in self._values]
        modes = majority(found)
        for px, py, mode in zip(found.x.tolist(), found.y.tolist(), modes, strict=True):
            if px in where[0] and py in where[1]:
                self._modes[where[0][px], where[1][py]] = mode

    def split(self) -> set[Place]:
        """Split what is not of one mode, the largest cells first; return the places to run."""
        while True:
            new: set[Place] = set()
            for cell in [cell for cell in self.cells if cell.size > self._finest]:
                if self._is_mixed(cell):
                    self.cells.remove(cell)
                    self.cells.update(cell.quarters)
                    new.update(corner for part in cell.quarters for corner in part.corners)
            new -= self._modes.keys()
            if new or self._finest == 1:
                return new
            self._finest //= 2

    def _is_mixed(self, cell: Cell) -> bool:
        i, j, size = cell
        border = (
            place
            for k in range(0, size + 1, self._finest)
            for place in ((i + k, j), (i + k, j + size), (i, j + k), (i + size, j + k))
        )
        return len({self._modes[place] for place in border if place in self._modes}) > 1


def _refined_axes(grid: Grid, x: str | None, y: str | None) -> tuple[str, str]:
    usable = [n for n, values in grid.axes.items() if n in DESCRIPTIONS and len(values) > 1]
    free = [name for name in usable if name not in (x, y)]
    chosen = [x or (free.pop(0) if free else None), y or (free.pop(0) if free else None)]
    if grid.points or chosen[0] == chosen[1] or not set(chosen) <= set(usable):
        raise InputError(
            "refining needs a grid with two parameters as axes, of two values or more each; this "
            f"one has {grid.summary()}"
        )
    return str(chosen[0]), str(chosen[1])


def _subdivided(values: list[float], parts: int) -> list[float]:
    """Return values with equal steps between neighbours."""
    fine = [values[0]]
    for low, high in itertools.pairwise(values):
        fine += [round(low + (high - low) * k / parts, 12) for k in range(1, parts)]
        fine.append(high)
    return fine
