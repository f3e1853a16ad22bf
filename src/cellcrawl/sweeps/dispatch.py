"""Workers at work for one driver: handing out runs, and what to do when workers die."""

from __future__ import annotations

import concurrent.futures as futures
import itertools
import math
import time
from array import array
from collections import Counter, deque

from cellcrawl.errors import CellcrawlError
from cellcrawl.simulation.description import RunDescription
from cellcrawl.simulation.interruption import Interruption
from cellcrawl.sweeps import worker
from cellcrawl.sweeps.chunking import ChunkSize
from cellcrawl.sweeps.executors import means_killed, worker_count
from cellcrawl.sweeps.grid import Grid
from cellcrawl.sweeps.identity import run_key
from cellcrawl.sweeps.parts import find_part, read_part, write_part
from cellcrawl.sweeps.pool import WorkerPool
from cellcrawl.sweeps.progress import RunsBar
from cellcrawl.sweeps.store import SweepStore, new_name
from cellcrawl.sweeps.worker import Chunk, Done, Execute

_AHEAD = 1  # chunks waiting for each worker
_LOOK = 0.2  # seconds between two looks at Ctrl-C
_RECOUNT = 2.0  # seconds between two looks at how many workers there are
_PATIENCE = 5.0  # seconds that workers get to finish the present run after Ctrl-C
_BARREN = 3  # breaks of the pool in a row in which no run was begun

Task = tuple[str, RunDescription]


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


class Dispatcher:
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
        self._size = ChunkSize(1)
        self._counted = -math.inf

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
        self._count_workers()
        while len(self._at_work) < (1 + _AHEAD) * self._size.workers:
            left = len(self._returned) + todo.left
            size = self._size.next(left)
            tasks = [self._returned.popleft() for _ in range(min(size, len(self._returned)))]
            tasks += todo.take(size - len(tasks))
            if not tasks:
                break
            self._submit(tuple(tasks))
        return bool(self._at_work)

    def _count_workers(self) -> None:
        """Notice workers that come and go, as those of a cluster do."""
        if time.monotonic() - self._counted > _RECOUNT:
            self._size.workers = worker_count(self._pool)
            self._counted = time.monotonic()

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
        path = find_part(self._store.layout.part(chunk.name))
        return set() if path is None else set(read_part(path, ("key",))["key"].to_pylist())

    def _put_back(self, tasks: tuple[Task, ...]) -> None:
        self._returned.extend(tasks)

    def _lost(self, error: BaseException) -> BaseException:
        if isinstance(error, CellcrawlError):
            return error
        reason = " ".join(str(error).split())[:120]
        kind = type(error).__name__
        return CellcrawlError(
            f"lost the workers ({kind}{f': {reason}' if reason else ''}; is the scheduler gone?): "
            f"the rows saved stay in {self._store.folder}, and the same command goes on"
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
