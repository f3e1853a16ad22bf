from __future__ import annotations

import numpy as np
import pytest

import cellcrawl as cc


@pytest.mark.parametrize("nodes", [256, 1024])
def test_small_waves_are_the_circle_that_a_path_makes(nodes):
    p = cc.Parameters(r_on=26, zeta_1=600)
    state = cc.RandomPerturbation(seed=5).state(p, nodes)
    waves = (1e-4 * np.random.default_rng(5).uniform(-1.0, 1.0, (100, 4))).tolist()
    radius = {k: (a, b) for k, (a, b, _, _) in enumerate(waves, start=1)}
    bound = {k: (c, d) for k, (_, _, c, d) in enumerate(waves, start=1)}
    known = cc.PerturbedCircle(radius=radius, bound_fraction=bound).state(p, nodes)
    assert state.curve.length == pytest.approx(known.curve.length, abs=1e-13)
    assert state.curve.origin == pytest.approx(known.curve.origin, abs=1e-14)
    if nodes == 1024:  # which resolve it
        assert state.curve.area == pytest.approx(known.curve.area, abs=1e-13)
    assert np.abs(state.curve.theta - known.curve.theta).max() < 2e-12
    assert np.abs(state.bound_fraction - known.bound_fraction).max() < 1e-15
