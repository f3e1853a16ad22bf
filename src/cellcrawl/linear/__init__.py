"""Linear theory of the resting circle: growth rates, unstable modes, stability diagrams.

The base state is a circle of radius 1 at rest. Wavenumber k = 0 breathes, k = 1 translates, k >= 2
change the shape.
"""

from cellcrawl.linear.evolution import evolution
from cellcrawl.linear.modes import Mode, cutoff_wavenumber, fastest_mode, unstable_modes
from cellcrawl.linear.stability import curves_in, marginal_curves, stability_map
from cellcrawl.linear.theory import BaseState, base_state, fastest_decay, growth_rates
from cellcrawl.linear.transitions import Transition, hopf_points, oscillation_onset

__all__ = [
    "BaseState",
    "Mode",
    "Transition",
    "base_state",
    "curves_in",
    "cutoff_wavenumber",
    "evolution",
    "fastest_decay",
    "fastest_mode",
    "growth_rates",
    "hopf_points",
    "marginal_curves",
    "oscillation_onset",
    "stability_map",
    "unstable_modes",
]
