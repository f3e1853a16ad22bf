"""Worker processes of our own: started fresh, one thread each, gone when their driver is gone."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from typing import Any, Final

from cellcrawl.sweeps import child

_ONE_THREAD: Final = {
    f"{library}_NUM_THREADS": "1"
    for library in ("OMP", "OPENBLAS", "MKL", "BLIS", "VECLIB_MAXIMUM", "NUMEXPR", "NUMBA")
}


class WorkerPool(Executor):
    """Processes that are spawned, not forked: Numba and threads do not survive a fork.

    Parameters
    ----------
    workers : int
        Number of processes.
    with_main : bool
        Let the workers import the script that was started. Only what is defined there and sent to
        them needs it; without, a script needs no ``if __name__ == "__main__"``.
    """

    def __init__(self, workers: int, *, with_main: bool = False) -> None:
        self.workers = workers
        self._with_main = with_main
        self._pool = self._new()

    def _new(self) -> ProcessPoolExecutor:
        context = multiprocessing.get_context("spawn")
        return ProcessPoolExecutor(self.workers, context, initializer=child.begin)

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Submit a call; a process may be started for it."""
        with _started_as_worker(self._with_main):
            return self._pool.submit(fn, *args, **kwargs)

    def rebuild(self) -> None:
        """Start anew after a worker was killed; the pool breaks as a whole then."""
        self._pool.shutdown(wait=True, cancel_futures=True)
        self._pool = self._new()

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End the processes, at once unless ``wait``."""
        processes = list((getattr(self._pool, "_processes", None) or {}).values())
        self._pool.shutdown(wait=wait, cancel_futures=cancel_futures)
        if not wait:
            for process in processes:
                process.terminate()
            for process in processes:
                process.join()


@contextlib.contextmanager
def _started_as_worker(with_main: bool) -> Iterator[None]:
    """Set what a process inherits at its start, and set it back."""
    added = {name: value for name, value in _ONE_THREAD.items() if name not in os.environ}
    main = sys.modules["__main__"]
    spec, file = getattr(main, "__spec__", None), getattr(main, "__file__", None)
    os.environ.update(added)
    try:
        if not with_main:
            main.__spec__ = None
            if file is not None:
                del main.__file__
        yield
    finally:
        for name in added:
            os.environ.pop(name, None)
        main.__spec__ = spec
        if file is not None:
            main.__file__ = file
