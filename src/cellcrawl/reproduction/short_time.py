"""The short-time comparison with linear theory (the paper's Fig. S2)."""

from __future__ import annotations

import numpy as np
import xarray as xr

from cellcrawl import linear, observables, plot
from cellcrawl.parameters import Parameters
from cellcrawl.plot.style import PAGE, paper_figure
from cellcrawl.reproduction.workspace import Workspace

_CELL = Parameters(r_on=25, zeta_1=600)
_WAVES = (1, 2, 5, 10, 15, 20)
_AMPLITUDES = (1e-4, 1e-6)
_COMPARED = 0.4


def make(workspace: Workspace, name: str) -> list[str]:
    """Draw amplitudes over time from the paper's start and from one a hundred times smaller."""
    end, found = 0.5 if workspace.quick else 0.8, []
    with paper_figure(PAGE, 2.9) as figure:
        panels = figure.subplots(1, len(_AMPLITUDES))
        for panel, letter, amplitude in zip(panels, "AB", _AMPLITUDES, strict=True):
            run = workspace.run(_CELL, end, save_every=0.01, amplitude=amplitude, rtol=1e-6)
            plot.growth(run, _WAVES, ax=panel, legend=letter == "B")
            panel.set_title(
                f"{letter}   amplitudes up to $10^{{{round(np.log10(amplitude))}}}$", loc="left"
            )
            measured = [
                observables.fourier_amplitude(run, name, _WAVES)
                for name in ("radius", "bound_fraction")
            ]
            workspace.data(f"amplitudes-{amplitude:g}", _parts(*measured))
            found.append(
                f"from amplitudes up to {amplitude:g}, error of theory at "
                f"t = {_COMPARED:g}: {_errors(*measured)}"
            )
        workspace.picture(figure)
    return found


def _parts(radius: xr.DataArray, bound: xr.DataArray) -> xr.Dataset:
    """Return real and imaginary parts, which netCDF can hold."""
    return xr.Dataset(
        {
            f"{name}_{part}": getattr(values, part)
            for name, values in (("radius", radius), ("bound_fraction", bound))
            for part in ("real", "imag")
        }
    )


def _errors(radius: xr.DataArray, bound: xr.DataArray) -> str:
    said = []
    for k in _WAVES[:4]:
        first = [complex(values.sel(k=k).values[0]) for values in (radius, bound)]
        _, theory = linear.evolution(_CELL, k, first[0], first[1], [_COMPARED])
        simulated = complex(bound.sel(k=k).sel(time=_COMPARED, method="nearest").values)
        said.append(f"k = {k}: {np.abs(simulated - theory[0]) / np.abs(theory[0]):.2g}")
    return ", ".join(said)
