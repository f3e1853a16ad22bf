"""The arithmetic of short arrays gives NumPy's own bits."""

from __future__ import annotations

import numpy as np
import pytest

from cellcrawl.observables import short_arrays as short


@pytest.mark.parametrize("size", [3, 7, 8, 30, 129, 1001])
def test_they_are_numpys_to_the_bit(size):
    random = np.random.default_rng(size)
    for scale in (1e-3, 1.0, 1e4):
        rows = scale * random.normal(size=(2, size))
        values = rows[0]
        assert short.mean(values) == np.mean(values)
        assert short.median(values) == np.median(values)
        assert short.peak_to_peak(values) == np.ptp(values)
        assert short.standard_deviation(values) == np.std(values, ddof=1)
        np.testing.assert_array_equal(short.row_means(rows), rows.mean(axis=1, keepdims=True))
        first, last = float(values.min()), float(values.max())
        np.testing.assert_array_equal(
            short.evenly_spaced(first, last, size), np.linspace(first, last, size)
        )
        np.testing.assert_array_equal(
            short.slopes(rows, 0.37), np.gradient(rows, 0.37, axis=1, edge_order=2)
        )


def test_a_turning_angle_is_unwrapped_as_numpy_does():
    random = np.random.default_rng(5)
    for spread in (0.1, 2.0, 5.0):
        angle = random.uniform(-spread, spread, 400)
        np.testing.assert_array_equal(short.unwrapped(angle), np.unwrap(angle))
    half = np.array([0.0, np.pi, 0.0, -np.pi, 2.0 * np.pi])
    np.testing.assert_array_equal(short.unwrapped(half), np.unwrap(half))
