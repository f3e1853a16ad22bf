"""Evolution of small perturbations: an eigenmode stays one, and the model follows."""

from __future__ import annotations

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.linear.eigenmodes import linear_mode

CELL = cc.Parameters(r_on=25, zeta_1=600)
TIMES = np.linspace(0.0, 0.3, 7)


@pytest.mark.parametrize("k", [1, 2, 5, 8, 15, 30])
@pytest.mark.parametrize("branch", [0, 1])
def test_an_eigenmode_grows_at_its_own_rate(k, branch):
    rate = complex(cc.linear.growth_rates(CELL, k)[branch])
    mode = linear_mode(CELL, k, rate)
    radius, bound = cc.linear.evolution(CELL, k, mode.radius, mode.bound_fraction, TIMES)
    np.testing.assert_allclose(radius, mode.radius * np.exp(rate * TIMES), rtol=1e-9)
    np.testing.assert_allclose(
        bound, mode.bound_fraction * np.exp(rate * TIMES), rtol=1e-9, atol=1e-12
    )


def test_evolution_begins_where_it_is_told_and_is_linear():
    one = np.array(cc.linear.evolution(CELL, 4, 1e-4, 0.0, TIMES))
    other = np.array(cc.linear.evolution(CELL, 4, 0.0, 2e-4j, TIMES))
    both = np.array(cc.linear.evolution(CELL, 4, 1e-4, 2e-4j, TIMES))
    np.testing.assert_allclose(both[:, 0], [1e-4, 2e-4j], rtol=1e-12)
    np.testing.assert_allclose(one + other, both, rtol=1e-12)


def test_the_error_of_theory_falls_with_the_amplitude():
    errors = []
    for amplitude in (1e-6, 1e-7):
        start = cc.RandomPerturbation(seed=1, amplitude=amplitude)
        run = cc.simulate(CELL, 0.3, save_every=0.3, start=start, rtol=1e-7)
        measure = cc.observables.fourier_amplitude
        radius, bound = (
            measure(run, name, 2).values[:, 0] for name in ("radius", "bound_fraction")
        )
        _, theory = cc.linear.evolution(CELL, 2, radius[0], bound[0], [0.3])
        errors.append(abs(bound[1] - theory[0]) / abs(theory[0]))
    assert errors[0] < 0.02
    assert errors[1] == pytest.approx(0.1 * errors[0], rel=0.2)


@pytest.mark.parametrize("k", [0, -1, 1.5])
def test_other_wavenumbers_are_refused(k):
    with pytest.raises(cc.InputError, match="k = "):
        cc.linear.evolution(CELL, k, 1e-4, 0.0, TIMES)
