"""Say once that kernels are being compiled, which only the first run of a law has to wait for."""

from __future__ import annotations

import functools
import time
from collections.abc import Callable
from typing import Any

from cellcrawl.command_line.main import complain

_PATIENCE = 1.0  # seconds of compiling before it is told


@functools.cache
def announce_compilation(then: Callable[[], object] | None = None) -> None:
    """Say so on standard error if this command has to compile for longer than a moment.

    ``then`` is called at that moment.
    """
    from numba.core import event

    class Announcement(event.Listener):
        """Adds up what compilations take; they nest."""

        depth = 0
        began = 0.0
        spent = 0.0
        told = False

        def on_start(self, event: Any) -> None:
            now = time.monotonic()
            if self.depth == 0:
                self.began = now
            self.depth += 1
            if not self.told and self.spent + now - self.began > _PATIENCE:
                self.told = True
                complain("compiling the solver for this machine: a minute, once")
                if then is not None:
                    then()

        def on_end(self, event: Any) -> None:
            self.depth -= 1
            if self.depth == 0:
                self.spent += time.monotonic() - self.began

    event.register("numba:compile", Announcement())  # type: ignore[no-untyped-call]
