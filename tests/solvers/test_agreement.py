"""The paper's scheme and the adaptive solver agree within the sum of their errors."""

from __future__ import annotations

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.bench.cases import LAWS, POINTS
from tests.conftest import check_start

NODES = 1000
RTOL = 1e-4


def answer(p: cc.Parameters, **options) -> np.ndarray:
    """Length, tension and area relative to the resting circle's, and the centroid, at t = 5."""
    run = cc.simulate(p, 5.0, start=check_start(p), save_every=5.0, **options).isel(time=-1)
    scale = {"length": 2 * np.pi, "tension": p.sigma_bar, "area": np.pi}
    relative = [run[name].item() / size for name, size in scale.items()]
    return np.array([*relative, run["centroid_x"].item(), run["centroid_y"].item()])


QUICK = {(*point, "printed") for point in POINTS} | {(26, 600, "consistent")}
CELLS = [
    pytest.param(*cell, marks=() if cell in QUICK else pytest.mark.slow)
    for cell in ((*point, elasticity) for point in POINTS for elasticity in LAWS)
]


@pytest.mark.parametrize(("r_on", "zeta_1", "elasticity"), CELLS)
def test_solvers_agree_within_the_sum_of_their_errors(r_on, zeta_1, elasticity):
    p = cc.Parameters(r_on=r_on, zeta_1=zeta_1, elasticity=elasticity)
    dt = 5e-4 if elasticity == "printed" else 2.5e-4
    paper = {"solver": "paper", "nodes": NODES}
    fine = answer(p, **paper, dt=dt)
    # First order in time: the error is as large as what half the step changes, twice. Second order
    # in space: a third of what half the nodes change.
    in_time = 2.0 * np.abs(fine - answer(p, **paper, dt=0.5 * dt))
    in_space = np.abs(fine - answer(p, solver="paper", nodes=NODES // 2, dt=dt)) / 3.0
    usual = answer(p, rtol=RTOL)
    adaptive = np.abs(usual - answer(p, rtol=1e-2 * RTOL))
    assert np.all(adaptive < 2.0 * RTOL)
    # The estimates leave out the next orders of the paper's scheme's error, hence 1.3.
    assert np.all(np.abs(fine - usual) <= 1.3 * (in_time + in_space + adaptive) + 1e-2 * RTOL)
