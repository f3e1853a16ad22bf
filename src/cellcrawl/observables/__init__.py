"""What is measured on a run: pure functions from the Dataset to DataArrays.

Everything is dimensionless in the scales of the model; each result carries its unit in
``attrs["units"]``. The Notes of each function say where the measure misleads.
"""

from cellcrawl.observables.fourier import fourier_amplitude
from cellcrawl.observables.front import front_position
from cellcrawl.observables.kymograph import kymograph
from cellcrawl.observables.motion import centroid_velocity, heading, speed, turning_rate
from cellcrawl.observables.shape import circularity

__all__ = [
    "centroid_velocity",
    "circularity",
    "fourier_amplitude",
    "front_position",
    "heading",
    "kymograph",
    "speed",
    "turning_rate",
]
