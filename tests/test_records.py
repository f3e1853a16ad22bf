"""Results that hold NaN are equal to themselves, on every Python."""

from __future__ import annotations

import copy
import pickle

import numpy as np

import cellcrawl as cc
from tests.runs import straight


def fresh(value):
    """Return a copy whose NaN is another object."""
    return pickle.loads(pickle.dumps(copy.deepcopy(value)))


def test_classifications_are_equal_to_themselves():
    found = cc.classify(straight(records=40))
    assert np.isnan(found.measures.period)
    assert found == fresh(found)
    assert hash(found) == hash(fresh(found))
    assert found != cc.classify(straight((0.3, 0.1), records=40))
    assert found != "gliding"


def test_oscillations_are_equal_to_themselves():
    found = cc.observables.oscillation(np.arange(20.0), np.ones(20))
    assert np.isnan(found.period)
    assert found == fresh(found)
    assert found != cc.observables.oscillation(np.arange(20.0), np.sin(np.arange(20.0)))
