"""Fourier amplitudes about the resting circle, against starts whose amplitudes are given."""

from __future__ import annotations

import numpy as np
import pytest

import cellcrawl as cc
from tests.runs import circle_on_track, straight

SHAPE = {1: (2e-3, -1e-3), 3: (1e-3, 2e-3)}
BOUND = {2: (4e-3, -5e-3), 7: (0.0, 1e-2)}


@pytest.fixture(scope="module")
def first_record():
    start = cc.PerturbedCircle(radius=SHAPE, bound_fraction=BOUND)
    return cc.simulate(cc.Parameters(), 0.0, start=start)


def test_amplitudes_of_a_perturbed_circle_are_those_given(first_record):
    for field, given in (("radius", SHAPE), ("bound_fraction", BOUND)):
        waves = np.arange(1, 12)
        found = cc.observables.fourier_amplitude(first_record, field, waves)
        assert found.dims == ("time", "k")
        wanted = [complex(*given.get(int(k), (0.0, 0.0))).conjugate() for k in waves]
        np.testing.assert_allclose(found.values[0], wanted, rtol=1e-6, atol=1e-9)


def test_a_shift_of_the_circle_is_its_first_wave():
    run = circle_on_track(np.array([0.0]), lambda _: ((3e-4, 4e-4), (1.0, 0.0)), nodes=256)
    found = cc.observables.fourier_amplitude(run, "radius", 1)
    assert complex(found.values[0, 0]) == pytest.approx(3e-4 - 4e-4j, abs=1e-7)


@pytest.mark.parametrize(
    ("field", "k", "says"),
    [
        ("radus", 1, "did you mean 'radius'"),
        ("theta", 1, "not known"),
        ("radius", 0, "from 1 to 31"),
        ("radius", [1, 32], "from 1 to 31"),
        ("radius", 1.5, "whole numbers"),
    ],
)
def test_bad_fields_and_wavenumbers_are_refused(field, k, says):
    with pytest.raises(cc.InputError, match=says):
        cc.observables.fourier_amplitude(straight(records=1), field, k)


def test_a_cell_that_left_the_origin_is_refused():
    with pytest.raises(cc.InputError, match="near the resting circle"):
        cc.observables.fourier_amplitude(straight(records=30), "radius", 1)
