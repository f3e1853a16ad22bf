"""How patterns move along a flat edge."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.validation import real_number, shown


@checked
def wave_velocity(dataset: xr.Dataset) -> xr.Dataset:
    """Velocity of the pattern of bound fraction along a flat edge.

    Between two records the one shift of the whole pattern that explains its change best in the
    sense of least squares: ``- <n_t n_s> / <n_s n_s>``. Exact for a wave that keeps its shape, and
    for a single wave that grows.

    Parameters
    ----------
    dataset : Dataset
        From `simulate_flat_edge`.

    Returns
    -------
    Dataset
        Over time (midway between records): ``velocity``, above 0 towards larger s, and
        ``coherence``, the part of the change that the shift explains, 1 for a wave that keeps its
        shape, near 0 where the pattern grows, stands or changes otherwise. NaN where the edge is
        uniform to 1e-9.

    Raises
    ------
    InputError
        For a dataset that is no run of a flat edge, or has one record.

    Notes
    -----
    Records must be close: a pattern that moves by a quarter of its wavelength or more from one to
    the next is seen too slow. Two waves that pass through each other have no one velocity; see
    the coherence.
    """
    run = check_flat_edge(dataset)
    n, times, s = run["bound_fraction"].values, run["time"].values, run["s"].values
    if times.size < 2:
        raise InputError("this run has one record: a velocity needs two; save more often")
    length = float(run.attrs["length"])
    k = 2.0 * np.pi / length * np.arange(s.size // 2 + 1)
    middle = 0.5 * (n[1:] + n[:-1])
    slope = np.fft.irfft(1j * k * np.fft.rfft(middle, axis=1), s.size, axis=1)
    change = np.diff(n, axis=0) / np.diff(times)[:, None]
    steepness, moved = np.mean(slope**2, axis=1), -np.mean(change * slope, axis=1)
    changed = np.mean(change**2, axis=1)
    shown_at_all = np.ptp(middle, axis=1) > 1e-9
    with np.errstate(divide="ignore", invalid="ignore"):
        velocity = np.where(shown_at_all, moved / steepness, np.nan)
        coherence = np.where(shown_at_all & (changed > 0), moved**2 / (steepness * changed), np.nan)
    about = {"long_name": "velocity of the pattern along the edge", "units": "R_0 k_off0"}
    return xr.Dataset(
        {
            "velocity": ("time", velocity, about),
            "coherence": (
                "time",
                coherence,
                {"long_name": "part of the change the shift explains", "units": "1"},
            ),
        },
        {"time": ("time", 0.5 * (times[1:] + times[:-1]), dict(run["time"].attrs))},
    )


@checked
def stuck_length(dataset: xr.Dataset, level: float | None = None) -> xr.DataArray:
    """Length of a flat edge whose bound fraction is above a level, to better than a node.

    Half its rate of change is the speed of the fronts at the two ends of a stuck stretch.

    Parameters
    ----------
    dataset : Dataset
        From `simulate_flat_edge`.
    level : float, optional
        Bound fraction, 0 to 1; midway between the lowest and highest of the first record unless
        given.

    Returns
    -------
    DataArray, dims (time)

    Raises
    ------
    InputError
        For a dataset that is no run of a flat edge.
    """
    run = check_flat_edge(dataset)
    n = run["bound_fraction"].values
    if level is None:
        level = 0.5 * float(n[0].min() + n[0].max())
    level = real_number("level", level, 0.0, 1.0)
    spacing = float(run.attrs["length"]) / n.shape[1]
    here, there = n - level, np.roll(n, -1, axis=1) - level
    above, next_above = here > 0.0, there > 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        part = np.abs(here) / (np.abs(here) + np.abs(there))
    crossing = np.where(above, part, 1.0 - part)
    stretch = np.where(above == next_above, above.astype(float), crossing)
    return xr.DataArray(
        spacing * stretch.sum(axis=1),
        dims="time",
        coords={"time": run["time"]},
        attrs={"long_name": "stuck length of the edge", "units": "R_0"},
    )


def check_flat_edge(dataset: Any) -> xr.Dataset:
    """Return ``dataset`` if it is a run of a flat edge, or raise `InputError`."""
    if not isinstance(dataset, xr.Dataset) or dataset.attrs.get("model") != "flat edge":
        raise InputError(
            f"this is no run of a flat edge but {shown(type(dataset).__name__)}: make one with "
            "one_dimensional.simulate_flat_edge"
        )
    return dataset
