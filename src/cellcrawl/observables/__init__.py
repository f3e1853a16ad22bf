"""What is measured on a run or on a track: pure functions.

Those of the centroid's motion take a run or plain arrays, ``speed(run)`` or ``speed(t, x, y)``;
those of the edge take a run. A run is dimensionless in the scales of the model; a track has its
user's units. Results that vary carry their unit in ``attrs["units"]``. The Notes of each function
say where the measure misleads.
"""

from cellcrawl.observables.asymmetry import front_rear_asymmetry, left_right_asymmetry
from cellcrawl.observables.displacement import mean_squared_displacement
from cellcrawl.observables.distance import mean_distance, straightness
from cellcrawl.observables.drift import Drift, shared_drift, without_drift
from cellcrawl.observables.edges import edge_series
from cellcrawl.observables.fourier import fourier_amplitude
from cellcrawl.observables.front import front_position
from cellcrawl.observables.kymograph import kymograph
from cellcrawl.observables.motion import centroid_velocity, heading, speed, turning_rate
from cellcrawl.observables.oscillation import (
    Oscillation,
    lateral_oscillation,
    oscillation,
    tension_oscillation,
)
from cellcrawl.observables.persistence import Persistence, persistence, velocity_correlation
from cellcrawl.observables.random_walk import Estimate, PersistentWalk, persistent_walk
from cellcrawl.observables.shape import aspect_ratio, circularity
from cellcrawl.observables.shape_modes import ShapeModes, shape_modes
from cellcrawl.observables.turns import turning_events

__all__ = [
    "Drift",
    "Estimate",
    "Oscillation",
    "Persistence",
    "PersistentWalk",
    "ShapeModes",
    "aspect_ratio",
    "centroid_velocity",
    "circularity",
    "edge_series",
    "fourier_amplitude",
    "front_position",
    "front_rear_asymmetry",
    "heading",
    "kymograph",
    "lateral_oscillation",
    "left_right_asymmetry",
    "mean_distance",
    "mean_squared_displacement",
    "oscillation",
    "persistence",
    "persistent_walk",
    "shape_modes",
    "shared_drift",
    "speed",
    "straightness",
    "tension_oscillation",
    "turning_events",
    "turning_rate",
    "velocity_correlation",
    "without_drift",
]
