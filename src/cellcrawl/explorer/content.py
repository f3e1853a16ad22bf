"""What the page shows and does not compute: colours, scales, limits, the map, the presets."""

from __future__ import annotations

import json
from importlib import resources
from typing import Any, Final

import matplotlib as mpl
import numpy as np
from matplotlib.colors import to_hex

from cellcrawl.explorer.cards import CARDS
from cellcrawl.explorer.entries import layout
from cellcrawl.explorer.law_choices import law_choices
from cellcrawl.explorer.links import PULSES
from cellcrawl.explorer.presets import PRESETS
from cellcrawl.linear import growth_rates, marginal_curves
from cellcrawl.modes.confidence import FILE
from cellcrawl.modes.evidence import WORDS, Evidence
from cellcrawl.parameters import DESCRIPTIONS, Parameters, Scales
from cellcrawl.plot.scales import SCALES

R_ON: Final = (10.0, 62.0)
ZETA_1: Final = (500.0, 620.0)
DIAGRAM: Final = "diagram.json"
_SHAPE: Final = (53, 49)
_FIELDS: Final = ("bound_fraction", "off_rate", "friction", "curvature", "normal_velocity")
_STOPS: Final = 33


def content() -> dict[str, Any]:
    """Return all of it as plain values for JSON."""
    scales = Scales()
    kept = kept_runs()
    pictures = kept["pictures"]
    return {
        "colours": {SCALES[f].colormap: _colours(SCALES[f].colormap) for f in _FIELDS},
        "scales": {name: getattr(scales, name) for name in scales.field_names()},
        "limits": {name: [about.low, about.high] for name, about in DESCRIPTIONS.items()},
        "layout": layout(),
        "laws": law_choices(),
        "pulses": PULSES,
        "meanings": {name: about.meaning for name, about in DESCRIPTIONS.items()},
        "map": {**_shading(), "modes": kept["modes"]},
        "presets": [{**preset.as_content(), "picture": pictures[preset.key]} for preset in PRESETS],
        "evidence": {"names": list(Evidence._fields), "words": WORDS},
        "confidence": _confidence(),
        "cards": [
            {name: value for name, value in card._asdict().items() if name != "check"}
            for card in CARDS
        ],
    }


def kept_runs() -> dict[str, Any]:
    """Return what `diagram` made: modes over the map and the presets' pictures."""
    text = resources.files("cellcrawl.explorer").joinpath(DIAGRAM).read_text("utf-8")
    kept: dict[str, Any] = json.loads(text)
    return kept


def _confidence() -> dict[str, Any]:
    text = resources.files("cellcrawl.modes").joinpath(FILE).read_text("utf-8")
    kept: dict[str, Any] = json.loads(text)
    return {name: kept[name] for name in ("answers", "lengths", "raw", "settled")}


def _colours(name: str) -> str:
    colours = mpl.colormaps[name](np.linspace(0.0, 1.0, _STOPS))
    return "".join(to_hex(colour)[1:] for colour in colours)


def _shading() -> dict[str, Any]:
    """Growth rate of the first mode over the plane, and where it is zero."""
    columns, rows = _SHAPE
    r_on = np.linspace(*R_ON, columns)
    zeta_1 = np.linspace(*ZETA_1, rows)
    grid = {"r_on": r_on[None, :], "zeta_1": zeta_1[:, None]}
    growth = growth_rates(Parameters(), 1, **grid)[..., 0].real
    curves = marginal_curves(Parameters(), 1, r_on=np.array(R_ON), zeta_1=np.array(ZETA_1))
    return {
        "r_on": list(R_ON),
        "zeta_1": list(ZETA_1),
        "shape": [columns, rows],
        "growth": [round(float(value), 2) for value in growth.ravel()],
        "largest": round(float(np.abs(growth).max()), 2),
        "marginal": [np.round(curve, 2).tolist() for curve in curves],
    }
