"""The scripts beside the package: what they count, and where they write."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def script(path: str):
    spec = importlib.util.spec_from_file_location(Path(path).stem, ROOT / path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules.setdefault(spec.name, module)  # a dataclass looks for its module there
    spec.loader.exec_module(module)
    return module


def test_the_interval_of_a_share_is_wilsons():
    wilson = script("benchmarks/seeds.py").wilson
    # Wilson 1927: 0 of 10 gives z^2 / (n + z^2)
    assert wilson(0, 10) == pytest.approx((0.0, 0.277533), abs=1e-6)
    low, high = wilson(35, 58)
    assert wilson(23, 58) == pytest.approx((1.0 - high, 1.0 - low))
    assert low < 0.5 < high  # 35 left and 23 right say nothing of a preference


def test_errors_of_another_version_are_taken_at_the_references_times():
    errors = script("benchmarks/old_and_new.py").errors
    truth = {"times": [5.0, 10.0], "length": [7.0, 7.0], "tension": [900.0, 900.0]}
    truth |= {"area": [3.0, 3.0], "centroid_x": [0.0, 1.0], "centroid_y": [0.0, 0.0]}
    found = {"time": [0.0, 5.0, 10.0], "length": [1.0, 7.0, 7.07], "tension": [1.0, 900.0, 909.0]}
    found |= {"area": [9.0, 3.0, 2.97], "centroid_x": [9.0, 0.0, 1.003]}
    found |= {"centroid_y": [9.0, 0.0, 0.004]}
    expected = {"length": 1e-2, "tension": 1e-2, "area": 1e-2, "centroid": 5e-3}
    assert errors(found, truth) == pytest.approx(expected)
    short = {name: values[:2] for name, values in found.items()}
    assert errors(short, truth) is None  # it ended before


def test_the_solvers_page_has_a_place_for_every_record(monkeypatch):
    monkeypatch.setattr(sys, "path", [str(ROOT / "tools"), *sys.path])
    page = (ROOT / "docs" / "solvers.md").read_text("utf-8")
    for name in script("tools/solvers_page.py").PARTS:
        assert page.count(f"<!-- {name} -->") == page.count(f"<!-- end of {name} -->") == 1


def test_the_branch_code_finds_where_a_particle_of_closed_form_begins_to_turn():
    particle = script("benchmarks/particle.py")
    for motor in (particle.Motor(0.3), particle.Motor(0.3, 1.3, 0.7, 0.4)):
        (point,) = particle.ours(motor)
        assert point.kind == "pitchfork"
        assert point.value == pytest.approx(motor.turns_at, abs=1e-9)
    assert particle.Motor(0.3).turns_at == 0.75
