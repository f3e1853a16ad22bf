import math

import numba
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cellcrawl.numerics.exponential import exponential


@numba.njit
def each(values):
    out = np.empty_like(values)
    for i in range(values.size):
        out[i] = exponential(values[i])
    return out


@given(st.lists(st.floats(-700.0, 700.0), min_size=1, max_size=50))
def test_exponential_is_that_of_the_library_to_a_few_roundings(values):
    expected = np.array([math.exp(v) for v in values])
    np.testing.assert_allclose(each(np.array(values)), expected, rtol=5e-16 * 2, atol=0.0)


def test_exponential_is_accurate_all_over_the_range_of_log_r():
    y = np.linspace(-1.0, 12.0, 20_001)
    worst = np.abs(each(y) / np.exp(y) - 1.0).max()
    assert worst < 5e-16


@pytest.mark.parametrize(
    ("x", "expected"),
    [(0.0, 1.0), (-0.0, 1.0), (1e4, math.exp(700.0)), (math.inf, math.exp(700.0))],
)
def test_special_values(x, expected):
    assert each(np.array([x]))[0] == pytest.approx(expected, rel=1e-15)


def test_far_below_it_is_nearly_zero_and_not_a_number_stays():
    assert each(np.array([-math.inf]))[0] < 1e-300
    assert math.isnan(each(np.array([math.nan]))[0])
