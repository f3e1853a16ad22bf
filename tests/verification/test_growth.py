"""Growth rates of the nonlinear solvers are those of linear theory."""

from __future__ import annotations

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.bench.cases import LAWS
from cellcrawl.verification import growth
from cellcrawl.verification.engines import frames, started
from cellcrawl.verification.modal import modal_amplitudes

CELL = cc.Parameters(r_on=25, zeta_1=600)


@pytest.fixture(scope="module", params=LAWS)
def law(request: pytest.FixtureRequest) -> cc.Parameters:
    return CELL.replace(elasticity=request.param)


def test_amplitudes_are_those_the_start_was_given():
    start = cc.PerturbedCircle(radius={3: (2e-3, 1e-3)}, bound_fraction={3: (4e-3, -5e-3)})
    (frame,) = frames(started("adaptive", CELL, start, rtol=1e-8), [0.0])
    # Re (a - ib) exp(i k phi) = a cos + b sin
    assert modal_amplitudes(frame, 3, CELL.n_bar) == pytest.approx([2e-3 - 1e-3j, 4e-3 + 5e-3j])
    assert np.abs(modal_amplitudes(frame, 5, CELL.n_bar)).max() < 1e-10


@pytest.mark.parametrize("k", [0, 1, 3, 7, 8, 15, 20])
def test_both_roots_grow_as_the_theory_says(law, k):
    # MODEL.md section 4: k = 0 is -77 (consistent), 4.65 +- 15.5i (printed); k = 8 the first pair
    roots = growth.measured_roots(law, k, rtol=growth.RTOL)
    rates = cc.linear.growth_rates(law, k)
    expected = [rate for rate in rates if growth.SLOWEST < abs(rate) < growth.FASTEST]
    assert [root.theory for root in roots] == expected
    assert len(roots) == (1 if k == 1 or (k == 0 and law.elasticity == "consistent") else 2)
    for root in roots:
        assert root.error < 1e-4
        assert (abs(root.measured.imag) > 1e-3) == (root.theory.imag != 0.0)


def test_the_zero_root_of_k_1_is_a_shift_that_stays():
    before, after = frames(
        started("adaptive", CELL, cc.Eigenmode(1, 1e-4, "-"), rtol=1e-8), [0.0, 0.1]
    )
    assert after.centroid_x == pytest.approx(1e-4, abs=1e-8)
    assert modal_amplitudes(after, 1, CELL.n_bar) == pytest.approx(
        modal_amplitudes(before, 1, CELL.n_bar), abs=1e-8
    )


@pytest.mark.parametrize(
    ("elasticity", "k", "dt"),
    [("printed", 1, 2e-4), ("printed", 12, 2e-4), ("consistent", 1, 1e-4)],
)
def test_the_paper_scheme_converges_to_the_theory_at_first_order(elasticity, k, dt):
    for root in growth.paper_convergence(CELL.replace(elasticity=elasticity), k, dt):
        assert root.change > growth.VISIBLE
        assert root.order == pytest.approx(1.0, abs=0.06)
        assert root.limit_error < 1e-3


def test_the_spline_scheme_grows_as_the_theory_says():
    for k in (1, 3, 10):
        for root in growth.measured_roots(CELL, k, "spline", step=2e-3, nodes=512, dt=2e-3):
            assert root.error < 1e-3


def test_a_model_with_another_diffusivity_is_noticed():
    (root, _) = growth.measured_roots(CELL.replace(D=0.051), 10, rtol=growth.RTOL)
    assert abs(root.measured - cc.linear.growth_rates(CELL, 10)[0]) > 5e-3


@pytest.mark.slow
def test_all_roots_at_all_points_grow_as_the_theory_says():
    results = [*growth.growth_in_adaptive(True), *growth.growth_in_paper(True)]
    assert [result.what for result in results if not result.passed] == []
