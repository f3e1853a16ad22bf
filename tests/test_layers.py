"""What loads what: data, observables and modes serve those who have tracks and no solver."""

from __future__ import annotations

import subprocess
import sys

import pytest

LIGHT = ("cellcrawl.data", "cellcrawl.observables", "cellcrawl.modes", "cellcrawl.microscopy")
HEAVY = ("numba", "llvmlite", "matplotlib", "cellcrawl.solvers", "cellcrawl.simulation")


@pytest.mark.parametrize("module", LIGHT)
def test_what_reads_and_measures_loads_no_solver(module):
    code = f"import sys, {module}; print(*[m for m in {HEAVY!r} if m in sys.modules])"
    done = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True, timeout=120
    )
    assert done.stdout.split() == []
