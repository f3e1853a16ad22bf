"""What the claims of the paper share: how one is told, and the runs they are measured on."""

from __future__ import annotations

import functools
from typing import Any, Final

import numpy as np
import xarray as xr

from cellcrawl.parameters import Parameters
from cellcrawl.simulation import simulate
from cellcrawl.starts import RandomPerturbation
from cellcrawl.verification.check import Result

STABILITY: Final = "Linear stability"
ONSET: Final = "Early stage, Fig. 3"
MODES: Final = "Motility modes, Fig. 4"
TURNS: Final = "Motility modes, Fig. 5"
ROBUSTNESS: Final = "Robustness, Fig. 6"
TRENDS: Final = "Adhesion parameters, Fig. 7"
DISCUSSION: Final = "Discussion"
EQUATIONS: Final = "Governing equations"
NUMERICS: Final = "Numerical implementation"


def claim(
    what: str,
    where: str,
    expected: str,
    measured: str,
    holds: Any,
    *,
    unless: str = "",
    note: str = "",
    **values: float,
) -> Result:
    """Return the result of a claim; ``unless`` says why it is known not to hold."""
    return Result(what, expected, measured, bool(holds), where, unless, note, values)


@functools.lru_cache(maxsize=64)
def crawl(
    r_on: float,
    zeta_1: float,
    seed: int = 1,
    t_end: float = 100.0,
    save_every: float = 0.1,
    elasticity: str = "printed",
) -> xr.Dataset:
    """Return a run from the paper's random start with the default solver."""
    p = Parameters(r_on=r_on, zeta_1=zeta_1, elasticity=elasticity)
    return simulate(p, t_end, start=RandomPerturbation(seed), save_every=save_every)


def count(flags: Any) -> str:
    """Return ``3 of 5`` for how many flags are set."""
    flags = np.asarray(list(flags), dtype=bool)
    return f"{flags.sum()} of {flags.size}"


def spread(values: Any, form: str = ".3g") -> str:
    """Return the range of values, as text."""
    values = np.asarray(list(values), dtype=float)
    low, high = format(values.min(), form), format(values.max(), form)
    return low if low == high else f"{low}...{high}"


def swing(values: xr.DataArray) -> float:
    """Return the range of values over their mean."""
    return float((values.max() - values.min()) / values.mean())
