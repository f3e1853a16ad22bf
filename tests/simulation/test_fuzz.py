"""Thousands of short runs over the whole range of the parameters, some in every test run."""

from __future__ import annotations

import time

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.data import STATUSES
from cellcrawl.parameters import DESCRIPTIONS, ELASTICITIES
from cellcrawl.simulation.dataset import FIELDS

LONGEST = 120.0  # seconds: a run that takes longer hangs, on any machine


def run_anywhere(seed: int) -> str:
    """Run a cell with every parameter drawn from its whole range; return its status."""
    draw = np.random.default_rng(seed)
    values = {}
    for name, described in DESCRIPTIONS.items():
        low = max(described.low, 1e-3 * described.high)
        on_log_scale = np.exp(draw.uniform(np.log(low), np.log(described.high)))
        values[name] = float(np.clip(on_log_scale, described.low, described.high))
    parameters = cc.Parameters(**values, elasticity=str(draw.choice(ELASTICITIES)))
    start = cc.RandomPerturbation(
        seed=seed, amplitude=float(draw.choice([1e-4, 1e-2])), modes=int(draw.integers(1, 30))
    )
    began = time.monotonic()
    try:
        run = cc.simulate(parameters, float(draw.choice([0.1, 1.0])), start=start, nodes=64)
    except cc.InputError:
        return "refused"
    assert time.monotonic() - began < LONGEST
    assert run.attrs["status"] in STATUSES
    assert all(np.isfinite(run[name]).all() for name in FIELDS)
    return run.attrs["status"]


@pytest.mark.parametrize("block", range(4))
def test_cells_anywhere_end_in_a_named_status(block):
    statuses = [run_anywhere(seed) for seed in range(50 * block, 50 * block + 50)]
    assert "completed" in statuses


@pytest.mark.slow
@pytest.mark.parametrize("block", range(20))
def test_two_thousand_cells_anywhere_end_in_a_named_status(block):
    for seed in range(1000 + 100 * block, 1100 + 100 * block):
        run_anywhere(seed)
