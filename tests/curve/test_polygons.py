import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import cellcrawl as cc
from cellcrawl.curve import first_crossing, from_polygon, polygon_area, simple_polygon

SQUARE = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
L_SHAPE = np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]])
SHAPES = {"square": (SQUARE, 4.0), "L": (L_SHAPE, 5.0)}


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("nodes", [64, 200, 1001])
def test_curve_has_the_area_of_the_polygon_and_is_simple(shape, nodes):
    xy, area = SHAPES[shape]
    curve = from_polygon(xy, nodes, smoothing=0.01)
    assert curve.area == pytest.approx(area, rel=1e-10)
    assert first_crossing(curve.points) is None
    assert curve.closure_error < 1e-14
    assert curve.turning_number == 1


def test_square_keeps_its_centroid_and_symmetry():
    curve = from_polygon(SQUARE, 800)
    np.testing.assert_allclose(curve.centroid, [1.0, 1.0], atol=1e-5)
    np.testing.assert_allclose(curve.curvature, np.roll(curve.curvature, 200), rtol=0, atol=0.02)


def test_corners_get_the_radius_the_docs_say():
    # a right angle smoothed by a Gaussian of width w in arclength: kappa = a / (w sqrt(2 pi)) along
    # the chord-shortened arc, hence a radius of about 2.5 w / a
    curve = from_polygon(SQUARE, 2000, smoothing=0.01)
    radius = 2.5 * 0.01 * 8.0 / (math.pi / 2)
    assert 1.0 / curve.curvature.max() == pytest.approx(radius, rel=0.5)


def test_less_smoothing_is_nearer_to_the_polygon():
    lengths = [from_polygon(SQUARE, 2000, smoothing=w).length for w in (0.02, 0.01, 0.005)]
    assert lengths[0] < lengths[1] < lengths[2] < 8.0 * 1.01


@pytest.mark.parametrize("shape", SHAPES)
def test_either_way_round_and_any_repeated_vertex_is_the_same_polygon(shape):
    xy, area = SHAPES[shape]
    closed = np.concatenate([xy, xy[:1]])
    repeated = np.repeat(xy, 3, axis=0)
    for other in (closed, repeated):
        np.testing.assert_array_equal(simple_polygon(other), simple_polygon(xy))
    clockwise = simple_polygon(xy[::-1])
    assert polygon_area(clockwise) == pytest.approx(area, rel=1e-14)
    assert polygon_area(xy[::-1]) == pytest.approx(-area, rel=1e-14)
    assert {tuple(p) for p in clockwise} == {tuple(p) for p in xy}


def test_vertices_in_a_straight_line_are_fine_on_the_way():
    dense = np.array([[0, 0], [1, 0], [2, 0], [2, 1], [2, 2], [1, 2], [0, 2], [0, 1]])
    np.testing.assert_allclose(
        from_polygon(dense, 128).points, from_polygon(SQUARE, 128).points, atol=1e-12
    )


@settings(max_examples=20)
@given(st.floats(0.01, 100.0), st.floats(-50.0, 50.0), st.floats(-50.0, 50.0), st.floats(0.0, 6.3))
def test_curve_moves_turns_and_grows_with_the_polygon(size, x, y, angle):
    c, s = math.cos(angle), math.sin(angle)
    turn = size * np.array([[c, -s], [s, c]])
    plain = from_polygon(L_SHAPE, 128)
    other = from_polygon(L_SHAPE @ turn.T + [x, y], 128)
    np.testing.assert_allclose(
        other.points, plain.points @ turn.T + [x, y], atol=1e-9 * (size + 50)
    )


@pytest.mark.parametrize(
    ("xy", "says"),
    [
        ([[0, 0], [1, 1], [1, 0], [0, 1]], "crosses or touches itself"),
        ([[0, 0], [2, 0], [2, 2], [1, 0], [0, 2]], "crosses or touches itself"),  # a grazing vertex
        ([[0, 0], [1, 0], [2, 0]], "crosses or touches itself"),
        ([[0, 0], [1, 1], [2, 2], [3, 3]], "crosses or touches itself"),
        ([[0, 0], [1, 0], [math.nan, 1]], "not finite at index"),
        ([[0, 0], [1, 0], [math.inf, 1]], "not finite at index"),
        ([], "shape"),
        (np.zeros((0, 2)), "0 distinct vertices"),
        ([[0, 0], [1, 0]], "2 distinct vertices"),
        ([[1, 1]] * 5, "0 distinct vertices"),
        ([[0, 0], [1, 0], [1, 0], [0, 0]], "2 distinct vertices"),
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], "shape"),
        ([[0, 0], [1, 0], [0]], "array of numbers"),
        ("square", "array of numbers"),
        (None, "array of numbers"),
        ([["0", "0"], ["1", "0"], ["0", "1"]], "array of numbers"),
        ([[0, 0], [1e200, 0], [0, 1e200]], "give it in a unit"),
        ([[0, 0], [1e-200, 0], [0, 1e-200]], "give it in a unit"),
        ([[0, 0], [1j, 0], [0, 1]], "array of numbers"),
    ],
)
def test_outlines_that_are_no_cell_are_refused_in_one_line(xy, says):
    for refuse in (simple_polygon, cc.FromOutline):
        with pytest.raises(cc.InputError, match=says) as error:
            refuse(xy)
        assert len(str(error.value).splitlines()) == 1


@pytest.mark.parametrize("height", [0.2, 0.05, 1e-2, 1e-4, 1e-8, 1e-11])
def test_thin_outline_is_a_curve_or_one_line(height):
    thin = [[0.0, 0.0], [1.0, 0.0], [1.0, height], [0.0, height]]
    if height > 0.03:
        curve = from_polygon(thin, 256)
        assert curve.area == pytest.approx(height, rel=1e-6)
        assert curve.length == pytest.approx(2.0 * (1.0 + height), rel=0.05)
        return
    with pytest.raises(cc.InputError, match=r"too few|turns back|too sharp") as error:
        from_polygon(thin, 256)
    assert len(str(error.value).splitlines()) == 1


@settings(max_examples=30)
@given(st.lists(st.tuples(st.floats(0.3, 1.0), st.floats(0.2, 1.0)), min_size=5, max_size=12))
def test_any_star_shaped_outline_becomes_a_simple_curve_of_its_area(spokes):
    gaps = np.array([gap for _, gap in spokes])
    angle = 2.0 * math.pi * np.cumsum(gaps) / gaps.sum()
    radius = np.array([r for r, _ in spokes])
    xy = radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    try:
        curve = from_polygon(xy, 256, smoothing=0.02)
    except cc.InputError as error:
        assert any(word in str(error) for word in ("smoothed", "too sharp", "too few"))  # noqa: PT017
        return
    assert curve.area == pytest.approx(polygon_area(xy), rel=1e-6)
    assert first_crossing(curve.points) is None
