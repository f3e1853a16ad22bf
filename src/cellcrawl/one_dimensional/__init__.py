"""The model on a line: two edges under one tension, and a flat edge.

A reconstruction: the equations are derived here from the two-dimensional model, in the spirit of
its parent (P. Sens, PNAS 117, 24670, 2020), whose equations as printed were not at hand.
"""

from cellcrawl.one_dimensional.cell import Anchoring, length_stiffness, still_tension
from cellcrawl.one_dimensional.diagram import boundaries, phase_diagram
from cellcrawl.one_dimensional.flat_edge import simulate_flat_edge
from cellcrawl.one_dimensional.flat_starts import (
    FlatFields,
    FlatNoise,
    FlatSetting,
    FlatStart,
    FlatWave,
    StuckPatch,
)
from cellcrawl.one_dimensional.flat_theory import flat_growth_rates, front_speed, uniform_states
from cellcrawl.one_dimensional.regimes import REGIMES, Regime, regime
from cellcrawl.one_dimensional.starts import STARTS, TwoEdges
from cellcrawl.one_dimensional.theory import CrawlingState, crawling_states, growth_rates
from cellcrawl.one_dimensional.two_edges import simulate_two_edges
from cellcrawl.one_dimensional.waves import stuck_length, wave_velocity

__all__ = [
    "REGIMES",
    "STARTS",
    "Anchoring",
    "CrawlingState",
    "FlatFields",
    "FlatNoise",
    "FlatSetting",
    "FlatStart",
    "FlatWave",
    "Regime",
    "StuckPatch",
    "TwoEdges",
    "boundaries",
    "crawling_states",
    "flat_growth_rates",
    "front_speed",
    "growth_rates",
    "length_stiffness",
    "phase_diagram",
    "regime",
    "simulate_flat_edge",
    "simulate_two_edges",
    "still_tension",
    "stuck_length",
    "uniform_states",
    "wave_velocity",
]
