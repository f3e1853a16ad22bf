"""Branches: gliding and turning cells computed, followed, and what makes each lose its hold.

A gliding or steadily turning cell is a fixed point of the model without place, direction and choice
of the first node. `from_run` polishes a run's end into one, `gliding` and `turning` find one from
nothing, `continue_in` follows it as a parameter changes and names the points on the way.
"""

from cellcrawl.branches.basins import BasinShare, Swollen, Threshold, basins, threshold_kick
from cellcrawl.branches.branch import Branch
from cellcrawl.branches.circle import circle, from_circle, onset_slope, onsets
from cellcrawl.branches.continuation import ENDS, continue_in
from cellcrawl.branches.curves import CURVE_ENDS, PointCurve, curve_of
from cellcrawl.branches.exponent_map import lyapunov_map, open_lyapunov_map
from cellcrawl.branches.hopf import from_hopf
from cellcrawl.branches.lyapunov import LABELS, LyapunovExponent, lyapunov_exponent
from cellcrawl.branches.orbit import Orbit, orbit
from cellcrawl.branches.orbit_branch import (
    ORBIT_ENDS,
    ORBIT_MEANINGS,
    OrbitBranch,
    OrbitPoint,
    continue_orbit,
)
from cellcrawl.branches.orbit_storage import open_orbits, resume_orbits
from cellcrawl.branches.points import MEANINGS, SpecialPoint
from cellcrawl.branches.setting import Setting
from cellcrawl.branches.starting import from_run, gliding, turning
from cellcrawl.branches.state import SteadyState
from cellcrawl.branches.storage import open_branch, resume_branch
from cellcrawl.branches.switching import branch_off

__all__ = [
    "CURVE_ENDS",
    "ENDS",
    "LABELS",
    "MEANINGS",
    "ORBIT_ENDS",
    "ORBIT_MEANINGS",
    "BasinShare",
    "Branch",
    "LyapunovExponent",
    "Orbit",
    "OrbitBranch",
    "OrbitPoint",
    "PointCurve",
    "Setting",
    "SpecialPoint",
    "SteadyState",
    "Swollen",
    "Threshold",
    "basins",
    "branch_off",
    "circle",
    "continue_in",
    "continue_orbit",
    "curve_of",
    "from_circle",
    "from_hopf",
    "from_run",
    "gliding",
    "lyapunov_exponent",
    "lyapunov_map",
    "onset_slope",
    "onsets",
    "open_branch",
    "open_lyapunov_map",
    "open_orbits",
    "orbit",
    "resume_branch",
    "resume_orbits",
    "threshold_kick",
    "turning",
]
