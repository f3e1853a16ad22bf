"""What two edges settle into, by rule."""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.validation import real_number, shown

REGIMES: Final = ("still", "crawling", "stick-slip", "stepping", "bipedal", "failed")
"""Labels in the order of their codes in a phase diagram."""
LATE: Final = 0.6
"""The part of a run that is left out as the transient."""
THRESHOLD: Final = 0.02
_TAKES_TURNS = 0.25
_DRIFT = 0.1
_FEWEST = 8


class Regime(NamedTuple):
    """A regime and the measures it was told by."""

    name: str
    """One of `REGIMES`."""
    swing: float
    """How far the bound fraction both rises and falls, of the edge that changes more."""
    polarity: float
    """Largest difference of bound fraction between the edges."""
    takes_turns: bool
    """Whether each edge is the more bound one at times."""
    settled: bool
    """Whether the measures agree between the two halves of what was looked at."""
    speed: float
    """Mean speed of the cell's middle over what was looked at, R_0 k_off0."""


FAILED: Final = Regime("failed", np.nan, np.nan, False, False, np.nan)
"""That of a run that could not go on."""


@checked
def regime(
    dataset: xr.Dataset, *, after: float | None = None, threshold: float = THRESHOLD
) -> Regime:
    """Say which regime a run of two edges ends in.

    The rule looks at the bound fractions after the transient. An edge *swings* where its bound
    fraction both rises and falls by more than the threshold (a slow drift only does one), the cell
    is *polar* where the two edges differ by more than that at some time.

    ========== ====== ===== ==========================================================
    regime     swings polar
    ========== ====== ===== ==========================================================
    still      no     no    both edges rest
    crawling   no     yes   a stuck front, a slipping rear
    stick-slip yes    no    both edges stick and slip together
    stepping   yes    yes   crawls in steps; front stays front
    bipedal    yes    yes   edges take turns: each is the more bound one by at least a
                            quarter of the largest difference at some time
    ========== ====== ===== ==========================================================

    Parameters
    ----------
    dataset : Dataset
        From `simulate_two_edges`.
    after : float, optional
        Where the transient ends; after 0.6 of the run unless given.
    threshold : float
        Smallest difference of bound fraction that counts, 1e-6 to 0.5.

    Returns
    -------
    Regime
        The name with the measures behind it. Near a boundary a run may need longer than it has:
        ``settled`` then is False, and the name is that of where it is on its way. A run that could
        not go on has the name "failed".

    Raises
    ------
    InputError
        For a dataset that is no run of two edges, or fewer than eight records after the transient.
    """
    threshold = real_number("threshold", threshold, 1e-6, 0.5)
    run = check_two_edges(dataset)
    if run.attrs["status"] != "completed":
        return FAILED
    times = run["time"].values
    begin = LATE * float(times[-1]) if after is None else real_number("after", after, 0.0, np.inf)
    late = times >= begin
    if np.count_nonzero(late) < _FEWEST:
        raise InputError(
            f"only {np.count_nonzero(late)} records from time {begin:g} on: eight are needed; save "
            "more often or run longer"
        )
    position = run["position"].values[late].mean(axis=1)
    speed = float((position[-1] - position[0]) / (times[late][-1] - times[late][0]))
    return measured(run["bound_fraction"].values[late], threshold, speed)


def measured(bound: np.ndarray, threshold: float, speed: float) -> Regime:
    """Return the regime of bound fractions (time, 2)."""
    swing, polarity, low, high = _measures(bound)
    takes_turns = min(-low, high) >= _TAKES_TURNS * polarity
    swings, polar = swing > threshold, polarity > threshold
    if polar:
        name = ("bipedal" if takes_turns else "stepping") if swings else "crawling"
    else:
        name = "stick-slip" if swings else "still"
    middle = len(bound) // 2
    halves = [np.array(_measures(part)[:2]) for part in (bound[:middle], bound[middle:])]
    slack = np.maximum(_DRIFT * np.array([swing, polarity]), 0.25 * threshold)
    settled = bool(np.all(np.abs(halves[1] - halves[0]) <= slack))
    return Regime(name, swing, polarity, bool(takes_turns and polar), settled, speed)


def _measures(bound: np.ndarray) -> tuple[float, float, float, float]:
    difference = bound[:, 0] - bound[:, 1]
    rise = np.max(bound - np.minimum.accumulate(bound), axis=0)
    fall = np.max(np.maximum.accumulate(bound) - bound, axis=0)
    return (
        float(np.minimum(rise, fall).max()),
        float(np.abs(difference).max()),
        float(difference.min()),
        float(difference.max()),
    )


def check_two_edges(dataset: Any) -> xr.Dataset:
    """Return ``dataset`` if it is a run of two edges, or raise `InputError`."""
    if not isinstance(dataset, xr.Dataset) or dataset.attrs.get("model") != "two edges":
        raise InputError(
            f"this is no run of two edges but {shown(type(dataset).__name__)}: make one with "
            "one_dimensional.simulate_two_edges"
        )
    return dataset
