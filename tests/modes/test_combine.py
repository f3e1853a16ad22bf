"""The mode of several runs."""

from __future__ import annotations

import pytest

import cellcrawl as cc
from cellcrawl.modes import Classification, Measures, combine


def result(mode: str, confidence: float = 1.0) -> Classification:
    return Classification(mode, confidence, {}, Measures(), "")


def test_runs_that_agree_have_their_mode():
    verdict = combine([result("zigzag", 0.8), result("zigzag", 1.0)])
    assert verdict.mode == verdict.majority == "zigzag"
    assert verdict.confidence == pytest.approx(0.9)
    assert verdict.counts == {"zigzag": 2}


def test_runs_that_disagree_are_mixed_and_most_win():
    verdict = combine([result("gliding"), result("zigzag"), result("zigzag", 0.7)])
    assert verdict.mode == "mixed"
    assert verdict.majority == "zigzag"
    assert verdict.confidence == pytest.approx(1.7 / 3)


def test_torn_cells_are_counted_and_left_out():
    verdict = combine([result("fragmented")] * 3 + [result("gliding")] * 2)
    assert verdict.mode == "gliding"
    assert verdict.confidence == 1.0
    assert verdict.counts == {"gliding": 2, "fragmented": 3}
    assert combine([result("fragmented")]).mode == "fragmented"


def test_of_equally_many_the_surer_wins():
    assert combine([result("gliding", 0.6), result("other", 0.9)]).majority == "other"


def test_no_runs_are_refused():
    with pytest.raises(cc.InputError, match="no runs to combine"):
        combine([])
