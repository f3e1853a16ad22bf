"""Measures of shape against shapes with known values."""

from __future__ import annotations

import numpy as np

import cellcrawl as cc
from tests.runs import straight


def test_circularity_of_a_circle_is_one():
    measured = cc.observables.circularity(straight())
    np.testing.assert_allclose(measured, 1.0, rtol=1e-12)
    assert measured.dims == ("time",)
    assert measured.attrs["units"] == "1"


def test_circularity_of_a_square_is_a_quarter_of_pi():
    run = straight().copy(deep=True)
    run["area"][:], run["length"][:] = 9.0, 12.0
    np.testing.assert_allclose(cc.observables.circularity(run), 0.25 * np.pi, rtol=1e-12)
