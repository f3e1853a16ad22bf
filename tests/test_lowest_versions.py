"""The lowest versions that are tested are those that pyproject.toml allows."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

TOOL = Path(__file__).parents[1] / "tools" / "lowest_versions.py"
pytestmark = pytest.mark.skipif(not TOOL.exists(), reason="only in a checkout")


@pytest.fixture(scope="module")
def tool():
    spec = importlib.util.spec_from_file_location("lowest_versions", TOOL)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


PROJECT = {
    "name": "x",
    "dependencies": [
        "a>=1.2",
        "b>=3,<5",
        "c>=1; python_version < '3.13'",
        "c>=2; python_version >= '3.13'",
    ],
    "optional-dependencies": {"test": ["d >= 4", "x[more]"], "more": ["e>=0.1"], "docs": ["f"]},
}


def test_bounds_are_read_with_extras_and_markers(tool):
    on_old = {"a": "1.2", "b": "3", "c": "1", "d": "4", "e": "0.1"}
    assert tool.lowest_versions(PROJECT, (3, 11)) == on_old
    assert tool.lowest_versions(PROJECT, (3, 13)) == on_old | {"c": "2"}


def test_a_dependency_without_a_lower_bound_is_refused(tool):
    with pytest.raises(SystemExit, match="'f' has no lower bound"):
        tool.lowest_versions(PROJECT, (3, 11), "docs")
