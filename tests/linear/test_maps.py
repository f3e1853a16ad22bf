"""Growth rates over arrays of parameters, stability maps and marginal curves."""

from __future__ import annotations

import json
import math
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import cellcrawl as cc
from tests.strategies import TABLE, parameters

linear = cc.linear
P = cc.Parameters()
PLANE = {"r_on": np.linspace(5, 70, 60), "zeta_1": np.linspace(400, 640, 50)}
wavenumbers = st.integers(0, 40)


def coefficients(p, k):
    """The quadratic of MODEL.md section 4, divided by its first coefficient."""
    log_r = math.log(p.r_p)
    a = 1 + log_r + p.zeta_1 * p.n_bar / p.r_p
    q = p.r_on + p.r_p + p.D * k**2
    s = p.epsilon * p.h * p.sigma_bar * (k**2 - 1)
    if k == 0:
        s = p.epsilon * (2 * math.pi * (1 + p.h) * p.tension_rate - p.h * p.sigma_bar)
    c = 1 + log_r
    return q + (s * c - p.zeta_1 * p.n_bar * log_r) / a, s * c * q / a


@settings(max_examples=50)
@given(parameters, wavenumbers, st.data())
def test_arrays_of_parameters_give_the_rates_of_single_cells(p, k, data):
    names = data.draw(st.lists(st.sampled_from(list(TABLE)), min_size=2, max_size=2, unique=True))
    first, second = (
        np.array(data.draw(st.lists(st.floats(max(low, 1e-9), high), min_size=1, max_size=3)))
        for _, low, high in (TABLE[name] for name in names)
    )
    rates = linear.growth_rates(p, k, **{names[0]: first[:, None], names[1]: second})
    assert rates.shape == (first.size, second.size, 2)
    for i, x in enumerate(first):
        for j, y in enumerate(second):
            alone = linear.growth_rates(p.replace(**{names[0]: x, names[1]: y}), k)
            close = np.abs(alone[0] - alone[1]) < 1e-5 * np.abs(alone).max()
            slack = (1e-6 if close else 1e-11) * np.abs(alone).max()
            np.testing.assert_allclose(rates[i, j], alone, rtol=0, atol=slack)


def test_wavenumbers_and_parameters_broadcast_together():
    k = np.arange(4)[:, None, None]
    rates = linear.growth_rates(P, k, D=np.array([[0.01], [0.1]]), h=[0.0, 0.01, 0.1])
    assert rates.shape == (4, 2, 3, 2)
    assert np.array_equal(rates[3, 1, 2], linear.growth_rates(P.replace(D=0.1, h=0.1), 3))


def test_a_map_of_500_by_500_takes_well_under_a_second():
    x, y = np.linspace(1, 200, 500)[:, None], np.linspace(0, 2000, 500)
    spent = []
    for _ in range(3):
        begun = time.perf_counter()
        linear.growth_rates(P, 3, r_on=x, zeta_1=y)
        spent.append(time.perf_counter() - begun)
    assert min(spent) < 1.0


@settings(max_examples=200)
@given(parameters, wavenumbers)
def test_routh_hurwitz(p, k):
    # a quadratic with positive coefficients, and only that, has both roots in the left half plane
    damping, restoring = coefficients(p, k)
    rates = linear.growth_rates(p, k)
    size = np.abs(rates).max()
    if k == 1:
        assert restoring == 0.0
        assert np.all(rates.imag == 0.0)
        assert rates.real.max() == pytest.approx(max(-damping, 0.0), abs=1e-9 * (1 + p.zeta_1))
    elif abs(damping) > 1e-9 * size and abs(restoring) > 1e-9 * size**2:
        assert (rates.real.max() < 0.0) == (damping > 0.0 and restoring > 0.0)


@settings(max_examples=100)
@given(parameters, wavenumbers)
def test_oscillation_is_the_triangle_of_theory(p, k):
    # roots are complex where sqrt(a q), sqrt(S c) and sqrt(b) are the sides of a triangle
    damping, restoring = coefficients(p, k)
    rates = linear.growth_rates(p, k)
    if restoring <= 0.0:
        assert np.all(rates.imag == 0.0)
        return
    q = p.r_on + p.r_p + (p.D * k**2 if k else 0.0)
    sides = np.sort(np.sqrt([q, restoring / q, max(q + restoring / q - damping, 0.0)]))
    if abs(sides[2] - sides[0] - sides[1]) > 1e-6 * sides[2]:
        assert (rates[0].imag > 0.0) == (sides[2] < sides[0] + sides[1])


