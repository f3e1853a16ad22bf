"""The self-crossing check against exact rational arithmetic."""

import math
from fractions import Fraction
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cellcrawl.curve import first_crossing
from cellcrawl.curve.crossing import crossing_edges
from cellcrawl.curve.orientation import orientation

TURN = 2.0 * math.pi


def exact_orientation(a, b, c):
    (ax, ay), (bx, by), (cx, cy) = ([Fraction(float(v)) for v in p] for p in (a, b, c))
    area = (ax - cx) * (by - cy) - (ay - cy) * (bx - cx)
    return (area > 0) - (area < 0)


def exact_touch(a, b, c, d):
    if any(max(a[i], b[i]) < min(c[i], d[i]) or max(c[i], d[i]) < min(a[i], b[i]) for i in (0, 1)):
        return False
    if exact_orientation(a, b, c) * exact_orientation(a, b, d) > 0:
        return False
    return exact_orientation(c, d, a) * exact_orientation(c, d, b) <= 0


def exact_fold(a, b, c):
    (ax, ay), (bx, by), (cx, cy) = ([Fraction(float(v)) for v in p] for p in (a, b, c))
    ahead = (bx - ax) * (cx - bx) + (by - ay) * (cy - by)
    return ahead <= 0 and exact_orientation(a, b, c) == 0


def exact_crossings(points):
    """All pairs of edges that meet, by rational arithmetic on every pair."""
    n = len(points)
    found = set()
    for i, j in combinations(range(n), 2):
        a, b, c, d = points[i], points[(i + 1) % n], points[j], points[(j + 1) % n]
        if j == i + 1:
            met = exact_fold(a, b, d)
        elif i == 0 and j == n - 1:
            met = exact_fold(c, a, b)
        else:
            met = exact_touch(a, b, c, d)
        if met:
            found.add((i, j))
    return found


