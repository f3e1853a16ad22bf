"""Fields that are the same everywhere, or change evenly in space."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from cellcrawl.arguments import checked
from cellcrawl.laws.expressions import maximum, sqrt, tanh
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


class TensionGradient(Surrounding):
    """A membrane that flows through the cell: tension ``sigma + mu V . (x - c)``.

    ``V`` is the velocity of the cell and ``c`` its centroid: the front bears more than the rear.
    """

    source: ClassVar[str] = "Lieber et al., Biophys. J. 108, 1599 (2015), for the gradient"
    mu = Parameter(
        0.0, 0.0, 1e6, "gain of tension over one cell radius ahead at a speed of one R_0 k_off0"
    )

    def change(self, at: Place, p: Any) -> Mapping[str, Any]:
        ahead = at.velocity_x * at.arm_x + at.velocity_y * at.arm_y
        more = self.mu * ahead * (1.0 + at.curvature * p.h)
        return {"pressure": p.pressure + more}


@checked
class AlongEdge(Surrounding):
    """A local parameter that differs from front to rear, and with the curvature of the edge.

    It is ``1 + front c + bend tanh((kappa - 1) / sharp)`` times what it was, with ``c`` the cosine
    of the angle at the centroid from the direction of motion; ``c`` fades at speeds below ``slow``.

    Parameters
    ----------
    parameter : str
        Which: ``"r_on"``, ``"zeta_1"``, ``"v_p"``, ``"sigma_c"``, ...
    front, bend, sharp, slow : float
    """

    front = Parameter(0.0, -1.0, 1.0, "relative gain straight ahead, and loss at the rear")
    bend = Parameter(0.0, -1.0, 1.0, "relative gain where the edge is bent strongly outwards")
    sharp = Parameter(5.0, 1e-3, 1e3, "change of curvature, over 1 / R_0, that counts as strong")
    slow = Parameter(0.02, 1e-6, 1e3, "speed below which the cell has hardly a front")

    def __init__(self, parameter: str = "v_p", **values: float) -> None:
        super().__init__(**values)
        self.parameter = parameter

    def describe(self) -> dict[str, Any]:
        found = super().describe()
        return {**found, "values": {"parameter": self.parameter, **found["values"]}}

    def change(self, at: Place, p: Any) -> Mapping[str, Any]:
        ahead = at.velocity_x * at.arm_x + at.velocity_y * at.arm_y
        arm = at.arm_x * at.arm_x + at.arm_y * at.arm_y
        speed = at.velocity_x * at.velocity_x + at.velocity_y * at.velocity_y
        cosine = ahead / sqrt((arm + 1e-12) * (speed + self.slow * self.slow))
        bent = tanh((at.curvature - 1.0) / self.sharp)
        value = getattr(p, self.parameter) * (1.0 + self.front * cosine + self.bend * bent)
        return {self.parameter: value}