@pytest.mark.parametrize("elasticity", ["printed", "consistent"])
def test_map_holds_the_rates_of_every_point(elasticity):
    p = P.replace(elasticity=elasticity)
    ds = linear.stability_map(p, k=[0, 1, 8], D=[0.01, 0.05, 0.2], r_on=[10, 25, 26, 60])
    assert ds.growth_rate.dims == ds.frequency.dims == ("k", "D", "r_on")
    assert json.loads(ds.attrs["parameters"]) == p.to_dict()
    for k in (0, 1, 8):
        for d in (0.01, 0.05, 0.2):
            for r_on in (10, 25, 26, 60):
                here = {"D": d, "r_on": r_on}
                cell = p.replace(**here)
                rate = linear.growth_rates(cell, k)[0]
                at = ds.sel(k=k, **here)
                assert float(at.growth_rate) == pytest.approx(rate.real, rel=1e-12, abs=1e-12)
                assert float(at.frequency) == pytest.approx(rate.imag, rel=1e-9, abs=1e-9)
                assert float(at.unstable_modes) == linear.unstable_modes(cell).size
                fastest = linear.fastest_mode(cell)
                expected = math.nan if fastest is None else fastest.k
                np.testing.assert_equal(float(at.fastest_mode), expected)


def test_map_reports_the_modes_of_model_md():
    ds = linear.stability_map(P, r_on=[16, 25], zeta_1=[540, 600])
    assert list(ds.k.values) == [1, 2, 5, 10, 15]
    at = ds.sel(r_on=25, zeta_1=600)
    assert float(at.growth_rate.sel(k=1)) == pytest.approx(12.74, abs=0.005)
    assert float(at.unstable_modes) == 16  # 1 to 15, and the breathing mode as printed
    assert float(at.fastest_mode) == 1


@settings(max_examples=60)
@given(parameters)
def test_unstable_modes_are_those_that_grow(p):
    if p.h * p.sigma_bar < 0.0:
        with pytest.raises(cc.InputError, match="negative tension"):
            linear.unstable_modes(p)
        return
    unstable = linear.unstable_modes(p)
    highest = int(unstable.max(initial=0))
    rates = linear.growth_rates(p, np.arange(highest + 50))[:, 0].real
    doubtful = np.abs(rates) < 1e-9 * (1.0 + p.zeta_1)
    grows = rates > 0.0
    counted = np.isin(np.arange(highest + 50), unstable)
    assert np.array_equal(grows[~doubtful], counted[~doubtful])
    fastest = linear.fastest_mode(p)
    if fastest is not None and not doubtful[fastest.k]:
        assert fastest.growth_rate == pytest.approx(rates.max(), rel=1e-12)
        assert fastest.k in (0, 1)  # theory: damping and restoring rise with k


def test_cutoff_is_the_closed_form():
    cutoff = float(linear.cutoff_wavenumber(P))
    assert 15 < cutoff < 16
    assert abs(coefficients(P, cutoff)[0]) < 1e-10
    assert np.isnan(linear.cutoff_wavenumber(P, zeta_1=[0.0, 100.0])).all()
    assert linear.cutoff_wavenumber(P, sigma_c=[1000.0], zeta_1=10.0).tolist() == [math.inf]


@pytest.mark.parametrize("k", [0, 1, 2, 5, 10, 15])
def test_marginal_curves_have_no_growth(k):
    curves = linear.marginal_curves(P, k, r_on=[1, 200], zeta_1=[0, 2000])
    assert len(curves) == 1
    for r_on, zeta_1 in curves[0][::7]:
        rate = linear.growth_rates(P.replace(r_on=r_on, zeta_1=zeta_1), k)
        assert abs(rate[0].real) < 1e-10
        assert rate[0].imag > 0.0 or k == 1  # theory: S c q > 0, so a true Hopf point


def test_marginal_curve_of_translation_is_the_closed_form():
    # lam = b / a - q = 0: zeta_1 n (log r - q / r) = q (1 + log r)
    (curve,) = linear.marginal_curves(P, 1, r_on=[5, 60], zeta_1=[0, 2000])
    r_on, zeta_1 = curve.T
    log_r, q = math.log(P.r_p), r_on + P.r_p + P.D
    n = r_on / (r_on + P.r_p)
    np.testing.assert_allclose(zeta_1, q * (1 + log_r) / (n * (log_r - q / P.r_p)), rtol=1e-12)


@pytest.mark.parametrize(
    ("p", "names"),
    [
        (P, ("r_on", "zeta_1")),
        (P, ("zeta_1", "D")),
        (P.replace(r_on=20), ("sigma_c", "zeta_1")),
        (P, ("r_on", "sigma_c")),
        (P, ("h", "epsilon")),
        (P, ("r_p", "r_on")),
        (P.replace(zeta_1=30), ("sigma_c", "r_p")),
        (P, ("k_sigma", "zeta_1")),
    ],
)
@pytest.mark.parametrize("k", [0, 1, 2, 12])
def test_a_brute_force_map_agrees_with_the_curves(p, names, k):
    x, y = (np.linspace(*TABLE[name][1:], 83) for name in names)
    ds = linear.stability_map(p, k=k, **dict(zip(names, (x, y), strict=True)))
    curves = linear.curves_in(ds, k)
    mid_x, mid_y = 0.5 * (x[1:] + x[:-1]) + 1e-4 * (x[1] - x[0]), 0.5 * (y[1:] + y[:-1])
    grows = np.array(
        [
            [
                linear.growth_rates(p.replace(**{names[0]: u, names[1]: v}), k)[0].real > 0
                for v in mid_y
            ]
            for u in mid_x[::5]
        ]
    )
    for u, column in zip(mid_x[::5], grows, strict=True):
        heights = np.sort(np.concatenate([[], *(_heights(curve, u) for curve in curves)]))
        crossed = np.searchsorted(heights, mid_y)
        changes = np.diff(column.astype(int)) != 0
        # chords of a curve miss it by far less than a step of this grid
        near = np.abs(mid_y[:, None] - heights[None]).min(axis=1, initial=np.inf) < 0.1 * (
            y[1] - y[0]
        )
        sure = ~(near[1:] | near[:-1])
        assert np.array_equal(changes[sure], (np.diff(crossed) % 2 == 1)[sure])


