"""Starts that misbehave, importable by worker processes."""

from __future__ import annotations

import os
import signal
import time
from dataclasses import dataclass
from typing import Any

import cellcrawl as cc


@dataclass(frozen=True)
class Misbehaving:
    """A random start that sleeps, raises an error or kills its process first.

    ``once``: a file whose existence says that it has misbehaved already.
    """

    how: str = ""
    seed: int = 1
    seconds: float = 0.0
    once: str = ""

    def state(self, parameters: cc.Parameters, nodes: int) -> cc.CellState:
        time.sleep(self.seconds)
        if not (self.once and os.path.exists(self.once)):  # noqa: PTH110
            if self.once:
                open(self.once, "w").close()  # noqa: PTH123
            if self.how == "kill":
                os.kill(os.getpid(), signal.SIGKILL)
            if self.how == "raise":
                raise RuntimeError("this start\nis broken")
        return cc.RandomPerturbation(seed=self.seed).state(parameters, nodes)

    def describe(self) -> dict[str, Any]:
        return {"kind": "Misbehaving", "how": self.how, "seed": self.seed}
