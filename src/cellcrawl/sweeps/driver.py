"""`sweep`: hand runs to workers chunk by chunk until every run has a row."""

from __future__ import annotations

import concurrent.futures as futures
import contextlib
import itertools
import time
from array import array
from collections import Counter, deque
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from cellcrawl.errors import CellcrawlError
from cellcrawl.simulation.description import RunDescription
from cellcrawl.simulation.interruption import Interruption
from cellcrawl.sweeps import worker
from cellcrawl.sweeps.chunking import ChunkSize
from cellcrawl.sweeps.executors import executor_for, means_killed, worker_count
from cellcrawl.sweeps.grid import Grid, as_grid
from cellcrawl.sweeps.identity import run_key
from cellcrawl.sweeps.parts import read_part, write_part
from cellcrawl.sweeps.pool import WorkerPool
from cellcrawl.sweeps.progress import RunsBar
from cellcrawl.sweeps.results import Sweep
from cellcrawl.sweeps.store import KEEP, SweepStore, new_name
from cellcrawl.sweeps.worker import Chunk, Done, Execute
from cellcrawl.validation import one_of, whole_number

_AHEAD = 1  # chunks waiting for each worker
_LOOK = 0.2  # seconds between two looks at Ctrl-C
_PATIENCE = 5.0  # seconds that workers get to finish the present run after Ctrl-C
_BARREN = 3  # breaks of the pool in a row in which no run was begun

Task = tuple[str, RunDescription]


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
        scheduler, as ``"tcp://node1:8786"``; worker processes on this machine unless given.
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
        crew = Crew(self.store, self._pool, self._keep, self._driver, self._execute)
        self.interrupted = crew.work(todo, RunsBar(progress, len(which), todo.left))

    def tidy(self) -> None:
        """Put many small files of rows together, once all is done."""
        if not self.interrupted:
            self.store.merge(new_name(self._driver))


class Todo:
    """The runs without a row, made one at a time."""

    def __init__(self, grid: Grid, mine: range, keep: str, finished: set[str]) -> None:
        self._grid = grid
        self._keep = keep
        missing: range | array[int] = mine
        if finished:
            missing = array("q", (i for i in mine if run_key(grid.run(i), keep) not in finished))
        self.left = len(missing)
        self._missing = iter(missing)

    def take(self, count: int) -> tuple[Task, ...]:
        """Return the next runs, at most ``count``."""
        runs = [self._grid.run(i) for i in itertools.islice(self._missing, count)]
        self.left -= len(runs)
        return tuple((run_key(run, self._keep), run) for run in runs)


