import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import cellcrawl as cc
from cellcrawl.curve import from_path, from_polar, polygon_area
from cellcrawl.verification.geometry import LIMITS, curve_errors, ellipse, ellipse_length

TURN = 2.0 * math.pi


def circle(radius=1.0, nodes=32, center=(0.0, 0.0)):
    theta = TURN * np.arange(nodes) / nodes + 0.5 * math.pi
    return cc.Curve(theta, TURN * radius, np.add(center, (radius, 0.0)))


modes = st.lists(st.tuples(st.floats(-0.1, 0.1), st.floats(-0.1, 0.1)), min_size=1, max_size=4).map(
    np.array
)


def radius_of(amplitudes):
    k = np.arange(1, len(amplitudes) + 1)

    def radius(angle):
        wave = np.multiply.outer(angle, k)
        return 1.0 + np.cos(wave) @ amplitudes[:, 0] + np.sin(wave) @ amplitudes[:, 1]

    return radius


@st.composite
def smooth_curves(draw, nodes=256):
    amplitudes = draw(modes)
    assume(np.abs(amplitudes).sum() < 0.4)
    return amplitudes, from_polar(radius_of(amplitudes), nodes, samples=1024)


@pytest.mark.parametrize("nodes", [16, 17, 200])
@pytest.mark.parametrize("radius", [1e-6, 1.0, 3.0])
def test_circle_is_exact(nodes, radius):
    curve = circle(radius, nodes, center=(2.0, -1.0))
    assert curve.length == TURN * radius
    assert curve.area == pytest.approx(math.pi * radius**2, rel=1e-13)
    assert curve.circularity == pytest.approx(1.0, rel=1e-13)
    np.testing.assert_allclose(curve.centroid, [2.0, -1.0], atol=1e-13 * max(radius, 1))
    np.testing.assert_allclose(curve.curvature, 1.0 / radius, rtol=1e-12)
    distance = np.hypot(*(curve.points - [2.0, -1.0]).T)
    np.testing.assert_allclose(distance, radius, rtol=0, atol=1e-14 * max(radius, 1) * 4)
    np.testing.assert_allclose(
        curve.points - radius * curve.normals, [[2.0, -1.0]] * nodes, atol=1e-13
    )


def test_ellipse_length_formula_is_right():
    assert ellipse_length(2.0, 1.0) == pytest.approx(9.688448220547676, rel=1e-14)


@pytest.mark.parametrize(("a", "b"), [(1.0, 1.0), (2.0, 1.0), (1.0, 0.4), (3.0, 1.0)])
def test_ellipse_has_its_length_area_centroid_and_curvature(a, b):
    for name, error in curve_errors(a, b).items():
        assert error <= LIMITS[name], name


@settings(max_examples=30)
@given(smooth_curves())
def test_area_and_centroid_of_random_shapes_are_those_of_the_integrals(case):
    amplitudes, curve = case
    angle = TURN * np.arange(64) / 64  # exact for these trigonometric polynomials
    r = radius_of(amplitudes)(angle)
    area = math.pi * (1.0 + 0.5 * np.sum(amplitudes**2))
    center = np.mean(r**3 * np.exp(1j * angle)) * TURN / (3.0 * area)
    assert curve.area == pytest.approx(area, rel=1e-8)
    np.testing.assert_allclose(curve.centroid, [center.real, center.imag], atol=1e-8)


@settings(max_examples=30)
@given(smooth_curves())
def test_polygon_of_the_nodes_approaches_the_curve(case):
    # an inscribed polygon misses kappa L ds^2 / 12 of area, here with |kappa| averaging below 4
    curve = case[1]
    missed = [curve.area - polygon_area(c.points) for c in (curve, curve.resampled(512))]
    assert abs(missed[0]) < curve.length * 4.0 * curve.spacing**2 / 12.0
    assert missed[1] == pytest.approx(missed[0] / 4.0, rel=0.02)


@settings(max_examples=30)
@given(smooth_curves())
def test_nodes_are_equally_spaced_on_the_shape(case):
    amplitudes, curve = case
    angle = np.arctan2(*curve.points.T[::-1])
    np.testing.assert_allclose(
        np.hypot(*curve.points.T), radius_of(amplitudes)(angle), rtol=0, atol=1e-6
    )
    chords = np.hypot(*(np.roll(curve.points, -1, axis=0) - curve.points).T)
    bend = np.abs(curve.curvature).max() * curve.spacing
    assert np.ptp(chords) < curve.spacing * (bend**2 / 12.0 + 1e-9)


