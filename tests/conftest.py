"""Shared starts and settings of the tests."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from typing import Any

import hypothesis
import matplotlib as mpl
import pytest

import cellcrawl as cc
from cellcrawl.bench.cases import check_start as check_start
from cellcrawl.verification.transformations import Given as Given
from cellcrawl.verification.transformations import reflected as reflected
from cellcrawl.verification.transformations import rotated as rotated
from cellcrawl.verification.transformations import shifted as shifted

hypothesis.settings.register_profile(
    "cellcrawl", deadline=None, suppress_health_check=[hypothesis.HealthCheck.too_slow]
)
hypothesis.settings.load_profile("cellcrawl")


def pytest_sessionstart(session: pytest.Session) -> None:
    """Compile the solvers before the workers start, which would each do it otherwise.

    Two processes share them; where the kernels are on disk already it takes a moment.
    """
    option = session.config.option
    workers = getattr(option, "numprocesses", None)
    if hasattr(session.config, "workerinput") or not workers or option.collectonly:
        return
    run = "import sys, cellcrawl as cc; [cc.simulate(solver=s, t_end=0.01) for s in sys.argv[1:]]"
    shares = (["adaptive"], ["paper", "spline", "stochastic"])
    children = [subprocess.Popen([sys.executable, "-c", run, *share]) for share in shares]
    for child in children:
        child.wait()


def settings() -> dict[str, Any]:
    """All of matplotlib's settings but the backend, which loads pyplot when it is looked at."""
    return {name: mpl.rcParams[name] for name in mpl.rcParams if name != "backend"}


@pytest.fixture(autouse=True)
def _close_figures() -> Iterator[None]:
    """Leave none of pyplot's figures, which it keeps once any test has loaded it, to the next."""
    yield
    pyplot: Any = sys.modules.get("matplotlib.pyplot")
    if pyplot is not None:
        pyplot.close("all")


@pytest.fixture(scope="session")
def zigzag_parameters() -> cc.Parameters:
    return cc.Parameters(r_on=26, zeta_1=600)
