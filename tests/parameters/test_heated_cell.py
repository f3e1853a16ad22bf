"""The example that heats a cell: its numbers from theory, and the modes it passes through."""

from __future__ import annotations

import importlib.util
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import cellcrawl as cc

_EXAMPLE = Path(__file__).parents[2] / "examples" / "temperature.py"


@pytest.fixture(scope="module")
def example() -> Any:
    found = importlib.util.spec_from_file_location("temperature_example", _EXAMPLE)
    assert found is not None
    assert found.loader is not None
    module = importlib.util.module_from_spec(found)
    found.loader.exec_module(module)
    return module


def test_r_on_rises_by_arrhenius_with_the_difference_of_energies(example):
    cold, warm = example.at(5), example.at(35)
    difference = 75e3 - 50e3
    expected = math.exp(-difference / 8.314462618 * (1.0 / 308.15 - 1.0 / 278.15))
    assert warm.r_on / cold.r_on == pytest.approx(expected, rel=1e-9)
    assert warm.zeta_1 == pytest.approx(cold.zeta_1, rel=1e-12)


def test_heat_takes_the_cell_from_gliding_by_rotation_and_zigzag_to_others(example):
    modes = [cc.classify(run).mode for run in example.walk().values()]
    assert modes[0] == "gliding"
    assert modes[2] == "rotational"
    assert modes[3:5] == ["zigzag", "zigzag"]
    assert modes[5:] == ["other", "other"]


def test_the_clock_of_a_heated_cell_is_the_integral_of_its_off_rate(example):
    schedule, end, temperatures = example.heating(minutes=40.0, hold=5.0)
    times, celsius = temperatures.T
    assert schedule.at(example.at(5), 0.0).r_on == pytest.approx(example.at(5).r_on)
    assert schedule.at(example.at(5), end).r_on == pytest.approx(example.at(35).r_on)
    assert np.all(np.diff(times) > 0.0)
    # both pauses last 300 s, one at the cold rate and one at the warm one, 0.1/s at 25 degrees
    rates = [0.1 * math.exp(-50e3 / 8.314462618 * (1 / (273.15 + c) - 1 / 298.15)) for c in (5, 35)]
    assert times[1] == pytest.approx(300.0 * rates[0], rel=1e-6)
    assert end - times[-1] == pytest.approx(300.0 * rates[1], rel=1e-6)
    assert celsius[0] == 5.0
    assert celsius[-1] == 35.0
