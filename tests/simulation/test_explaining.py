"""Laws and surroundings that do not suit a cell are named, at the start or where a run ends."""

from __future__ import annotations

import pytest

import cellcrawl as cc
from cellcrawl.laws import Law, log, sqrt
from cellcrawl.surroundings import Channel, Surrounding, Walls

CELL = cc.Parameters(r_on=26, zeta_1=600)
BAR = [[-3, -0.05], [3, -0.05], [3, 0.05], [-3, 0.05]]
SQUARE = [[-3, -3], [3, -3], [3, 3], [-3, 3]]


class HalfPlane(Surrounding):
    """Nothing but NaN on one side."""

    def change(self, at, p):
        return {"r_on": p.r_on * sqrt(at.x - 0.5)}


class Sink(Surrounding):
    """Diffusion below 0."""

    def change(self, at, p):
        return {"D": p.D - 1.0}


class Border(Surrounding):
    """NaN a little beyond the edge of the start."""

    def change(self, at, p):
        return {"v_p": p.v_p + 0.0 * at.time + sqrt(1.0201 - at.x * at.x - at.y * at.y)}


class Starved(Law):
    """No number where few linkers are bound."""

    def binding(self, phi, r, n, p):
        return p.r_on * (1.0 - n) - r * n + 1e-9 * log(n - 0.3)


class Catching(Law):
    """No unique root where few linkers are bound."""

    def off_rate(self, phi, p):
        return 3000.0 * cc.laws.exp(-2.0 * phi) + 0.1 * cc.laws.exp(phi)


@pytest.mark.parametrize(
    ("part", "told"),
    [
        (HalfPlane(), r"HalfPlane makes r_on = nan at x = 0\.4"),
        (Sink(), r"Sink makes D = -0\.95"),
        (Channel(width=1.0), r"Channel.* cuts through the cell at the start, 0\.5 radii deep"),
        (Walls(BAR), r"Walls.* cuts through the cell at the start, 0\.9"),
        (Walls(SQUARE), r"Walls.* cuts through the cell"),
        (Walls([[0.5, -3], [3, -3], [3, 3], [0.5, 3]], room=True), r"Walls.* cuts through"),
    ],
)
@pytest.mark.parametrize("solver", ["paper", "stochastic"])
def test_surroundings_that_a_start_cannot_be_in_are_named(part, told, solver):
    with pytest.raises(cc.InputError, match=told) as refused:
        cc.simulate(CELL, 0.1, surroundings=part, solver=solver, nodes=64)
    assert "\n" not in str(refused.value)


def test_a_cell_may_be_squeezed_and_a_room_around_it():
    for part in (Channel(width=1.9), Walls(SQUARE, room=True)):
        assert part.conflict(cc.RandomPerturbation().state(CELL, 128).curve.points) is None


@pytest.mark.parametrize(
    ("world", "told"),
    [
        ({"surroundings": Border()}, "Border makes v_p = nan at x = "),
        ({"laws": Starved()}, "binding is not finite where n = 0.3"),
    ],
)
def test_what_ends_a_run_is_named_with_its_place(world, told):
    start = cc.PerturbedCircle(bound_fraction={1: (0.02, 0.0)})
    run = cc.simulate(CELL, 5.0, start=start, solver="paper", nodes=128, **world)
    assert run.attrs["status"] in ("out_of_range", "not_finite")
    assert told in run.attrs["status_message"]
    assert "\n" not in run.attrs["status_message"]


def test_a_balance_without_a_unique_root_is_told():
    with pytest.raises(cc.InputError, match="no unique root"):
        cc.laws.check(Catching(), CELL)