def crosses(points):
    """The verdict, after making sure that it depends on neither start nor direction."""
    points = np.asarray(points, dtype=float)
    verdicts = {
        first_crossing(np.roll(turned, shift, axis=0)) is None
        for turned in (points, points[::-1])
        for shift in {0, 1, len(points) // 3, len(points) - 1}
    }
    assert len(verdicts) == 1
    return not verdicts.pop()


def rotated(points, angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.asarray(points) @ np.array([[c, s], [-s, c]])


coordinates = st.one_of(
    st.integers(-4, 4).map(float),
    st.floats(-1, 1).map(lambda v: v if abs(v) > 1e-100 else 0.0),
    st.floats(1e-100, 1e100),
)
point = st.tuples(coordinates, coordinates)


@settings(max_examples=300)
@given(point, point, point)
def test_orientation_is_exact(a, b, c):
    assert orientation(*a, *b, *c) == exact_orientation(a, b, c)


@settings(max_examples=300)
@given(
    point,
    point,
    st.sampled_from([0.0, 0.5, 1.0, 1 / 3, -0.1, 7.0]),
    st.integers(-2, 2),
    st.integers(-2, 2),
)
def test_orientation_of_nearly_collinear_points_is_exact(a, b, part, steps_x, steps_y):
    c = [a[i] + part * (b[i] - a[i]) for i in (0, 1)]
    for i, steps in enumerate((steps_x, steps_y)):
        for _ in range(abs(steps)):
            c[i] = float(np.nextafter(c[i], math.copysign(math.inf, steps)))
        if abs(c[i]) < 1e-100:
            c[i] = 0.0
    assert orientation(*a, *b, *c) == exact_orientation(a, b, c)


@given(st.integers(0, 63), st.integers(0, 63))
def test_orientation_is_exact_in_the_grid_where_rounding_fails(i, j):
    # Kettner et al. (2008): with plain arithmetic this grid shows islands of wrong signs
    ulp = 2.0**-53
    c = (0.5 + i * ulp, 0.5 + j * ulp)
    assert orientation(*c, 12.0, 12.0, 24.0, 24.0) == exact_orientation(c, (12, 12), (24, 24))


@settings(max_examples=150)
@given(st.lists(st.tuples(st.integers(0, 5), st.integers(0, 5)), min_size=3, max_size=24))
def test_verdict_on_random_lattice_polygons_is_exact(points):
    xy = np.array(points, dtype=float)
    expected = exact_crossings(xy)
    assert crosses(xy) == bool(expected)
    if expected:
        assert first_crossing(xy).edges in expected


@st.composite
def rings(draw, nodes):
    """Rings of many nodes with a rough radius: some simple, some tangled, over several runs."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    angle = TURN * np.arange(nodes) / nodes
    angle = angle + draw(st.sampled_from([0.0, 1.0, 3.0])) * rng.normal(size=nodes) / nodes
    rough = 1.0 + draw(st.sampled_from([0.0, 0.01, 0.1])) * rng.normal(size=nodes)
    return rough[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])


@settings(max_examples=60)
@given(st.sampled_from([15, 16, 17, 31, 32, 33, 48, 63, 64]).flatmap(rings))
def test_verdict_on_random_rings_is_exact(xy):
    expected = exact_crossings(xy)
    assert crosses(xy) == bool(expected)
    if expected:
        assert first_crossing(xy).edges in expected


def figure_eight(nodes, shift=0.0):
    t = TURN * (np.arange(nodes) + shift) / nodes
    return np.column_stack([np.cos(t), 0.5 * np.sin(2.0 * t)])


@pytest.mark.parametrize("nodes", [9, 16, 17, 40, 64, 101, 500, 2000])
def test_figure_eight_crosses_however_it_lies(nodes):
    for angle in np.linspace(0.0, TURN, 37):
        for shift in (0.0, 0.25, 0.5):
            assert crosses(rotated(figure_eight(nodes, shift), angle))


def test_crossing_of_a_figure_eight_is_found_in_the_middle():
    found = first_crossing(figure_eight(200, shift=0.5))
    assert np.hypot(*found.point) < 1e-12
    assert sorted(found.places) == pytest.approx([49.5, 149.5])


def neck(gap, nodes):
    """Two lobes joined by a neck of width ``gap`` at x = 0; the halves overlap where it is < 0."""
    side = np.linspace(-1.0, 1.0, 2 * nodes + 1)
    bank = 0.5 * gap + 0.3 * np.sin(0.5 * math.pi * side) ** 2 * (1.0 + 0.2 * side)
    end = np.linspace(-0.5 * math.pi, 0.5 * math.pi, nodes)[1:-1]
    right = np.column_stack([1.0 + 0.3 * np.cos(end), bank[-1] * np.sin(end)])
    left = np.column_stack([-1.0 - 0.3 * np.cos(end), -bank[0] * np.sin(end)])
    lower = np.column_stack([side, -bank])
    upper = np.column_stack([side, bank])[::-1]
    return np.concatenate([lower, right, upper, left])


@pytest.mark.parametrize("nodes", [5, 20, 133, 500])
@pytest.mark.parametrize(
    ("gap", "torn"), [(1e-1, False), (1e-3, False), (1e-9, False), (-1e-9, True), (-1e-3, True)]
)
def test_thin_neck_is_whole_until_it_overlaps(nodes, gap, torn):
    for angle in np.linspace(0.0, TURN, 9):
        assert crosses(rotated(neck(gap, nodes), angle)) is torn


def test_neck_of_no_width_touches():
    assert crosses(neck(0.0, 20))


def test_vertex_on_an_edge_touches_and_one_rounding_away_does_not():
    def dented(depth):
        return [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, depth], [0.0, 4.0]]

    assert crosses(dented(0.0))
    assert not crosses(dented(5e-324 * 2**60))
    assert not crosses(dented(1e-16))
    assert crosses(dented(-1e-16))


def test_vertex_on_a_slanted_edge_is_judged_exactly():
    # (1, 1/3) is not on the edge from (0, 0) to (3, 1) in floating point: below or above counts
    for y in (np.nextafter(1 / 3, 0), 1 / 3, np.nextafter(1 / 3, 1)):
        shape = [[0.0, 0.0], [3.0, 1.0], [3.0, 3.0], [1.0, y], [0.0, 3.0]]
        assert crosses(shape) == (Fraction(float(y)) <= Fraction(1, 3))


def test_two_vertices_in_one_place_touch():
    bow = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0], [2.0, 2.0], [1.0, 1.0], [0.0, 2.0]]
    assert crosses(bow)
    bow[4] = [1.0, 1.0 + 2e-16 * 2]
    assert not crosses(bow)


@pytest.mark.parametrize("tilt", [1e-3, 1e-9, 1e-13, 1e-15])
def test_nearly_parallel_edges_are_told_apart(tilt):
    apart = [[-1.0, 0.0], [1.0, 0.0], [1.0, 3 * tilt], [-1.0, tilt]]
    across = [[-1.0, 0.0], [1.0, 0.0], [-1.0, tilt], [1.0, -tilt]]
    for angle in (0.0, 0.5 * math.pi):
        assert not crosses(rotated(apart, angle) if angle == 0.0 else np.fliplr(apart))
        assert crosses(rotated(across, angle) if angle == 0.0 else np.fliplr(across))


def test_overlapping_parallel_edges_meet_where_they_overlap():
    found = first_crossing(
        np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [3.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    )
    assert found is not None
    assert found.point[1] == 0.0
    assert 0.0 <= found.point[0] <= 4.0


def test_middle_of_an_overlap_lies_on_both_edges():
    shape = np.array([[0.0, 0.0], [8.0, 0.0], [8.0, 1.0], [7.0, 0.0], [6.0, 0.0], [5.0, 1.0]])
    found = first_crossing(shape[[3, 4, 5, 0, 1, 2]])
    edges = [shape[[3, 4, 5, 0, 1, 2]][[i, (i + 1) % 6]] for i in found.edges]
    for (ax, ay), (bx, by) in edges:
        assert min(ax, bx) <= found.point[0] <= max(ax, bx)
        assert min(ay, by) <= found.point[1] <= max(ay, by)


def test_edge_folded_back_on_itself_crosses():
    spike = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [2.0, 3.0], [2.0, 1.5], [0.0, 2.0]]
    assert crosses(spike)
    spike[4] = [2.0 - 1e-12, 1.5]
    assert not crosses(spike)


def test_vertex_given_twice_counts_as_touching():
    assert crosses([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0]])


def spiral(turns, width, nodes):
    """A closed band of constant width wound up into a spiral."""
    angle = np.linspace(0.0, TURN * turns, nodes)
    radius = 0.5 + angle / TURN
    outer = (radius + 0.5 * width)[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    inner = (radius - 0.5 * width)[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    return np.concatenate([outer, inner[::-1]])


@pytest.mark.parametrize("width", [1e-6, 0.1, 0.9, 0.999])
def test_spiral_is_simple_as_long_as_its_turns_are_apart(width):
    assert not crosses(spiral(4.0, width, 600))


def test_spiral_wider_than_its_pitch_crosses():
    assert crosses(spiral(4.0, 1.001, 600))


@pytest.mark.parametrize("gap", [0.1, 1e-6, 1e-12])
def test_ring_nearly_closed_on_itself_is_simple(gap):
    angle = np.linspace(0.5 * gap, TURN - 0.5 * gap, 400)
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    assert not crosses(np.concatenate([ring, 0.7 * ring[::-1]]))


def test_comb_with_thin_teeth_is_simple():
    x = np.arange(200) * 0.01
    y = np.where(np.arange(200) % 2, 1.0, 1e-9)
    comb = np.concatenate([np.column_stack([x, y])[::-1], [[0.0, 0.0], [1.99, 0.0]]])
    assert not crosses(comb)
    comb[100, 1] = -1e-9 if comb[100, 1] < 0.5 else comb[100, 1]
    comb[101, 1] = -1e-9 if comb[101, 1] < 0.5 else comb[101, 1]
    assert crosses(comb)


def test_smallest_polygons():
    triangle = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]
    assert not crosses(triangle)
    assert crosses([[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]])
    assert not crosses([*triangle, [-1e-300, 0.5]])
    assert crosses([[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]])


def test_smooth_cell_needs_few_exact_tests():
    # what makes the check cheap enough to run all through a simulation
    angle = TURN * np.arange(4000) / 4000
    radius = 1.0 + 0.3 * np.cos(3 * angle)
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    assert crossing_edges(x, y) == (-1, -1)
