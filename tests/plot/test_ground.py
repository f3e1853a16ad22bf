"""What surrounds a cell lies under it in every picture."""

from __future__ import annotations

import json

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.movies.scene import Scene
from cellcrawl.plot.ground import draw_ground
from tests.runs import straight

SQUARE = [[-1.5, -1.5], [1.5, -1.5], [1.5, 1.5], [-1.5, 1.5]]


def surrounded(*parts, laws=None):
    run = straight(velocity=(0.2, 0.0), nodes=64)
    around = cc.surroundings.Surroundings(parts)
    world = {"surroundings": json.dumps(around.describe())}
    if laws is not None:
        world["laws"] = json.dumps(laws.describe())
    return run.assign_attrs(parameters=json.dumps(cc.Parameters().to_dict()), **world)


def ground_of(axes):
    return [image for image in axes.images if image.get_zorder() < 0]


@pytest.mark.parametrize("draw", [cc.plot.path, cc.plot.cell])
def test_a_bare_ground_is_not_drawn_and_a_pattern_is(draw):
    assert not ground_of(draw(straight(velocity=(0.2, 0.0), nodes=64)))
    assert len(ground_of(draw(surrounded(cc.surroundings.Stripes())))) == 1


def test_stripes_are_shaded_where_they_are():
    run = surrounded(cc.surroundings.Stripes(period=2.0, width=0.5, between=0.0, edge=0.02))
    axes = cc.plot.path(run)
    image = draw_ground(axes, run, np.array([-2.0, -2.0]), np.array([2.0, 2.0]), 400)
    _, _, bottom, top = image.get_extent()
    opacity = image.get_array()[..., 3]
    rows = bottom + (np.arange(len(opacity)) + 0.5) * (top - bottom) / len(opacity)
    on = np.abs((rows + 1.0) % 2.0 - 1.0) < 0.4
    off = np.abs((rows + 1.0) % 2.0 - 1.0) > 0.6
    assert opacity[on].min() > 0.5
    assert opacity[off].max() < 0.05


def test_walls_are_dark_and_outside_a_room():
    run = surrounded(cc.surroundings.Walls(SQUARE, room=True))
    axes = cc.plot.path(run)
    image = draw_ground(axes, run, np.array([-2.0, -2.0]), np.array([2.0, 2.0]), 200)
    opacity = image.get_array()[..., 3]
    middle = opacity[opacity.shape[0] // 2, opacity.shape[1] // 2]
    assert middle == 0.0
    assert opacity[0, 0] == 1.0


@pytest.mark.parametrize("view", ["follow", "path"])
def test_a_movie_shows_the_ground(view):
    run = surrounded(cc.surroundings.Island(radius=1.2), laws=cc.laws.Stiffness(chi=0.5))
    bare = straight(velocity=(0.2, 0.0), nodes=64)
    frames = [
        Scene(one, np.array([0, 5]), "bound_fraction", None, view, (160, 120)).draw(1).copy()
        for one in (bare, run)
    ]
    assert np.abs(frames[0].astype(int) - frames[1]).max() > 20


def test_a_run_whose_surrounding_is_not_here_is_drawn_bare_with_a_warning():
    run = surrounded(cc.surroundings.Stripes())
    told = run.attrs["surroundings"]
    strange = told.replace("cellcrawl.surroundings.patterns", "no_such_module")
    assert strange != told
    with pytest.warns(UserWarning, match="surroundings are not drawn: .*no_such_module"):
        axes = cc.plot.path(run.assign_attrs(surroundings=strange))
    assert not ground_of(axes)
    assert axes.lines
