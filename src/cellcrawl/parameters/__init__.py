"""What a cell is made of: dimensionless parameters, physical ones, and how they change in time."""

from cellcrawl.parameters.conditions import Conditions
from cellcrawl.parameters.dimensionless import DESCRIPTIONS, ELASTICITIES, Parameters
from cellcrawl.parameters.physical import QUANTITIES, PhysicalParameters
from cellcrawl.parameters.scales import KINDS, Scales
from cellcrawl.parameters.schedule import CONSTANT, Schedule
from cellcrawl.parameters.temperature import ActivationEnergies

__all__ = [
    "CONSTANT",
    "DESCRIPTIONS",
    "ELASTICITIES",
    "KINDS",
    "QUANTITIES",
    "ActivationEnergies",
    "Conditions",
    "Parameters",
    "PhysicalParameters",
    "Scales",
    "Schedule",
]
