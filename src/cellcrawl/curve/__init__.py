"""The cell edge: a closed curve with equally spaced nodes."""

from cellcrawl.curve.construct import (
    SelfCrossing,
    from_path,
    from_polar,
    from_polygon,
    polygon_area,
    simple_polygon,
)
from cellcrawl.curve.crossing import Crossing, first_crossing
from cellcrawl.curve.equal_arclength import Curve

__all__ = [
    "Crossing",
    "Curve",
    "SelfCrossing",
    "first_crossing",
    "from_path",
    "from_polar",
    "from_polygon",
    "polygon_area",
    "simple_polygon",
]
