"""What the cell crawls on, under it in every picture: patterns shaded, walls dark."""

from __future__ import annotations

import warnings
from typing import Any, Final

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.image import AxesImage

from cellcrawl.data import decode_attribute
from cellcrawl.data.units import units_of
from cellcrawl.errors import InputError
from cellcrawl.laws import as_law
from cellcrawl.laws.law import PAPER
from cellcrawl.laws.rest import local_values
from cellcrawl.parameters import Parameters
from cellcrawl.surroundings import Place, as_surroundings

_GROUND: Final = to_rgb("#c9a86a")  # sand: more linkers, more adhesion, stiffer
_WALL: Final = to_rgb("#6f6f6f")
_STRONGEST = 0.55  # opacity
_PIXELS = 320
_PATTERNED: Final = ("r_on", "zeta_1", "chi", "D", "sigma_c")


def draw_ground(
    ax: Axes, run: xr.Dataset, low: np.ndarray, high: np.ndarray, pixels: int = _PIXELS
) -> AxesImage | None:
    """Draw what surrounds a run between two corners, with room to spare; None if nothing does.

    Surroundings whose class is not on this machine are left out with a warning.
    """
    if "surroundings" not in run.attrs:
        return None
    spare = 0.5 * float(np.max(high - low))
    left, bottom = low - spare
    right, top = high + spare
    try:
        picture = _picture(run, (left, right), (bottom, top), pixels)
    except InputError as error:
        warnings.warn(f"the surroundings are not drawn: {error}", UserWarning, stacklevel=2)
        return None
    limits = ax.get_xlim(), ax.get_ylim()
    image = ax.imshow(
        picture,
        extent=(left, right, bottom, top),
        origin="lower",
        interpolation="bilinear",
        zorder=-1.0,
        aspect="equal",
    )
    ax.set_xlim(*limits[0])
    ax.set_ylim(*limits[1])
    return image


def _picture(
    run: xr.Dataset, across: tuple[float, float], up: tuple[float, float], pixels: int
) -> np.ndarray:
    """Return colours with opacity, shape (rows, columns, 4), from the lowest row."""
    one = units_of(run).one("length")
    step = max(across[1] - across[0], up[1] - up[0]) / pixels
    x, y = (
        (ends[0] + step * (np.arange(max(2, round((ends[1] - ends[0]) / step))) + 0.5)) / one
        for ends in (across, up)
    )
    law = as_law(decode_attribute(run, "laws")) if "laws" in run.attrs else PAPER
    around: Any = as_surroundings(decode_attribute(run, "surroundings"))
    base = local_values(Parameters.from_dict(decode_attribute(run, "parameters")), law)
    grid_x, grid_y = np.meshgrid(x, y)
    still = np.zeros_like(grid_x)
    place = Place(x=grid_x, y=grid_y, time=still, normal_x=still, normal_y=still)
    found = around.values(base, place)
    picture = np.zeros((*grid_x.shape, 4))
    for name in _PATTERNED:
        if name in found and np.ndim(found[name]):
            low, high = float(found[name].min()), float(found[name].max())
            if high > low:
                part = (found[name] - low) / (high - low)
                picture[..., :3] = _GROUND
                picture[..., 3] = np.maximum(picture[..., 3], _STRONGEST * part)
    wall = np.broadcast_to(found["pressure"], grid_x.shape) > 0.0
    picture[wall] = (*_WALL, 1.0)
    return picture
