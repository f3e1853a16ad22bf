"""Parameters that go with the motion of the cell and the bend of its edge."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from cellcrawl.bench.cases import check_start
from cellcrawl.linear.theory import base_state
from cellcrawl.observables.motion import centroid_velocity
from cellcrawl.parameters import Parameters
from cellcrawl.simulation import simulate
from cellcrawl.starts import PerturbedCircle
from cellcrawl.surroundings import AlongEdge, Surrounding, TensionGradient
from cellcrawl.verification.check import Result, at_most, near
from cellcrawl.verification.restart import different_values

CELL: Final = Parameters(r_on=26.0, zeta_1=600.0)
_STOPS: Final = 310.71  # by an independent code
# with what the solvers agree at t = 2: their own errors for the cell without surroundings
_SOLVERS: Final = (("adaptive", 1e-4), ("spline", 1e-4), ("paper", 2e-2))


def polarisation_rate(mu: float) -> tuple[float, float]:
    """Growth rate of k = 1 under a tension gradient: of a run, and ``b / a' - q`` of theory.

    ``a' = a + mu (1 + h) epsilon c``: what the motion of the cell adds to the drag.
    """
    start, every = PerturbedCircle(bound_fraction={1: (1e-7, 0.0)}), 0.1
    around = TensionGradient(mu=mu)
    run = simulate(CELL, 4 * every, start=start, rtol=1e-8, surroundings=around, save_every=every)
    size = np.abs(np.fft.fft(run["bound_fraction"].values, axis=1)[:, 1])
    base = base_state(CELL)
    drag = base.a + mu * (1.0 + CELL.h) * CELL.epsilon * base.c
    theory = base.b / drag - (CELL.r_on + CELL.r_p + CELL.D)
    return float(np.log(size[4] / size[2]) / (2.0 * every)), float(theory)


def amiss(mu: float, t_end: float = 1.0, solver: str = "adaptive") -> float:
    """Largest of friction less pull in the records of a run, with the velocity of each record."""
    around = TensionGradient(mu=mu)
    run = simulate(CELL, t_end, start=check_start(CELL), surroundings=around, solver=solver)
    velocity = centroid_velocity(run)
    ahead = (run["x"] - run["centroid_x"]) * velocity.sel(component="x")
    ahead = ahead + (run["y"] - run["centroid_y"]) * velocity.sel(component="y")
    pull = CELL.sigma_c + (run["tension"] + mu * ahead) * (1.0 + CELL.h * run["curvature"])
    return float(np.abs(run["friction"] - pull).max())


def motion(full: bool) -> Iterator[Result]:
    """A membrane whose tension is larger ahead, and parameters that differ along the edge."""
    for mu in (100.0, 400.0):
        found, theory = polarisation_rate(mu)
        yield near(
            f"growth rate of k = 1 over theory, tension gradient mu = {mu:g} at (26, 600)",
            found / theory,
            1.0,
            1e-6,
        )
    yield at_most(
        f"growth rate of k = 1 at mu = {_STOPS}, where polarisation stops",
        abs(polarisation_rate(_STOPS)[0]),
        1e-3,
    )
    start = check_start(CELL)
    base = simulate(CELL, 2.0, start=start)
    still = simulate(CELL, 2.0, start=start, surroundings=TensionGradient())
    yield at_most("bits that mu = 0 changes of a run", different_values(base, still), 0.0)
    yield at_most(
        "friction less pull in the records of a run with mu = 200, over 1000",
        1e-3 * amiss(200.0),
        1e-6,
    )
    parts: tuple[Surrounding, ...] = (
        TensionGradient(mu=200.0),
        AlongEdge("v_p", front=0.05),
        AlongEdge("r_on", front=0.2, slow=0.05, bend=-0.1),
    )
    for part in parts[: 3 if full else 1]:
        true = simulate(CELL, 2.0, start=start, rtol=1e-8, surroundings=part, save_every=1.0)
        for solver, limit in _SOLVERS[: 3 if full else 1]:
            run = simulate(CELL, 2.0, start=start, solver=solver, surroundings=part, save_every=1.0)
            worst = max(
                float(abs(run[name][-1] - true[name][-1]))
                for name in ("length", "centroid_x", "centroid_y")
            )
            yield at_most(f"error of length and place at t = 2, {solver}, {part!r}", worst, limit)
