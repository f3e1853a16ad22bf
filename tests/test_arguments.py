"""Whatever stands in place of one argument: an answer, or one line that says what is wrong."""

from __future__ import annotations

import inspect

import numpy as np
import pytest
import xarray as xr

import cellcrawl as cc
from cellcrawl.arguments import checked, file_path
from tests.odd_arguments import odd_calls, public_calls


def public_functions():
    """Every public function, by name."""
    for name in cc.__all__:
        member = getattr(cc, name)
        inside = {n: getattr(member, n) for n in getattr(member, "__all__", ())} or {"": member}
        for part, found in inside.items():
            if inspect.isfunction(found):
                yield f"{name}.{part}".rstrip("."), found


@pytest.fixture(scope="module")
def calls(tmp_path_factory):
    folder = tmp_path_factory.mktemp("calls")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)  # odd names of files are relative
        yield public_calls(folder)


def test_every_public_function_is_held_to_its_annotations():
    missing = {
        name for name, function in public_functions() if not hasattr(function, "__checked__")
    }
    assert not missing


def test_every_call_works_as_it_stands(calls):
    for call in calls:
        call.function(**call.arguments())


def test_every_public_function_is_called_with_all_its_arguments(calls):
    given: dict[str, set[str]] = {"edge_series": {"t"}}  # its outlines know their times
    for call in calls:
        for name in (call.name, getattr(call.function, "__qualname__", "")):
            given.setdefault(name.rpartition(".")[2], set()).update(call.arguments())
    for _, function in public_functions():
        asked = {
            argument
            for argument, parameter in inspect.signature(function).parameters.items()
            if parameter.kind not in (parameter.VAR_KEYWORD, parameter.VAR_POSITIONAL)
        }
        assert asked <= given.get(function.__name__, set()), function.__name__


def test_an_odd_argument_is_answered_in_one_line(calls):
    assert odd_calls(calls, seed=10, count=400).raw == {}


@checked
def takes(
    number: float = 0.0,
    whole: int = 0,
    flag: bool = False,
    cell: cc.Parameters | None = None,
    words: list[str] | None = None,
) -> tuple[object, ...]:
    """Return what arrives."""
    return number, whole, flag, cell, words


@pytest.mark.parametrize("box", [np.float32, np.array, xr.DataArray])
def test_numbers_are_taken_out_of_their_boxes(box):
    number, whole, *_ = takes(box(2.0), box(3))
    assert (number, whole) == (2.0, 3)
    assert type(number) is float
    assert type(whole) is int


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"number": "1"}, "number must be a number, not '1'"),
        ({"number": True}, "number must be a number, not True"),
        ({"number": np.nan}, "number = nan is out of range"),
        ({"number": np.zeros(2)}, "number must be a number, not array"),
        ({"whole": 1.5}, "whole = 1.5 is out of range: it must be a whole number"),
        ({"flag": 1}, "flag must be True or False, not 1"),
        ({"flag": np.zeros(2)}, "flag must be True or False"),
        ({"cell": {"r_on": 20}}, "cell must be Parameters, not {'r_on': 20}"),
        ({"words": 1}, "words must be a list, not 1"),
        ({"words": ["a", 1]}, r"words\[1\] must be text, not 1"),
    ],
)
def test_an_argument_of_another_kind_is_named(given, words):
    with pytest.raises(cc.InputError, match=words):
        takes(**given)


def test_a_missing_argument_is_named_by_python():
    with pytest.raises(TypeError, match="unexpected keyword argument 'nmber'"):
        takes(nmber=1.0)


@pytest.mark.parametrize("name", ["", "a\0b", "x" * 5000, 3, b"x", None, "\ud800"])
def test_what_no_file_can_be_called_is_refused_in_a_short_line(name):
    with pytest.raises(cc.InputError) as error:
        file_path("output", name)
    assert len(str(error.value)) < 200
