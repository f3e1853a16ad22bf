"""Surroundings: what they make of the parameters, alone and together, and what cannot be."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.laws.law import PAPER
from cellcrawl.surroundings import (
    Channel,
    ElectricField,
    Gradient,
    Island,
    Islands,
    LocalPulse,
    Pattern,
    Pillars,
    Place,
    Stripes,
    Surroundings,
    UniformForce,
    Walls,
    as_surroundings,
)
from cellcrawl.surroundings.lookup import image_value, polygon_depth

CELL = cc.Parameters(r_on=26, zeta_1=600)
SQUARE = [[-2, -2], [2, -2], [2, 2], [-2, 2]]
ALL = [
    Stripes(period=1.5, angle=0.3),
    Island(radius=2.0, x=0.5),
    Pattern(np.ones((3, 4)), pixel=0.5),
    Gradient("r_on", x=0.5),
    UniformForce(x=0.1),
    ElectricField(y=2.0),
    Channel(width=2.2),
    Walls(SQUARE, room=True),
    Islands([[0.0, 0.0, 1.0], [1.0, 0.5, 2.0]]),
    Pillars([[3.0, 0.0, 1.0]]),
    LocalPulse(x=1.0, begin=-0.1, duration=0.2, binding=0.5, push=10.0),
]


class Local:
    r_on, v_p, pressure, chi = 26.0, 195.6, 0.0, 1.0


def at(x, y, angle=0.0):
    return Place(x=x, y=y, time=0.0, normal_x=math.cos(angle), normal_y=math.sin(angle))


def test_stripes_hold_where_they_are_and_repeat():
    stripes = Stripes(period=2.0, width=0.5, between=0.1, edge=0.02)
    on, off = (stripes.change(at(7.0, y), Local)["r_on"] / 26.0 for y in (0.0, 1.0))
    assert on == pytest.approx(1.0, abs=1e-6)
    assert off == pytest.approx(0.1, abs=1e-6)
    border = stripes.change(at(0.0, 0.5), Local)["r_on"] / 26.0
    assert border == pytest.approx(0.55, abs=1e-9)
    for y in np.linspace(-1.0, 1.0, 7):
        first, next_one = (stripes.change(at(0.0, y + 2.0 * k), Local)["r_on"] for k in (0, 3))
        assert first == pytest.approx(next_one, rel=1e-12)


@pytest.mark.parametrize("angle", [0.0, 0.4, 2.0])
def test_stripes_turn_with_their_angle(angle):
    plain, turned = Stripes(period=1.3), Stripes(period=1.3, angle=angle)
    c, s = math.cos(angle), math.sin(angle)
    for x, y in ((0.3, 0.2), (-1.0, 0.7)):
        there = at(c * x - s * y, s * x + c * y)
        wanted = plain.change(at(x, y), Local)["r_on"]
        assert turned.change(there, Local)["r_on"] == pytest.approx(wanted, rel=1e-12)


def test_an_island_is_a_disc():
    island = Island(radius=1.5, x=1.0, y=-1.0, outside=0.0, edge=0.05)
    values = [island.change(at(1.0 + r, -1.0), Local)["r_on"] / 26.0 for r in (0.0, 1.5, 3.0)]
    assert values == pytest.approx([1.0, 0.5, 0.0], abs=1e-9)


def test_discs_are_one_ground_where_they_overlap():
    islands = Islands([[0.0, 0.0, 1.0], [1.5, 0.0, 1.0]], outside=0.2, edge=0.05)
    inside, between, outside = (
        islands.change(at(x, 0.0), Local)["r_on"] / 26.0 for x in (0.0, 0.75, 4.0)
    )
    assert (inside, between) == (pytest.approx(1.0), pytest.approx(1.0, abs=1e-4))
    assert outside == pytest.approx(0.2)
    one = Island(radius=1.0, outside=0.2, edge=0.05)
    alone = Islands([[0.0, 0.0, 1.0]], outside=0.2, edge=0.05)
    for x in (0.3, 0.99, 1.0, 1.2):
        same = one.change(at(x, 0.0), Local)["r_on"]
        assert alone.change(at(x, 0.0), Local)["r_on"] == pytest.approx(same, rel=1e-9)


def test_a_pillar_pushes_as_deep_as_the_edge_is_in_it():
    pillars = Pillars([[3.0, 0.0, 1.0], [3.0, 1.0, 1.0]], stiffness=100.0)
    pushed = [pillars.change(at(x, 0.0), Local)["pressure"] for x in (1.0, 2.0, 2.4, 3.0)]
    assert pushed == pytest.approx([0.0, 0.0, 40.0, 100.0])


def test_discs_come_and_go_in_their_time():
    always = Islands([[0.0, 0.0, 1.0]], outside=0.25, edge=0.05)
    timed = Islands([[0.0, 0.0, 1.0, 2.0, 6.0]], outside=0.25, edge=0.05)
    pillar = Pillars([[0.0, 0.0, 1.0, 2.0, 6.0]], stiffness=100.0)

    def seen(ground, time, x):
        place = Place(x=x, y=0.0, time=time, normal_x=1.0, normal_y=0.0)
        return {name: float(value) for name, value in ground.change(place, Local).items()}

    for x in (0.1, 0.98, 3.0):
        for time in (0.0, 2.0, 6.5, 9.0):  # whole ground adhesive, no pillar
            assert seen(timed, time, x)["r_on"] == 26.0
            assert seen(pillar, time, x)["pressure"] == 0.0
        for time in (2.5, 4.0, 6.0):
            assert seen(timed, time, x) == seen(always, time, x)
    assert seen(pillar, 4.0, 0.1)["pressure"] == pytest.approx(90.0)
    times = np.linspace(1.9, 2.6, 701)
    coming = np.array([seen(timed, time, 3.0)["r_on"] for time in times])
    assert np.all(np.diff(coming) <= 0.0)
    assert np.abs(np.diff(coming)).max() < 0.1  # without a jump
    with pytest.raises(cc.InputError, match="4 columns"):
        Islands([[0.0, 0.0, 1.0, 2.0]])


def test_a_pulse_is_nothing_before_and_after_and_at_its_height_what_it_says():
    pulse = LocalPulse(x=1.0, y=0.0, radius=0.5, begin=2.0, duration=1.0, binding=0.25, push=8.0)
    for time, strength in ((1.9, 0.0), (2.0, 0.0), (2.5, 1.0), (3.0, 0.0), (9.0, 0.0)):
        place = Place(x=1.0, y=0.0, time=time, normal_x=1.0, normal_y=0.0)
        found = pulse.change(place, Local)
        assert found["r_on"] == 26.0 * (1.0 - 0.75 * strength)
        assert found["pressure"] == 8.0 * strength
    aside = Place(x=1.5, y=0.0, time=2.5, normal_x=1.0, normal_y=0.0)
    assert pulse.change(aside, Local)["pressure"] == pytest.approx(8.0 / math.e)


def test_fields_and_forces_go_with_the_normal():
    for angle in (0.0, 1.0, 4.0):
        place = at(0.0, 0.0, angle)
        force = UniformForce(x=2.0, y=1.0).change(place, Local)["pressure"]
        assert force == pytest.approx(-(2.0 * math.cos(angle) + math.sin(angle)))
        field = ElectricField(x=2.0, y=1.0).change(place, Local)["v_p"]
        assert field == pytest.approx(195.6 + 2.0 * math.cos(angle) + math.sin(angle))


def test_a_gradient_stops_at_its_least():
    gradient = Gradient("chi", x=-0.5, least=0.2)
    values = [float(gradient.change(at(x, 9.0), Local)["chi"]) for x in (0.0, 1.0, 5.0)]
    assert values == pytest.approx([1.0, 0.5, 0.2])


def test_a_channel_pushes_where_the_edge_is_in_a_wall():
    channel = Channel(width=2.0, stiffness=100.0, angle=math.pi / 2)
    depths = [float(channel.change(at(x, 3.0), Local)["pressure"]) for x in (0.0, 1.0, 1.2, -1.5)]
    assert depths == pytest.approx([0.0, 0.0, 20.0, 50.0], abs=1e-9)


def test_depth_in_a_polygon_is_the_distance_to_its_nearest_wall():
    table = np.array([7.0, 4.0, *np.ravel(SQUARE)])  # the table begins at its second entry
    for x, y, depth in ((0.0, 0.0, 2.0), (1.5, 0.0, 0.5), (3.0, 0.0, -1.0), (5.0, 6.0, -5.0)):
        assert polygon_depth(table, 1.0, x, y) == pytest.approx(depth)


def test_an_image_is_its_pixels_and_cubic_between():
    rng = np.random.default_rng(1)
    pattern = Pattern(rng.random((5, 7)), pixel=0.5, x=1.0, y=-2.0)
    table = pattern.table()
    for row in range(5):
        for column in range(7):
            x, y = 1.0 + 0.5 * (column - 3), -2.0 + 0.5 * (row - 2)
            value = image_value(table, 0.0, x, y)
            assert value == pytest.approx(pattern.image[row, column], abs=1e-12)
    u = np.arange(9.0)
    smooth = Pattern(u[None, :] * np.ones((9, 1)), pixel=1.0)  # a plane, which stays a plane
    assert image_value(smooth.table(), 0.0, 0.3, 0.4) == pytest.approx(4.3, abs=1e-12)


def test_each_sees_what_the_earlier_made():
    together = Surroundings([Gradient("r_on", x=1.0), Stripes(period=2.0, between=0.5, edge=0.02)])
    source = together.compiled(PAPER).source
    assert source.count("local[0, i]") == 1
    other_way = Surroundings(list(reversed(together.parts))).compiled(PAPER)
    assert other_way.digest != together.compiled(PAPER).digest


@pytest.mark.parametrize("part", ALL, ids=lambda part: type(part).__name__)
def test_what_describes_a_surrounding_makes_it_again(part):
    content = json.loads(json.dumps(Surroundings([part]).describe()))
    again = as_surroundings(content)
    assert again == Surroundings([part])
    assert again.compiled(PAPER).key == Surroundings([part]).compiled(PAPER).key


def test_other_numbers_need_no_other_code():
    first, second = (Surroundings([Stripes(period=p)]).compiled(PAPER) for p in (1.0, 2.0))
    assert first.key == second.key
    assert not np.array_equal(first.data, second.data)


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        (lambda: Pattern(np.ones((3, 3))), "size of a pixel"),
        (lambda: Pattern(np.ones(3), pixel=1.0), "image"),
        (lambda: Pattern([[1.0, np.nan], [0.0, 1.0]], pixel=1.0), "image"),
        (lambda: Pattern(-np.ones((2, 2)), pixel=1.0), "below 0"),
        (lambda: Walls([[0, 0], [1, 1]]), "3 or more"),
        (lambda: Stripes(period=0.0), "period"),
        (lambda: Stripes(perid=1.0), "period"),
        (lambda: as_surroundings(3), "cellcrawl.surroundings"),
        (lambda: as_surroundings(["strips"]), "stripes"),
        (lambda: Surroundings([Gradient("chi", x=1.0)]).compiled(PAPER), "'chi'"),
    ],
)
def test_what_cannot_surround_a_cell_is_refused_in_one_line(wrong, told):
    with pytest.raises(cc.InputError, match=told) as refused:
        wrong()
    assert "\n" not in str(refused.value)