class Crew:
    """Workers at work for one driver, and what to do when they die."""

    def __init__(
        self,
        store: SweepStore,
        pool: futures.Executor,
        keep: str,
        driver: str,
        execute: Execute,
    ) -> None:
        self._store = store
        self._pool = pool
        self._keep = keep
        self._driver = driver
        self._execute = execute
        self._halt = new_name(driver)
        self._at_work: dict[futures.Future[Done], Chunk] = {}
        self._returned: deque[Task] = deque()
        self._suspects: deque[Task] = deque()
        self._deaths: Counter[str] = Counter()
        self._barren = 0
        self._size = ChunkSize(worker_count(pool))

    def work(self, todo: Todo, bar: RunsBar) -> bool:
        """Make all runs; return whether it was interrupted."""
        self._bar = bar
        finished = False
        try:
            with Interruption() as interruption, bar:
                while self._hand_out(todo):
                    done, _ = futures.wait(
                        self._at_work, timeout=_LOOK, return_when=futures.FIRST_COMPLETED
                    )
                    self._collect(done)
                    if interruption.requested:
                        self._stop()
                        break
            finished = True
        finally:
            if not finished:
                self._stop(patience=0.0)
        return interruption.requested is not None

    def _hand_out(self, todo: Todo) -> bool:
        """Keep the workers busy; False when all is done."""
        if self._suspects:
            # Alone, so that a death has one cause.
            if not self._at_work:
                self._submit((self._suspects.popleft(),))
            return True
        while len(self._at_work) < (1 + _AHEAD) * self._size.workers:
            left = len(self._returned) + todo.left
            size = self._size.next(left)
            tasks = [self._returned.popleft() for _ in range(min(size, len(self._returned)))]
            tasks += todo.take(size - len(tasks))
            if not tasks:
                break
            self._submit(tuple(tasks))
        return bool(self._at_work)

    def _submit(self, tasks: tuple[Task, ...]) -> None:
        name = new_name(self._driver)
        chunk = Chunk(str(self._store.folder.absolute()), name, tasks, self._keep, self._halt)
        try:
            future = self._pool.submit(worker.run_chunk, chunk, self._execute)
        except futures.BrokenExecutor:  # it broke while we looked away
            future = futures.Future()
            future.set_exception(futures.BrokenExecutor())
        self._at_work[future] = chunk

    def _collect(self, done: set[futures.Future[Done]]) -> None:
        broken = []
        for future in done:
            chunk = self._at_work.pop(future)
            try:
                report = future.result()
            except (Exception, futures.CancelledError) as error:
                if not means_killed(error):
                    self._store.recover(chunk.name, rows_count=self._keep == "rows")
                    raise self._lost(error) from None
                broken.append(chunk)
            else:
                self._count(report)
                self._put_back(chunk.runs[report.runs :])  # a worker that was asked to stop
        if broken:
            self._after_deaths(broken)

    def _count(self, report: Done) -> None:
        self._size.learn(report.runs, report.seconds)
        self._bar.update(report.runs, report.outcomes)
        self._barren = 0

    def _after_deaths(self, broken: list[Chunk]) -> None:
        """Take up what the dead left, suspect the runs they were at, and go on."""
        if isinstance(self._pool, WorkerPool):
            # One death breaks a process pool as a whole.
            futures.wait(self._at_work)
            for future, chunk in list(self._at_work.items()):
                if future.exception() is None:
                    self._count(future.result())
                else:
                    broken.append(chunk)
            self._at_work.clear()
            self._pool.rebuild()
        began = False
        for chunk in broken:
            rows, unfinished = self._store.recover(chunk.name, rows_count=self._keep == "rows")
            began = began or bool(rows or unfinished)
            if rows:
                self._bar.update(rows, {})
            self._sort_out(chunk, unfinished)
        self._barren = 0 if began else self._barren + 1
        if self._barren >= _BARREN:
            raise CellcrawlError(
                "the worker processes die before they begin a run: is there enough memory, and "
                "does your script keep its work under if __name__ == '__main__'?"
            )

    def _sort_out(self, chunk: Chunk, unfinished: dict[str, int]) -> None:
        """Put runs of a dead worker back: suspects apart, and those given up as rows."""
        finished = self._keys_in_part(chunk)
        given_up = []
        for key, run in chunk.runs:
            if key in finished:
                continue
            if key not in unfinished:
                self._returned.append((key, run))
                continue
            self._deaths[key] += unfinished[key]
            if self._deaths[key] < worker.MOST_DEATHS:
                self._suspects.append((key, run))
            else:
                given_up.append(worker.killed_row(key, run, self._deaths[key]))
        if given_up:
            write_part(self._store.layout.part(new_name(self._driver)), given_up)
            self._bar.update(len(given_up), {row["status"]: 1 for row in given_up})

    def _keys_in_part(self, chunk: Chunk) -> set[str]:
        path = self._store.layout.part(chunk.name)
        return set(read_part(path, ("key",))["key"].to_pylist()) if path.exists() else set()

    def _put_back(self, tasks: tuple[Task, ...]) -> None:
        self._returned.extend(tasks)

    def _lost(self, error: BaseException) -> BaseException:
        if isinstance(error, CellcrawlError):
            return error
        reason = " ".join(str(error).split()) or type(error).__name__
        return CellcrawlError(
            f"lost the workers ({type(error).__name__}: {reason[:120]}): the rows saved stay in "
            f"{self._store.folder}, and the same command goes on"
        )

    def _stop(self, patience: float = _PATIENCE) -> None:
        """Ask the workers to stop after their present run; end ours, and take up what is left."""
        halt = self._store.layout.halt(self._halt)
        try:
            halt.touch()
        except OSError:
            patience = 0.0
        for future in self._at_work:
            future.cancel()
        until = time.monotonic() + patience
        running = [future for future in self._at_work if not future.cancelled()]
        futures.wait(running, timeout=max(until - time.monotonic(), 0.0))
        if isinstance(self._pool, WorkerPool):
            self._pool.shutdown(wait=False, cancel_futures=True)
        for future, chunk in self._at_work.items():
            if future.done() and not future.cancelled() and future.exception() is None:
                self._count(future.result())
            elif isinstance(self._pool, WorkerPool):
                self._store.recover(chunk.name, rows_count=self._keep == "rows")
        self._at_work.clear()
        if isinstance(self._pool, WorkerPool):
            halt.unlink(missing_ok=True)
