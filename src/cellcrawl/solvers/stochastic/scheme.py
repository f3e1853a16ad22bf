"""The stochastic solver: the paper's grid, second-order steps, and the noise of few bonds."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from cellcrawl.solvers.conditions import Conditions
from cellcrawl.solvers.paper.scheme import PaperSolver
from cellcrawl.solvers.stochastic import step as noisy_step
from cellcrawl.starts.base import CellState
from cellcrawl.validation import real_number, whole_number

_USUAL_NODES = 512
_USUAL_BONDS = 1000.0


class StochasticSolver(PaperSolver):
    """The model with ``sqrt(turnover / bonds) dW`` in the kinetics: bonds come and go one by one.

    ``W`` is white in time and along the edge. Weak order 1 in time, 2 where bonds are many; second
    order in space. Without noise this is a second-order scheme of its own.
    """

    name: ClassVar[str] = "stochastic"
    OPTIONS: ClassVar[dict[str, str]] = {
        "nodes": f"nodes on the edge, 16 to 100000 (default {_USUAL_NODES})",
        "dt": "time step (default 1e-3, or less where shape or tension need it)",
        "bonds": f"sites for bonds on a cell radius of edge, 1 to 1e300 (default {_USUAL_BONDS:g})",
        "noise_seed": "seed of the noise, 0 to 2^63 - 1 (default 1)",
    }

    def __init__(
        self,
        start: CellState | None,
        conditions: Conditions,
        time: float = 0.0,
        *,
        nodes: int = _USUAL_NODES,
        dt: float | None = None,
        bonds: float = _USUAL_BONDS,
        noise_seed: int = 1,
    ) -> None:
        self._bonds = real_number("bonds", bonds, 1.0, 1e300)
        self._seed = whole_number("noise_seed", noise_seed, 0, 2**63 - 1)
        self._tally = np.zeros(noisy_step.TALLY, np.int64)
        self._noisy_work = np.empty((noisy_step.WORK_ROWS, nodes))
        super().__init__(start, conditions, time, nodes=nodes, dt=dt)

    @classmethod
    def checked_nodes(cls, nodes: Any) -> int:
        return _USUAL_NODES if nodes is None else whole_number("nodes", nodes, 16, 100_000)

    def checkpoint(self) -> dict[str, np.ndarray]:
        return {**super().checkpoint(), "tally": self._tally.copy()}

    def restore(self, checkpoint: dict[str, np.ndarray]) -> None:
        super().restore(checkpoint)
        self._tally = np.array(checkpoint["tally"], dtype=np.int64)

    def options(self) -> dict[str, Any]:
        return {**super().options(), "bonds": self._bonds, "noise_seed": self._seed}

    def diagnostics(self) -> dict[str, float]:
        kicks, near, weakened, cut = (int(count) for count in self._tally)
        told = {"kicks": kicks, "kicks_near_0_or_1": near, "kicks_weakened": weakened}
        return {
            **super().diagnostics(),
            "right_hand_sides": 2 * self._steps,
            **told,
            "bound_fractions_cut_off": cut,
        }

    def _linkers_between(self, part: float, before: np.ndarray) -> np.ndarray:
        """Those of the nearer end: a mean of both would vary less than either."""
        return self._fields[1] if part >= 0.5 else before

    def _kernel(self, steps: int, dt: float, rate: float, edge: np.ndarray) -> tuple[int, int, int]:
        theta, n, y = self._fields
        code, node, taken = noisy_step.advance(
            self._laws,
            self._around,
            self.time,
            steps,
            dt,
            rate,
            self._bonds,
            self._seed,
            self._steps,
            edge,
            theta,
            n,
            y,
            self._scalars,
            self._tally,
            self._noisy_work,
        )
        return code, node, taken
