"""The solvers on a manufactured solution of the full system: a circle that travels and breathes."""

from __future__ import annotations

import math

import pytest

from cellcrawl.verification import orders
from cellcrawl.verification.manufactured import errors, solve


def test_paper_scheme_is_of_first_order_in_time():
    for name, order in orders.manufactured_order_in_time().items():
        assert order == pytest.approx(1.0, abs=0.15), name


def test_paper_scheme_is_of_second_order_in_space():
    # Positions on a circle have more: closing the outline takes most of their error away.
    for name, order in orders.manufactured_order_in_space().items():
        assert order > 1.85, name
        assert name in ("x", "y") or order == pytest.approx(2.0, abs=0.15), name


@pytest.mark.parametrize("rtol", [1e-3, 1e-5, 1e-7, 1e-9])
def test_adaptive_solver_meets_its_tolerance_in_every_field(rtol):
    for name, miss in errors(*solve("adaptive", rtol=rtol)).items():
        assert miss < rtol, name


def test_adaptive_error_falls_in_step_with_the_tolerance():
    loose, tight = (errors(*solve("adaptive", rtol=rtol)) for rtol in (1e-3, 1e-7))
    for name in loose:
        slope = math.log(loose[name] / tight[name]) / math.log(1e-3 / 1e-7)
        assert slope == pytest.approx(1.0, abs=0.3), name
