"""A choice between laws says how often such a choice is wrong."""

import numpy as np
import pytest

import cellcrawl as cc
from tests.infer.conftest import make_bank, swimmer

UNIT = {"time_unit": (0.8, 1.25, "log")}


@pytest.fixture(scope="module")
def others(tmp_path_factory):
    """Two banks of another law: one whose cells turn, one whose films are the paper's."""
    folder = tmp_path_factory.mktemp("laws")
    turning = make_bank(90, folder / "turning.h5", laws="stiffness", turning=0.25)
    alike = make_bank(90, folder / "alike.h5", laws="stiffness", seed=2)
    return turning, alike


def test_laws_that_look_unlike_are_told_apart(bank, others):
    turning, _ = others
    for turns, name in ((0.0, "Paper"), (0.25, "Stiffness")):
        cell = swimmer(28.0, 1e-3, 5, step=0.5, turning=turns)
        choice = cc.infer.choose(cell, [bank, turning], **UNIT)
        assert choice.likeliest == name
        assert choice.probability.max() > 0.9
        assert choice.error_rate < 0.1
        assert choice.confusion.sum(axis=1) == pytest.approx([1.0, 1.0])


def test_a_choice_between_laws_that_look_alike_is_said_to_be_a_guess(bank, others):
    _, alike = others
    choice = cc.infer.choose(swimmer(28.0, 1e-3, 5, step=0.5), [bank, alike], **UNIT)
    assert 0.3 < choice.error_rate < 0.7
    assert choice.probability.max() < 0.9
    assert "such a choice is wrong for" in choice.summary()
    assert f"{choice.error_rate:.0%} of films" in choice.summary()


@pytest.mark.parametrize("which", ["one bank", "one law twice", "no bank", "two cells"])
def test_a_choice_that_is_none_is_refused(which, bank, others):
    one = swimmer(28.0, 1e-3, 5, step=0.5)
    cells = [one, one] if which == "two cells" else one
    banks = {"one bank": [bank], "one law twice": [bank, bank], "no bank": [bank, 7]}
    with pytest.raises(cc.InputError) as raised:
        cc.infer.choose(cells, banks.get(which, [bank, others[0]]), **UNIT)
    assert "\n" not in str(raised.value)


def test_probabilities_add_up(bank, others):
    choice = cc.infer.choose(swimmer(20.0, 8e-4, 9, step=0.5), [bank, others[0]], **UNIT)
    assert choice.probability.sum() == pytest.approx(1.0)
    assert np.all(choice.probability >= 0.0)
