"""Fields that are the same everywhere, or change evenly in space."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from cellcrawl.arguments import checked
from cellcrawl.laws.expressions import maximum
from cellcrawl.laws.law import Parameter
from cellcrawl.surroundings.base import Place, Surrounding


class UniformForce(Surrounding):
    """A force on each unit length of edge, along x and y: a flow, or gravity on a slope."""

    x = Parameter(
        0.0, -1e6, 1e6, "force along x on a unit length of edge, in units of the friction"
    )
    y = Parameter(0.0, -1e6, 1e6, "force along y on a unit length of edge")

    def change(self, at: Place, p: Any) -> Mapping[str, Any]:
        outward = self.x * at.normal_x + self.y * at.normal_y
        return {"pressure": p.pressure - outward}


class ElectricField(Surrounding):
    """A field that speeds polymerisation up on the side it points to: ``v_p + E . n``."""

    x = Parameter(0.0, -1e3, 1e3, "gain of polymerisation velocity where the normal is along x")
    y = Parameter(0.0, -1e3, 1e3, "gain of polymerisation velocity where the normal is along y")

    def change(self, at: Place, p: Any) -> Mapping[str, Any]:
        return {"v_p": p.v_p + self.x * at.normal_x + self.y * at.normal_y}


@checked
class Gradient(Surrounding):
    """A local parameter that changes evenly in space, and stays at ``least`` or above.

    Parameters
    ----------
    parameter : str
        Which: ``"r_on"``, ``"zeta_1"``, the ``"chi"`` of a ground that gives way, ...
    x, y : float
        Change of it over one cell radius along x and y.
    least : float
        Below this it does not fall.
    """

    x = Parameter(0.0, -1e6, 1e6, "change over one cell radius along x")
    y = Parameter(0.0, -1e6, 1e6, "change over one cell radius along y")
    least = Parameter(0.0, -1e12, 1e12, "value below which it does not fall")

    def __init__(self, parameter: str = "r_on", **values: float) -> None:
        super().__init__(**values)
        self.parameter = parameter

    def describe(self) -> dict[str, Any]:
        found = super().describe()
        return {**found, "values": {"parameter": self.parameter, **found["values"]}}

    def change(self, at: Place, p: Any) -> Mapping[str, Any]:
        value = getattr(p, self.parameter) + self.x * at.x + self.y * at.y
        return {self.parameter: maximum(value, self.least)}
