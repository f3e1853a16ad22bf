"""Run the package over the plane of the map, and the presets, and keep what the page shows of them.

``python -m cellcrawl.explorer.diagram`` writes the file the page is made with; it takes about a
minute on one core.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Final

import numpy as np
import xarray as xr

import cellcrawl
from cellcrawl.explorer import links
from cellcrawl.explorer.content import DIAGRAM
from cellcrawl.explorer.presets import PRESETS, SEED

R_ON: Final = np.arange(12.0, 62.0, 4.0)
ZETA_1: Final = np.arange(510.0, 620.0, 20.0)
T_END: Final = 100.0
_OUTLINES, _POINTS, _TRACK = 6, 48, 120  # of a picture
_LONGEST: Final = 70.0  # time shown in a picture


def mode(r_on: float, zeta_1: float) -> str:
    """Return the mode at a point of the map."""
    parameters = cellcrawl.Parameters(r_on=r_on, zeta_1=zeta_1)
    start = cellcrawl.RandomPerturbation(seed=SEED)
    return cellcrawl.classify(cellcrawl.simulate(parameters, t_end=T_END, start=start)).mode


def picture(link: str, until: float) -> dict[str, Any]:
    """Return track and outlines of a preset, coarse enough for a thumbnail."""
    found = links.read(link)
    t_end = min(until, _LONGEST)
    run = cellcrawl.simulate(found.parameters, t_end=t_end, nodes=_POINTS, **found.options())
    times = run.sizes["time"]
    at = np.unique(np.linspace(0, times - 1, _TRACK).astype(int))
    shown = np.unique(np.linspace(0, times - 1, _OUTLINES).astype(int)[1:])
    return {
        "track": _pairs(run.isel(time=at), "centroid_x", "centroid_y"),
        "outlines": [_pairs(run.isel(time=k), "x", "y") for k in shown],
    }


def _pairs(run: xr.Dataset, x: str, y: str) -> list[list[float]]:
    pairs: list[list[float]] = np.round(np.column_stack([run[x], run[y]]), 2).tolist()
    return pairs


def main() -> None:
    """Write the file."""
    kept = {
        "t_end": T_END,
        "seed": SEED,
        "modes": [[r_on, z, mode(r_on, z)] for z in ZETA_1.tolist() for r_on in R_ON.tolist()],
        "pictures": {preset.key: picture(preset.link, preset.until) for preset in PRESETS},
    }
    text = json.dumps(kept, separators=(",", ":"))
    Path(__file__).with_name(DIAGRAM).write_text(text + "\n", "utf-8")


if __name__ == "__main__":
    main()
