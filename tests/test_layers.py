"""What loads what: data, observables and modes serve those who have tracks and no solver."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from graphlib import TopologicalSorter
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


def test_no_part_of_the_package_needs_one_that_needs_it():
    root = Path(cc.__file__).parent
    needs: dict[str, set[str]] = {}
    for file in root.rglob("*.py"):
        part = file.relative_to(root).parts[0].removesuffix(".py")
        for node in ast.parse(file.read_text("utf-8")).body:  # what is imported at once
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("cellcrawl"):
                homes = node.module.split(".")[1:2] or [alias.name for alias in node.names]
                needs.setdefault(part, set()).update(home for home in homes if home != part)
    order = list(TopologicalSorter(needs).static_order())  # raises where there is a circle
    assert order.index("numerics") < order.index("laws") < order.index("solvers")
    assert order.index("data") < order.index("observables") < order.index("modes")
    assert order.index("solvers") < order.index("simulation") < order.index("sweeps")
