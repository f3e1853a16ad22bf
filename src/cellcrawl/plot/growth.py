"""Growth of small perturbations, beside linear theory."""

from __future__ import annotations

from collections.abc import Sequence

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from cellcrawl.arguments import checked
from cellcrawl.data.units import units_of
from cellcrawl.errors import InputError
from cellcrawl.linear import evolution
from cellcrawl.observables import fourier_amplitude
from cellcrawl.parameters import Parameters
from cellcrawl.plot.inputs import drawable
from cellcrawl.plot.labels import time_label
from cellcrawl.plot.style import COLUMN, INK, axes_or_new, colormap_for, on
from cellcrawl.simulation.dataset import decode_attribute
from cellcrawl.validation import one_of

_SYMBOLS = {"radius": "$|R_k|$ ($R_0$)", "bound_fraction": "$|n_k|$"}
_NAMES = {"radius": "radius", "bound_fraction": "bound fraction"}


@checked
def growth(
    dataset: xr.Dataset,
    k: Sequence[int] = (1, 2, 5, 10, 15, 20),
    *,
    field: str = "bound_fraction",
    legend: bool = True,
    ax: Axes | None = None,
) -> Axes:
    """Draw the amplitudes of wavenumbers over time, solid, and linear theory's, dashed.

    Parameters
    ----------
    dataset : Dataset
        A run that starts near the resting circle, not longer than it stays there.
    k : sequence of int
        Wavenumbers.
    field : {"bound_fraction", "radius"}
        Whose amplitudes.
    legend : bool
        Say which colour is which wavenumber.
    ax : Axes, optional
        Where to draw; the only axes of a new figure unless given.

    Returns
    -------
    Axes

    Raises
    ------
    InputError
        For wavenumbers below 1, another field, a cell that is no longer near the circle, a run
        whose parameters change, or a dataset that is no run.
    """
    run = drawable(dataset)
    one_of("field", field, _SYMBOLS)
    if units_of(run).system != "model":
        raise InputError("linear theory is without dimension: give the run before Scales.dataset")
    if decode_attribute(run, "schedule"):
        raise InputError("the parameters of this run change: linear theory has one set of them")
    parameters = Parameters.from_dict(decode_attribute(run, "parameters"))
    radius, bound = (fourier_amplitude(run, name, list(k)) for name in ("radius", "bound_fraction"))
    times = run["time"].values
    shown = {"radius": radius, "bound_fraction": bound}[field]
    colours = mpl.colormaps[colormap_for("viridis")](np.linspace(0.0, 0.9, len(k)))[::-1]
    with axes_or_new(ax, COLUMN, 0.8 * COLUMN) as axes:
        for wave, colour in zip(k, colours, strict=True):
            first, second = (complex(a.sel(k=wave).values[0]) for a in (radius, bound))
            evolved = evolution(parameters, wave, first, second, times - times[0])
            theory = dict(zip(("radius", "bound_fraction"), evolved, strict=True))
            axes.semilogy(times, np.abs(shown.sel(k=wave).values), color=colour)
            axes.semilogy(
                times,
                np.abs(theory[field]),
                color=on(axes, INK),
                linewidth=0.6,
                dashes=(4, 3),
                zorder=3,
            )
        low, high = np.abs(shown.values).min(), np.abs(shown.values).max()
        axes.set_ylim(0.7 * low, 2.0 * high)
        axes.set_xlim(float(times[0]), float(times[-1]))
        axes.set(xlabel=time_label(run), ylabel=f"amplitude of {_NAMES[field]} {_SYMBOLS[field]}")
        axes.spines[["top", "right"]].set_visible(False)
        if legend:
            keys = [
                Line2D([], [], color=colour, label=f"$k$ = {wave}")
                for wave, colour in zip(k, colours, strict=True)
            ]
            keys.append(
                Line2D([], [], color=on(axes, INK), linewidth=0.6, dashes=(4, 3), label="theory")
            )
            axes.legend(handles=keys, frameon=False, ncols=2, loc="upper left", handlelength=1.6)
    return axes
