"""Running checks, each to its end whatever the others do, in this process or in several."""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed

from cellcrawl.validation import shown, whole_number
from cellcrawl.verification.check import Check, Outcome, Result
from cellcrawl.verification.registry import chosen


def run(
    only: Iterable[str] = (),
    *,
    full: bool = False,
    workers: int = 1,
    checks: Sequence[Check] | None = None,
    report: Callable[[Outcome], None] = lambda outcome: None,
) -> list[Outcome]:
    """Run checks and return what they measured, in the order of the checks.

    Parameters
    ----------
    only : iterable of str
        Names of parts or checks to run; all unless given.
    full : bool
        The long version, with more points, modes and runs.
    workers : int
        Processes to share the checks; with 1 they run in this process. With more, a script that
        calls this needs ``if __name__ == "__main__"``.
    checks : sequence of Check, optional
        The checks to choose from; cellcrawl's own unless given.
    report : callable, optional
        Called with each `Outcome` as it comes.

    Returns
    -------
    list of Outcome
        A check that raises an exception has one failed result that says which.

    Raises
    ------
    InputError
        For an unknown name or a number of workers below 1.
    KeyboardInterrupt
        After Ctrl-C; what was measured until then has been reported.
    """
    whole_number("workers", workers, 1, 1024)
    todo = chosen(only, full, checks)
    done: dict[str, Outcome] = {}
    for outcome in _in_one(todo, full) if workers == 1 else _in_many(todo, full, workers):
        done[outcome.check] = outcome
        report(outcome)
    return [done[check.name] for check in todo]


def measured(check: Check, full: bool) -> Outcome:
    """Run one check, whatever it raises."""
    began = time.monotonic()
    try:
        results = tuple(check.measure(full))
    except Exception as error:
        results = (broken(check, f"{type(error).__name__}: {error}"),)
    if not results:
        results = (broken(check, "it measured nothing"),)
    return Outcome(check.name, check.part, results, time.monotonic() - began)


def broken(check: Check, why: str) -> Result:
    """Return the result of a check that could not be measured."""
    return Result(f"{check.name} can be measured", "results", shown(why).strip("'\""), holds=False)


def _in_one(checks: Sequence[Check], full: bool) -> Iterator[Outcome]:
    for check in checks:
        yield measured(check, full)


def _in_many(checks: Sequence[Check], full: bool, workers: int) -> Iterator[Outcome]:
    # Not forked: threads of the parent (Numba, a progress bar) must not be copied half way.
    context = multiprocessing.get_context("spawn")
    ours = set(multiprocessing.active_children())
    pool = ProcessPoolExecutor(min(workers, max(len(checks), 1)), mp_context=context)
    try:
        futures = {pool.submit(measured, check, full): check for check in checks}
        for future in as_completed(futures):
            yield _outcome(future, futures[future])
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        for child in set(multiprocessing.active_children()) - ours:
            child.terminate()
        raise
    pool.shutdown()


def _outcome(future: Future[Outcome], check: Check) -> Outcome:
    error = future.exception()
    if error is None:
        return future.result()
    why = f"its process ended: {type(error).__name__}: {error}"
    return Outcome(check.name, check.part, (broken(check, why),), 0.0)
