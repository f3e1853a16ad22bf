"""Numbers of a law set that change in time."""

from __future__ import annotations

import pytest

import cellcrawl as cc
from cellcrawl.laws import Stiffness
from cellcrawl.solvers.conditions import Conditions
from cellcrawl.verification.restart import different_values

CELL = cc.Parameters(r_on=26, zeta_1=600)
SOFTER = cc.Schedule({"laws.chi": [(1.0, 1.0), (3.0, 0.5), (4.0, 0.5), (4.0, 0.8)]})


def test_the_rows_of_a_law_hold_what_the_schedule_says():
    conditions = Conditions(CELL, SOFTER, Stiffness(chi=0.9))
    chi = Stiffness().rows.index("chi")
    for time, value in ((0.0, 1.0), (2.0, 0.75), (3.5, 0.5), (4.0, 0.8), (9.0, 0.8)):
        assert (conditions.edge(time, 3)[chi] == value).all()
    assert conditions.edge(4.0, 1, before=True)[chi, 0] == 0.5
    assert conditions.next_break(1.5) == 3.0
    assert conditions.varies(1.0, 3.0)
    assert not conditions.varies(3.0, 4.0)
    assert conditions.laws_at(2.0) == Stiffness(chi=0.75)
    assert conditions.at(2.0) == CELL


def test_a_schedule_that_holds_a_number_is_the_law_with_that_number():
    run = {"t_end": 0.3, "solver": "adaptive"}
    held = cc.simulate(CELL, laws=Stiffness(chi=0.7), **run)
    scheduled = cc.simulate(
        CELL, laws=Stiffness(), schedule=cc.Schedule({"laws.chi": [(0.0, 0.7)]}), **run
    )
    assert different_values(held, scheduled) == 0


def test_a_schedule_of_a_law_comes_back_from_its_file_form():
    assert cc.Schedule(SOFTER.to_dict()) == SOFTER
    assert SOFTER.law_numbers == ("chi",)


@pytest.mark.parametrize(
    ("laws", "changes", "told"),
    [
        (Stiffness(), {"laws.chii": [(0, 1)]}, "did you mean 'chi'"),
        (Stiffness(), {"laws.chi": [(0, 2)]}, "Stiffness chi = 2.0 is out of range"),
        ("paper", {"laws.chi": [(0, 1)]}, "has no numbers"),
        ("swept-myosin", {"laws.sweep": [(0, 0.0), (5, 3.0)]}, "at t = 5: sweep = 3 must be below"),
    ],
)
def test_what_a_law_cannot_take_is_refused_in_one_line(laws, changes, told):
    with pytest.raises(cc.InputError, match=told) as refused:
        cc.simulate(CELL, 0.1, laws=laws, schedule=cc.Schedule(changes))
    assert "\n" not in str(refused.value)
