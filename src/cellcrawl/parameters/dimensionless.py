"""The model's dimensionless parameters (Table I of Chen, Saintillan & Rangamani 2023)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple

from cellcrawl.parameters.named import NamedFields
from cellcrawl.validation import one_of, real_number

ELASTICITIES: Final = ("printed", "consistent")


class Described(NamedTuple):
    """What a parameter means and the values it may take."""

    meaning: str
    low: float
    high: float


DESCRIPTIONS: Final[dict[str, Described]] = {
    "r_on": Described("binding rate of linkers, k_on / k_off0", 1.0, 200.0),
    "zeta_1": Described("adhesive over viscous friction, zeta_1 / zeta_0", 0.0, 2000.0),
    "D": Described("diffusivity of bound linkers along the edge", 0.001, 1.0),
    "epsilon": Described("adhesion length over cell radius, v_beta / (k_off0 R_0)", 1e-5, 0.1),
    "h": Described("lamellipodium height over cell radius", 0.0, 0.2),
    "sigma_c": Described("actomyosin contraction", 0.0, 1000.0),
    "k_sigma": Described("stiffness of the membrane against area", 0.0, 1e5),
    "r_p": Described("off-rate at which retrograde flow equals polymerization", 2.0, 500.0),
}


@dataclass(frozen=True, kw_only=True)
class Parameters(NamedFields):
    """Dimensionless parameters of one cell; immutable.

    Parameters
    ----------
    r_on : float
        Binding rate of the linkers over their unbinding rate at no force, 1 to 200.
    zeta_1 : float
        Adhesive over viscous friction (also printed alpha_1 and zeta in the paper), 0 to 2000.
    D : float
        Diffusivity of bound linkers along the edge, 0.001 to 1.
    epsilon : float
        Adhesion length over cell radius, 1e-5 to 0.1.
    h : float
        Lamellipodium height over cell radius, 0 to 0.2.
    sigma_c : float
        Actomyosin contraction, 0 to 1000.
    k_sigma : float
        Stiffness of the membrane against area, 0 to 1e5.
    r_p : float
        Off-rate at which the retrograde flow equals the polymerization velocity, 2 to 500.
    elasticity : {"printed", "consistent"}
        Reading of the tension law ``d sigma / dt = G dA / dt``: ``G = k_sigma`` as printed, which
        the paper's simulations use, or ``G = k_sigma / epsilon``, which follows from the paper's
        own scales and which its linear theory uses.

    Raises
    ------
    InputError
        For an unknown name, a wrong type or a value out of range.

    Examples
    --------
    >>> p = Parameters(r_on=26, zeta_1=600)
    >>> p.replace(D=0.01).D
    0.01
    """

    r_on: float = 25.0
    zeta_1: float = 600.0
    D: float = 0.05
    epsilon: float = 0.001
    h: float = 0.01
    sigma_c: float = 100.0
    k_sigma: float = 1000.0
    r_p: float = 50.0
    elasticity: str = "printed"

    def __post_init__(self) -> None:
        for name, described in DESCRIPTIONS.items():
            value = real_number(name, getattr(self, name), described.low, described.high)
            object.__setattr__(self, name, value)
        object.__setattr__(self, "elasticity", one_of("elasticity", self.elasticity, ELASTICITIES))

    @property
    def v_p(self) -> float:
        """Polymerization velocity ``r_p log r_p``, in units of v_beta."""
        return self.r_p * _logarithm(self.r_p)

    @property
    def n_bar(self) -> float:
        """Bound fraction of the resting circle, ``r_on / (r_on + r_p)``."""
        return self.r_on / (self.r_on + self.r_p)

    @property
    def sigma_bar(self) -> float:
        """Membrane tension of the resting circle of radius 1."""
        log_r = _logarithm(self.r_p)
        pull = self.r_p * log_r + self.zeta_1 * self.n_bar * log_r - self.sigma_c
        return pull / (1.0 + self.h)

    @property
    def tension_rate(self) -> float:
        """``G`` of the tension law ``d sigma / dt = G dA / dt``, for this `elasticity`."""
        return self.k_sigma if self.elasticity == "printed" else self.k_sigma / self.epsilon


def _logarithm(x: float) -> float:
    """Natural logarithm, the same bits on every machine."""
    from cellcrawl.numerics.elementary import natural_logarithm  # brings Numba

    return natural_logarithm(x)
