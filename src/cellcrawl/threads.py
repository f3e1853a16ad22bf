"""How many threads linear algebra takes: one where matrices are small.

For matrices of a few hundred rows the threads of a BLAS wait for each other more than they work:
on two cores a branch then takes seven times the processor time, and no less by the clock.
"""

from __future__ import annotations

import functools
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
