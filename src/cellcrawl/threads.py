"""How many cores there are, and how many threads linear algebra takes: one for small matrices.

For matrices of a few hundred rows the threads of a BLAS wait for each other more than they work:
on two cores a branch then takes seven times the processor time, and no less by the clock.
"""

from __future__ import annotations

import functools
import os
from collections.abc import Callable
from typing import Any, TypeVar, cast

from threadpoolctl import ThreadpoolController

F = TypeVar("F", bound=Callable[..., Any])


@functools.cache
def _controller() -> ThreadpoolController:
    return ThreadpoolController()


def on_one_thread(function: F) -> F:
    """Let linear algebra within a function use one thread."""

    @functools.wraps(function)
    def call(*args: Any, **named: Any) -> Any:
        with _controller().limit(limits=1, user_api="blas"):
            return function(*args, **named)

    return cast(F, call)


def usable_cores() -> int:
    """Return the number of cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