def _heights(curve, u):
    (x0, y0), (x1, y1) = curve[:-1].T, curve[1:].T
    cross = (x0 > u) != (x1 > u)
    return (y0 + (u - x0) / np.where(cross, x1 - x0, 1.0) * (y1 - y0))[cross]


def test_unstable_side_is_on_the_left():
    for names in (("r_on", "zeta_1"), ("zeta_1", "r_on")):
        axes = {name: TABLE[name][1:] for name in names}
        for curve in linear.marginal_curves(P, 5, **axes):
            middle, along = 0.5 * (curve[1:] + curve[:-1]), np.diff(curve, axis=0)
            left = 0.05 * np.column_stack([-along[:, 1], along[:, 0]])[5:-5:20]
            for point, way in zip(middle[5:-5:20] + left, left, strict=True):
                sides = [
                    linear.growth_rates(P.replace(**dict(zip(names, at, strict=True))), 5)[0].real
                    for at in (point, point - 2 * way)
                ]
                assert sides[0] > 0 > sides[1]


def test_curves_do_not_depend_on_the_grid():
    coarse = linear.stability_map(P, r_on=[5, 70], zeta_1=[400, 640])
    fine = linear.stability_map(P, **PLANE)
    for k in (1, 5, 15):
        (rough,), (smooth,) = linear.curves_in(coarse, k), linear.curves_in(fine, k)
        both = np.interp(np.linspace(420, 640, 9)[1:-1], *np.sort(rough.T[::-1], axis=1))
        assert np.isfinite(both).all()
        np.testing.assert_allclose(rough[0], smooth[0], rtol=1e-12)
        np.testing.assert_allclose(rough[-1], smooth[-1], rtol=1e-12)
        np.testing.assert_allclose(
            rough, linear.marginal_curves(P, k, r_on=[5, 70], zeta_1=[400, 640])[0], rtol=0
        )


def test_nothing_grows_without_adhesive_friction():
    ds = linear.stability_map(P, k=range(1, 30), r_on=[1, 25, 200], zeta_1=[0, 1e-6])
    assert np.all(ds.growth_rate <= 0.0)
    assert ds.sizes["vertex"] == 0
    assert np.all(ds.unstable_modes == 0)
    assert np.all(np.isnan(ds.fastest_mode))


@pytest.mark.parametrize(
    ("ranges", "says"),
    [
        ({"r_onn": [1, 2], "zeta_1": [1, 2]}, "did you mean 'r_on'"),
        ({"r_on": [1, 2]}, "two parameters, not 1"),
        ({"r_on": [1, 2], "zeta_1": [1, 2], "D": [0.1, 0.2]}, "not 3"),
        ({"r_on": [1, 300], "zeta_1": [1, 2]}, "r_on = 300 is out of range: .* from 1 to 200"),
        ({"r_on": [2, 1], "zeta_1": [1, 2]}, "r_on must be at least two values, increasing"),
        ({"r_on": 5, "zeta_1": [1, 2]}, "at least two values"),
        ({"r_on": [1, math.nan], "zeta_1": [1, 2]}, "r_on is not finite"),
        ({"r_on": "ab", "zeta_1": [1, 2]}, "r_on must be an array of numbers"),
        ({"elasticity": [1, 2], "zeta_1": [1, 2]}, "no 'elasticity'"),
        ({"k": [1.5], "r_on": [1, 2], "zeta_1": [1, 2]}, "k = 1.5"),
        ({"k": [], "r_on": [1, 2], "zeta_1": [1, 2]}, "k must be"),
        ({"r_on": np.linspace(1, 9, 4000), "zeta_1": np.linspace(1, 9, 4000)}, "too large"),
    ],
)
def test_mistakes_are_one_line(ranges, says):
    with pytest.raises(cc.InputError, match=says) as error:
        linear.stability_map(P, **ranges)
    assert "\n" not in str(error.value)


def test_shapes_that_do_not_broadcast_are_one_line():
    with pytest.raises(cc.InputError, match=r"k \(2,\), r_on \(3,\)"):
        linear.growth_rates(P, [1, 2], r_on=[1, 2, 3])
