"""What a cell is made of: dimensionless parameters, physical ones, and how they change in time."""

from cellcrawl.parameters.conditions import EDGE_ROWS, Conditions
from cellcrawl.parameters.dimensionless import DESCRIPTIONS, ELASTICITIES, Parameters
from cellcrawl.parameters.schedule import CONSTANT, Schedule

__all__ = [
    "CONSTANT",
    "DESCRIPTIONS",
    "EDGE_ROWS",
    "ELASTICITIES",
    "Conditions",
    "Parameters",
    "Schedule",
]
