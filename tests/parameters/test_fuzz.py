"""Whatever a configuration holds: a valid object, or one line that says what is wrong."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import cellcrawl as cc
from cellcrawl.parameters import QUANTITIES

NAMES = {
    cc.Parameters: [*cc.Parameters.field_names()],
    cc.PhysicalParameters: [*QUANTITIES, "elasticity"],
    cc.Scales: [*cc.Scales.field_names()],
}

numbers = st.one_of(
    st.floats(),
    st.integers(),
    st.sampled_from(
        [math.nan, math.inf, -math.inf, -0.0, 5e-324, 1e308, 10**400, -(10**4000), 2**63]
    ),
    st.floats(width=32).map(np.float32),
    st.integers(-(2**31), 2**31 - 1).map(np.int64),
)
anything = st.one_of(
    numbers,
    st.none(),
    st.booleans(),
    st.text(max_size=80),
    st.binary(max_size=5),
    st.complex_numbers(),
    st.lists(numbers, max_size=3),
    st.dictionaries(st.text(max_size=3), numbers, max_size=2),
    st.just(np.zeros((2, 2))),
    st.just(object()),
    st.just(len),
)


def one_line(build):
    """Return what ``build`` makes, None if it raises an InputError of one line."""
    try:
        return build()
    except cc.InputError as error:
        message = str(error)
        assert len(message.splitlines()) == 1
        assert 0 < len(message) < 500
        return None


def complaint(build):
    """Return the message of the InputError that ``build`` raises, None if there is none."""
    try:
        build()
    except cc.InputError as error:
        return str(error)
    return None


@st.composite
def configurations(draw):
    kind = draw(st.sampled_from(sorted(NAMES, key=lambda c: c.__name__)))
    names = st.one_of(st.sampled_from(NAMES[kind]), st.text(max_size=100))
    return kind, draw(st.dictionaries(names, anything, max_size=4))


@settings(max_examples=400)
@given(configurations())
def test_any_table_is_an_object_or_one_line(case):
    kind, table = case
    made = one_line(lambda: kind.from_dict(table))
    if made is None:
        assert table  # the defaults are fine
    else:
        assert all(
            math.isfinite(value) for value in made.to_dict().values() if not isinstance(value, str)
        )
        assert kind.from_toml(made.to_toml()) == made


@given(configurations())
def test_error_names_the_only_wrong_field(case):
    kind, table = case
    for name, value in table.items():
        said = complaint(lambda name=name, value=value: kind.from_dict({name: value}))
        if name in NAMES[kind]:
            assert said is None or name in said
        else:
            assert " has no " in said


@given(anything)
def test_anything_in_place_of_a_table_is_an_object_or_one_line(value):
    for kind in NAMES:
        one_line(lambda kind=kind: kind.from_dict(value))
    one_line(lambda: cc.Schedule(value))


@given(st.text(max_size=60))
def test_any_text_in_place_of_toml_is_an_object_or_one_line(text):
    one_line(lambda: cc.Parameters.from_toml(text))
    one_line(lambda: cc.Parameters.from_toml(text + ".toml"))


points = st.one_of(anything, st.lists(st.tuples(anything, anything), max_size=4))


@given(st.dictionaries(st.one_of(st.sampled_from(["r_on", "D"]), st.text()), points, max_size=3))
def test_any_schedule_is_an_object_or_one_line(changes):
    made = one_line(lambda: cc.Schedule(changes))
    if made is not None:
        for time in (-math.inf, *made.breaks, 0.0, math.inf):
            made.at(cc.Parameters(), time)
            made.before(cc.Parameters(), time)


@pytest.mark.parametrize("start", [cc.PerturbedCircle, cc.RandomPerturbation, cc.Eigenmode])
@given(data=st.data())
def test_any_start_is_an_object_or_one_line(start, data):
    names = list(start.__dataclass_fields__)
    modes = st.dictionaries(anything.filter(lambda k: k.__hash__ is not None), anything, max_size=2)
    values = st.one_of(anything, modes)
    fields = data.draw(st.dictionaries(st.sampled_from(names), values, max_size=3))
    fields.setdefault("k", 2) if start is cc.Eigenmode else None
    made = one_line(lambda: start(**fields))
    if made is not None:
        state = one_line(lambda: made.state(cc.Parameters(), 32))
        assert state is None or np.isfinite(state.curve.points).all()


@given(st.one_of(anything, st.lists(st.lists(st.floats(), min_size=2, max_size=2), max_size=6)))
def test_any_outline_is_an_object_or_one_line(xy):
    made = one_line(lambda: cc.FromOutline(xy))
    if made is not None:
        state = one_line(lambda: made.state(cc.Parameters(), 32))
        assert state is None or np.isfinite(state.curve.points).all()


OUTLINE_OPTIONS = [f.name for f in dataclasses.fields(cc.FromOutline) if f.init][1:]


@given(st.dictionaries(st.sampled_from(OUTLINE_OPTIONS), anything))
def test_any_outline_option_is_an_object_or_one_line(options):
    square = [[0, 0], [1, 0], [1, 1], [0, 1]]
    made = one_line(lambda: cc.FromOutline(square, **options))
    if made is not None:
        one_line(lambda: made.state(cc.Parameters(), 32))