@settings(max_examples=30)
@given(smooth_curves(), st.floats(-10, 10), st.floats(-10, 10), st.floats(-4, 4))
def test_centroid_moves_and_turns_with_the_curve(case, x, y, angle):
    curve = case[1]
    moved = curve.moved([x, y])
    np.testing.assert_allclose(moved.centroid, np.add(curve.centroid, (x, y)), atol=1e-12)
    assert moved.area == pytest.approx(curve.area, rel=1e-12)
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, -s], [s, c]])
    turned = cc.Curve(curve.theta + angle, curve.length, turn @ curve.origin)
    np.testing.assert_allclose(turned.centroid, turn @ curve.centroid, atol=1e-12)
    np.testing.assert_allclose(turned.points, curve.points @ turn.T, atol=1e-12)
    assert turned.area == pytest.approx(curve.area, rel=1e-12)


@settings(max_examples=30)
@given(smooth_curves(), modes)
def test_projected_curve_closes(case, amplitudes):
    curve = case[1]
    s = TURN * np.arange(curve.nodes) / curve.nodes
    open_curve = cc.Curve(curve.theta + 0.2 * (radius_of(amplitudes)(s) - 1.0), curve.length)
    assert open_curve.closed().closure_error < 1e-14


@settings(max_examples=30)
@given(smooth_curves())
def test_projection_of_a_closed_curve_changes_nothing(case):
    closed = case[1]
    np.testing.assert_allclose(closed.closed().theta, closed.theta, rtol=0, atol=1e-14)


@settings(max_examples=30)
@given(smooth_curves(), st.sampled_from([255, 300, 512]))
def test_resampling_keeps_the_curve(case, nodes):
    curve = case[1]
    other = curve.resampled(nodes)
    assert other.nodes == nodes
    assert other.area == pytest.approx(curve.area, rel=1e-8)
    np.testing.assert_allclose(other.centroid, curve.centroid, atol=1e-8)
    np.testing.assert_allclose(other.points[0], curve.points[0], rtol=0, atol=0)
    np.testing.assert_allclose(other.resampled(256).theta, curve.theta, rtol=0, atol=1e-6)


def test_refined_curve_passes_through_the_old_nodes():
    curve, _ = ellipse(2.0, 1.0, nodes=128)
    np.testing.assert_allclose(curve.resampled(384).points[::3], curve.points, atol=1e-10)


@settings(max_examples=30)
@given(smooth_curves())
def test_tangent_turns_once(case):
    assert case[1].turning_number == 1


def test_curve_is_immutable_and_keeps_no_reference():
    theta = circle().theta.copy()
    curve = cc.Curve(theta, 1.0)
    theta[0] = 99.0
    assert curve.theta[0] != 99.0
    with pytest.raises(ValueError, match="read-only"):
        curve.theta[0] = 1.0


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ((np.zeros((2, 16)), 1.0), "theta has shape"),
        ((np.zeros(15), 1.0), "nodes = 15"),
        ((np.full(16, np.nan), 1.0), "not finite at index"),
        ((["a"] * 16, 1.0), "array of numbers"),
        ((np.zeros(16, complex), 1.0), "array of numbers"),
        ((np.zeros(16), 0.0), "length = 0"),
        ((np.zeros(16), math.inf), "length = inf"),
        ((np.zeros(16), math.nan), "length = nan"),
        ((np.zeros(16), 1.0, [0.0]), "origin has shape"),
    ],
)
def test_impossible_curves_are_one_line(arguments, says):
    with pytest.raises(cc.InputError, match=says) as error:
        cc.Curve(*arguments)
    assert len(str(error.value).splitlines()) == 1


def test_straight_line_cannot_be_closed():
    with pytest.raises(cc.InputError, match="does not close"):
        cc.Curve(np.full(32, 0.3), 1.0).closed()


@pytest.mark.parametrize(
    ("path", "says"),
    [
        (np.exp(-1j * TURN * np.arange(64) / 64), "turns -1 times"),
        (np.exp(2j * TURN * np.arange(64) / 64), "turns 2 times"),
        (np.zeros(64, complex), "stops or turns back"),
        (np.cos(TURN * np.arange(64) / 64) + 0j, "stops or turns back"),
        (
            np.cos(TURN * np.arange(256) / 256) + 0.5j * np.sin(2 * TURN * np.arange(256) / 256),
            "turns 0 times",
        ),
    ],
)
def test_paths_that_are_no_cell_are_refused(path, says):
    with pytest.raises(cc.InputError, match=says):
        from_path(path, 32)


@pytest.mark.parametrize(
    ("radius", "says"),
    [
        (lambda phi: np.cos(phi), "must be positive"),
        (lambda phi: np.full_like(phi, np.nan), "not finite"),
        (lambda phi: np.ones(3), r"has shape \(3,\)"),
        (lambda phi: np.ones_like(phi) + 0j, "array of numbers"),
        (lambda phi: "1", "array of numbers"),
    ],
)
def test_radii_that_are_no_cell_are_refused(radius, says):
    with pytest.raises(cc.InputError, match=says):
        from_polar(radius, 32)


def test_constant_radius_is_a_circle():
    assert from_polar(lambda phi: 2.0, 32).area == pytest.approx(4.0 * math.pi, rel=1e-13)
