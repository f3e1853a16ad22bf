"""What loads what: data, observables and modes serve those who have tracks and no solver."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

import cellcrawl as cc

LIGHT = ("cellcrawl.data", "cellcrawl.observables", "cellcrawl.modes", "cellcrawl.microscopy")
HEAVY = ("numba", "llvmlite", "matplotlib", "cellcrawl.solvers", "cellcrawl.simulation")


@pytest.mark.parametrize("module", LIGHT)
def test_what_reads_and_measures_loads_no_solver(module):
    code = f"import sys, {module}; print(*[m for m in {HEAVY!r} if m in sys.modules])"
    done = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True, timeout=120
    )
    assert done.stdout.split() == []


def test_what_the_reference_names_is_reached_from_the_package_and_nothing_else_is_listed():
    page = (Path(__file__).parents[1] / "docs" / "api.md").read_text("utf-8")
    names = re.findall(r"^ +cellcrawl\.([\w.]+)$", page, re.MULTILINE)
    assert len(names) > 100
    code = f"""
import pydoc
import cellcrawl as cc
missing = [name for name in {names!r} if not hasattr(cc, name.split(".")[0])]
print(*missing, *(name for name in {names!r} if pydoc.locate("cellcrawl." + name) is None))
"""
    done = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True, timeout=120
    )
    assert done.stdout.split() == []
    stray = {"Any", "annotations", "importlib", "TYPE_CHECKING", "locks", "arguments"}
    assert not stray & set(dir(cc))
