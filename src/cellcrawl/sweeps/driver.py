"""`sweep`: hand runs to workers chunk by chunk until every run has a row."""

from __future__ import annotations

import concurrent.futures as futures
import contextlib
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from cellcrawl.arguments import checked
from cellcrawl.sweeps import worker
from cellcrawl.sweeps.dispatch import Dispatcher, Todo
from cellcrawl.sweeps.executors import executor_for
from cellcrawl.sweeps.grid import Grid, as_grid
from cellcrawl.sweeps.progress import RunsBar
from cellcrawl.sweeps.results import Sweep
from cellcrawl.sweeps.store import KEEP, SweepStore, new_name
from cellcrawl.sweeps.worker import Execute
from cellcrawl.validation import one_of, whole_number


@checked
def sweep(
    grid: Any,
    output: str | Path = "diagram",
    executor: Any = None,
    *,
    workers: int | None = None,
    keep: str = "rows",
    extend: bool = False,
    retry: bool = False,
    part: tuple[int, int] | None = None,
    progress: bool = False,
    **settings: Any,
) -> Sweep:
    """Make every run of a grid that has no row yet.

    Parameters
    ----------
    grid : Grid, mapping, sequence of mapping, str or Path
        A `Grid`; its axes, as in ``{"r_on": [20, 30], "zeta_1": [500, 600], "seed": [1, 2]}``; a
        list of points; or a TOML file.
    output : str or Path
        Folder of the results. One that is there is gone on with: no run is made twice.
    executor : Executor or str, optional
        Any `concurrent.futures.Executor`, such as that of a Dask client, or the address of a Dask
        scheduler, as ``"tcp://node1:8786"``; worker processes on this machine unless given, or in
        a worker of a `multiprocessing.Pool`, which may start none, that worker itself.
        Workers write to ``output``, so they must see it.
    workers : int, optional
        Number of worker processes; as many as there are cores unless given.
    keep : {"rows", "tracks", "fields"}
        What to keep: one row a run; also the centroid, tension, length and area over time; or also
        all fields, as `simulate` returns them.
    extend : bool
        Add this grid's runs to a folder that holds another grid.
    retry : bool
        Make runs again that raised an error or killed their worker.
    part : (int, int), optional
        ``(i, n)``: make only every n-th run, from run i on. For job arrays, whose tasks share a
        folder.
    progress : bool
        Show a bar with the time left.
    **settings
        Fields of the `Grid` that win over those of ``grid``: ``parameters``, ``t_end``, ``start``,
        ``schedule``, ``save_every``, ``solver``, ``nodes``, ``options``.

    Returns
    -------
    Sweep
        Reads the results: ``table()``, ``to_dataset()``, ``run(...)``. After Ctrl-C its
        ``interrupted`` is true and what was done is kept.

    Raises
    ------
    InputError
        For a grid that cannot be, or a folder of another grid or version.
    StorageError
        If rows cannot be written or a file of rows is damaged.
    CellcrawlError
        If the executor, a scheduler say, is lost. The rows saved stay.

    Notes
    -----
    A run that fails is a row with its reason; one that kills its worker three times too. The bits
    of a run do not depend on the number of workers, and are those of `simulate`.
    """
    asked = as_grid(grid, **settings)
    index, count = part or (0, 1)
    whole_number("part", count, 1)
    whole_number("part", index, 0, count - 1)
    driver = "sweep" if part is None else f"chunk-{index}-of-{count}"
    with Sweeping(output, asked, executor, workers, keep, driver, extend, retry) as at_work:
        at_work.make(asked, range(index, len(asked), count), progress)
        if part is None:
            at_work.tidy()
    return Sweep(at_work.store.folder, interrupted=at_work.interrupted)


class Sweeping:
    """A folder held by one driver, and its workers, started when first needed; a context."""

    def __init__(
        self,
        output: str | Path,
        grid: Grid,
        executor: Any,
        workers: int | None,
        keep: str,
        driver: str,
        extend: bool = False,
        retry: bool = False,
        execute: Execute | None = None,
    ) -> None:
        one_of("keep", keep, KEEP)
        if workers is not None:
            whole_number("workers", workers, 1, 10_000)
        self.store = SweepStore(output)
        self.interrupted = False
        self._keep = keep
        self._driver = driver
        self._retry = retry
        self._execute = execute or worker.execute
        self._given = executor, workers, grid
        self._pool: futures.Executor | None = None
        self._open = contextlib.ExitStack()
        self.store.take(grid, keep, extend=extend)

    def __enter__(self) -> Self:
        with contextlib.ExitStack() as opened:
            opened.enter_context(self.store.locked(self._driver))
            self.store.recover_all(self._driver, rows_count=self._keep == "rows")
            self._open = opened.pop_all()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._open.close()

    def make(self, grid: Grid, which: range, progress: bool) -> None:
        """Make those runs of a grid that have no row yet."""
        todo = Todo(grid, which, self._keep, self.store.finished(retry=self._retry))
        if not todo.left:
            return
        if self._pool is None:
            self._pool = self._open.enter_context(executor_for(*self._given))
        dispatcher = Dispatcher(self.store, self._pool, self._keep, self._driver, self._execute)
        self.interrupted = dispatcher.work(todo, RunsBar(progress, len(which), todo.left))

    def tidy(self) -> None:
        """Put many small files of rows together, once all is done."""
        if not self.interrupted:
            self.store.merge(new_name(self._driver))
