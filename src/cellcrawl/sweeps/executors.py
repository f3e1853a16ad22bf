"""Where runs may be sent: our own processes, any executor, a Dask cluster."""

from __future__ import annotations

import contextlib
import importlib.util
import logging
import multiprocessing
import pickle
import re
import sys
from collections.abc import Iterator
from concurrent.futures import BrokenExecutor, Executor, Future
from pathlib import Path
from typing import Any

from cellcrawl.errors import InputError, MissingExtraError
from cellcrawl.sweeps.grid import Grid
from cellcrawl.sweeps.pool import WorkerPool
from cellcrawl.threads import usable_cores
from cellcrawl.validation import shown

_CONNECT = "10s"


class InProcess(Executor):
    """Makes each run at once, in this very process: for debugging and profiling."""

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Call, and return a future that is done."""
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


@contextlib.contextmanager
def executor_for(given: Any, workers: int | None, grid: Grid) -> Iterator[Executor]:
    """Give an executor for what the user gave; one made here is closed at the end.

    Raises
    ------
    InputError
        For something that is no executor, or a scheduler that does not answer.
    """
    if given is None and multiprocessing.current_process().daemon:
        yield InProcess()  # a worker of a multiprocessing.Pool may start no processes of its own
        return
    if given is None:
        _see_that_workers_know(grid)
        pool = WorkerPool(workers or usable_cores(), with_main=_needs_main(grid))
        try:
            yield pool
        finally:
            pool.shutdown(wait=False, cancel_futures=True)
        return
    if isinstance(given, str):
        with _dask(given) as client:
            yield client.get_executor()
        return
    if hasattr(given, "get_executor"):
        yield given.get_executor()
        return
    if not callable(getattr(given, "submit", None)):
        raise InputError(
            f"executor must be a concurrent.futures.Executor or the address of a Dask scheduler, "
            f"not {shown(given)}"
        )
    yield given


def worker_count(executor: Executor) -> int:
    """Return how many calls an executor makes at the same time, as far as it says."""
    if isinstance(executor, InProcess):
        return 1
    if isinstance(executor, WorkerPool):
        return executor.workers
    client = getattr(executor, "_client", None)
    if client is not None:
        return sum(client.nthreads().values()) or 1
    return int(getattr(executor, "_max_workers", 0)) or usable_cores()


def means_killed(error: BaseException) -> bool:
    """Whether an error says that a worker died, and not that the executor is lost."""
    return isinstance(error, BrokenExecutor) or type(error).__name__ == "KilledWorker"


@contextlib.contextmanager
def _dask(address: str) -> Iterator[Any]:
    if not re.fullmatch(r"(\w+://)?[^\s/]+(:\d+)?(/\S*)?", address) or ":" not in address:
        raise InputError(
            f"executor = {shown(address)} is no address of a Dask scheduler, as tcp://node1:8786"
        )
    try:
        import distributed
    except ImportError:
        raise MissingExtraError(
            "a Dask scheduler needs distributed: pip install 'cellcrawl[dask]'"
        ) from None
    try:
        connect: Any = distributed.Client
        client = connect(address, timeout=_CONNECT, set_as_default=False)
    except (OSError, TimeoutError, ValueError) as error:
        reason = type(error).__name__
        raise InputError(
            f"no Dask scheduler answers at {address} ({reason}): start one with `dask scheduler`, "
            "or leave it out to use this machine"
        ) from None
    _silence_dask()
    with client:
        yield client


def _silence_dask() -> None:
    """Leave it to us to say, in one line, that a scheduler is lost."""
    for name in list(logging.root.manager.loggerDict):
        if name.partition(".")[0] == "distributed":
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)


def _see_that_workers_know(grid: Grid) -> None:
    """Refuse a start or a law of a class that is defined where no new process finds it."""
    script = getattr(sys.modules["__main__"], "__file__", None)
    if (_needs_main(grid) and (script is None or not Path(script).is_file())) or not all(
        map(_can_be_sent, _of_users(grid))
    ):
        raise InputError(
            "a start, law or surrounding is of a class that is defined in this notebook, session "
            "or function, where worker processes cannot find it: put the class in a file of its "
            "own and import it, "
            "or give executor=concurrent.futures.ThreadPoolExecutor(1)"
        )


def _needs_main(grid: Grid) -> bool:
    """Whether something in the grid is of a class that the user's script defines."""
    return any(type(one).__module__ == "__main__" for one in _of_users(grid))


def _of_users(grid: Grid) -> list[Any]:
    """Return what in a grid may be of a class of the user's: starts, laws, surroundings."""
    found: list[Any] = []
    for name in ("start", "laws", "surroundings"):
        found += [getattr(grid, name), *grid.axes.get(name, ())]
        found += [point[name] for point in grid.points if name in point]
    return [part for one in found if one is not None for part in getattr(one, "parts", (one,))]


def _can_be_sent(one: Any) -> bool:
    """Whether a process that knows our path of modules can make something from its pickle."""
    home = type(one).__module__
    try:
        pickle.dumps(one)
        return home == "__main__" or importlib.util.find_spec(home) is not None
    except Exception:  # a class within a function, a module without a file
        return False
