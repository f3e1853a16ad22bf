"""Which papers stand behind a law, a surrounding, a solver or an analysis."""

from __future__ import annotations

from typing import Final

MODEL: Final = (("chen2023", "the model"), ("bell1978", "bonds that slip under force"))
LAWS: Final = {
    "Paper": ("bell1978", "bonds that slip under force"),
    "CatchSlip": ("pereverzev2005", "catch-slip bonds"),
    "Stiffness": ("chan2008", "a ground that gives way"),
    "PolymerizationUnderLoad": ("keren2008", "polymerisation under load"),
    "SweptMyosin": ("barnhart2015", "contraction that goes with the flow"),
    "TensionGradient": ("lieber2015", "a gradient of membrane tension"),
}
SOLVERS: Final = {
    "adaptive": (
        ("shampine1997", "the formulas of the adaptive solver in time"),
        ("hou1994", "an edge held by its tangent angle and length"),
    ),
    "paper": (
        ("chen2023", "the published scheme"),
        ("hou1994", "an edge held by its tangent angle and length"),
    ),
    "spline": (("kennedy2003", "the formulas of the spline solver in time"),),
    "stochastic": (("salmon2011", "the random numbers of the noise"),),
}
_FIT: Final = (
    ("beaumont2002", "parameters from runs by approximate Bayesian computation"),
    ("fearnhead2012", "summaries that are learned"),
)
ANALYSES: Final = {
    "Fit": _FIT,
    "Group": _FIT,
    "Comparison": _FIT,
    "Choice": _FIT,
    "LyapunovExponent": (("benettin1980", "the growth of small changes"),),
    "PersistentWalk": (("johnson2008", "the fit of a persistent random walk"),),
    "ShapeModes": (
        ("pincus2007", "principal components of outlines"),
        ("keren2008", "shape modes of moving cells"),
    ),
}
LINE: Final = (("sens2020", "the model on a line"),)
