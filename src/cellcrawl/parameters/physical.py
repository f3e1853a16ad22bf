"""A cell in SI units, and its dimensionless parameters."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.parameters.dimensionless import DESCRIPTIONS, ELASTICITIES, Parameters
from cellcrawl.parameters.named import NamedFields
from cellcrawl.parameters.quantities import as_written, magnitude_in, quantity
from cellcrawl.parameters.scales import LARGEST, SAME, SMALLEST, Scales
from cellcrawl.parameters.temperature import REFERENCE, ActivationEnergies, factors, kelvin
from cellcrawl.validation import one_of, real_number

_ROUNDING = 1e-12  # relative: a ratio this close to the end of its range is at the end


class Measured(NamedTuple):
    """A physical quantity: the paper's symbol, its SI unit, what it means, whether it may be 0."""

    symbol: str
    unit: str
    meaning: str
    may_be_zero: bool = False


QUANTITIES: Final[dict[str, Measured]] = {
    "radius": Measured("R_0", "m", "mean radius of the cell"),
    "off_rate": Measured("k_off^0", "1/s", "rate at which linkers unbind under no force"),
    "on_rate": Measured("k_on", "1/s", "rate at which linkers bind"),
    "adhesion_length": Measured("f_0/k_b", "m", "extension at which linkers unbind e times faster"),
    "viscous_friction": Measured("zeta_0", "N s/m^2", "friction of the retrograde flow"),
    "adhesive_friction": Measured("zeta_1", "N s/m^2", "friction by bound linkers", True),
    "diffusivity": Measured("D", "m^2/s", "diffusivity of bound linkers along the edge"),
    "lamellipodium_height": Measured("h", "m", "height of the lamellipodium", True),
    "contraction": Measured("sigma_c", "N/m", "actomyosin contraction", True),
    "membrane_stiffness": Measured("k_sigma", "N/m^3", "tension gained per area gained", True),
    "polymerization_speed": Measured("v_p", "m/s", "speed at which actin polymerizes"),
}


@dataclass(frozen=True, kw_only=True)
class PhysicalParameters(NamedFields):
    """A cell in SI units; immutable.

    Numbers are in SI; pint quantities of any unit of the right dimension are accepted (extra
    ``units``) and stored as SI numbers.

    Parameters
    ----------
    radius : float
        Mean radius of the cell R_0, in m.
    off_rate : float
        Rate k_off^0 at which linkers unbind under no force, in 1/s.
    on_rate : float
        Rate k_on at which linkers bind, in 1/s.
    adhesion_length : float
        Force scale of unbinding over linker stiffness, f_0/k_b, in m.
    viscous_friction : float
        Friction zeta_0 of the retrograde flow, in N s/m^2: force per length of edge over velocity.
    adhesive_friction : float
        Friction zeta_1 by bound linkers, in N s/m^2.
    diffusivity : float
        Diffusivity D of bound linkers along the edge, in m^2/s.
    lamellipodium_height : float
        Height h of the lamellipodium, in m.
    contraction : float
        Actomyosin contraction sigma_c, in N/m.
    membrane_stiffness : float
        Stiffness k_sigma of the membrane against area, in N/m^3.
    polymerization_speed : float
        Speed v_p at which actin polymerizes, in m/s.
    elasticity : {"printed", "consistent"}
        Reading of the tension law, as in `Parameters`. Only "consistent" is the physical law
        ``d sigma / dt = k_sigma dA / dt``; "printed", the paper's simulations, is that of a
        membrane ``1/epsilon`` (a thousand) times softer.

    Raises
    ------
    InputError
        For an unknown name, a wrong type or dimension, or a value that takes a dimensionless
        parameter out of its range.

    Notes
    -----
    The defaults are the paper's dimensionless values on one consistent set of scales for a
    keratocyte: R_0 = 10 um, k_off^0 = 0.1 1/s and f_0/k_b = 10 nm, hence v_beta = 1 nm/s; they are
    not the authors' own SI table. Frictions are fixed by the tension alone: zeta_0 = 200 N s/m^2
    is our choice, with which the resting tension is 0.9e-4 N/m, as in keratocytes.

    Examples
    --------
    >>> cell = PhysicalParameters(on_rate=2.6)
    >>> cell.dimensionless().r_on
    26.0
    >>> round(1e4 * cell.scales.to_physical(cell.dimensionless().sigma_bar, "tension"), 2)
    0.89
    """

    radius: float = 1e-5
    off_rate: float = 0.1
    on_rate: float = 2.5
    adhesion_length: float = 1e-8
    viscous_friction: float = 200.0
    adhesive_friction: float = 1.2e5
    diffusivity: float = 5e-13
    lamellipodium_height: float = 1e-7
    contraction: float = 2e-5
    membrane_stiffness: float = 1e9
    polymerization_speed: float = 50.0 * math.log(50.0) * 1e-9
    elasticity: str = "printed"

    def __post_init__(self) -> None:
        for name, measured in QUANTITIES.items():
            value = magnitude_in(name, getattr(self, name), measured.unit)
            low = 0.0 if measured.may_be_zero else SMALLEST
            value = real_number(name, value, low, LARGEST, unit=measured.unit)
            object.__setattr__(self, name, value)
        elasticity = one_of("elasticity", self.elasticity, ELASTICITIES)
        object.__setattr__(self, "elasticity", elasticity)
        self.dimensionless()

    @property
    def retrograde_velocity(self) -> float:
        """``v_beta = k_off^0 f_0 / k_b``, in m/s."""
        return self.off_rate * self.adhesion_length

    @property
    def scales(self) -> Scales:
        """What one dimensionless unit is for this cell."""
        return Scales(
            length=self.radius,
            time=1.0 / self.off_rate,
            retrograde_velocity=self.retrograde_velocity,
            viscous_friction=self.viscous_friction,
        )

    def dimensionless(self) -> Parameters:
        """Return the dimensionless parameters of this cell."""
        values = {name: self._ratio(name, ratio) for name, ratio in _RATIOS.items()}
        return Parameters(**values, elasticity=self.elasticity)

    @checked
    def at_temperature(
        self,
        temperature: Any,
        energies: ActivationEnergies | None = None,
        *,
        reference: Any = REFERENCE,
    ) -> PhysicalParameters:
        """Return this cell at another temperature.

        Rates follow Arrhenius's law, ``k(T) = k(T_0) exp(-(E/R) (1/T - 1/T_0))``: on-rate,
        off-rate, polymerization, diffusion, and one over the viscous friction. The force scale of
        Bell's law is ``f_0 = k_B T / delta``, delta the distance to the barrier, so the adhesion
        length ``f_0/k_b`` is proportional to T. The adhesive friction is the density of linkers
        times ``k_b / k_off^0``: linkers that let go sooner hold less. Radius, height and membrane
        stiffness are kept.

        Parameters
        ----------
        temperature : float
            In K, 260 to 330; a pint quantity of any unit (``quantity(30, "degC")``).
        energies : ActivationEnergies, optional
            How strongly heat speeds each process.
        reference : float
            Temperature of this cell's own values, in K; 298.15 unless given.

        Returns
        -------
        PhysicalParameters

        Raises
        ------
        InputError
            For a temperature that is no cell's, energies of another type, or a temperature at which
            a dimensionless parameter leaves its range.

        Notes
        -----
        Of the dimensionless parameters ``r_on`` moves as ``exp(-(E_on - E_off)/R (1/T - 1/T_0))``
        and ``zeta_1`` as ``exp((E_off - E_viscous)/R (1/T - 1/T_0))``: heat raises one only where
        binding, the other only where the flow past the viscous friction, has the higher activation
        energy. With the default energies r_on grows by 2.9 from 5 to 35 degrees Celsius, zeta_1, D,
        h and k_sigma stay, epsilon is proportional to T, sigma_c and v_p / v_beta to 1/T. The unit
        of time, ``1/k_off^0``, shrinks as the cell warms, by 8 over that range.

        Thermal damage and the slowing of enzymes above their optimum are not in it.

        Examples
        --------
        >>> cell = PhysicalParameters(on_rate=3.3)
        >>> round(cell.at_temperature(278.15).dimensionless().r_on, 1)
        16.0
        """
        if energies is None:
            energies = ActivationEnergies()
        if not isinstance(energies, ActivationEnergies):
            raise InputError(f"energies must be ActivationEnergies, not {type(energies).__name__}")
        warm = factors(energies, kelvin("temperature", temperature), kelvin("reference", reference))
        return self.replace(**{name: getattr(self, name) * times for name, times in warm.items()})

    @classmethod
    @checked
    def from_dimensionless(
        cls, parameters: Parameters, scales: Scales | None = None
    ) -> PhysicalParameters:
        """Return the cell with these dimensionless parameters on these scales.

        Parameters
        ----------
        parameters : Parameters
            The dimensionless cell.
        scales : Scales, optional
            Those of `PhysicalParameters` unless given, with the ``v_beta`` of this epsilon.

        Raises
        ------
        InputError
            If ``epsilon = v_beta / (k_off^0 R_0)`` differs between the two.
        """
        p = parameters
        if scales is None:
            usual = Scales()
            scales = usual.replace(retrograde_velocity=p.epsilon * usual.velocity)
        if abs(scales.epsilon - p.epsilon) > SAME * p.epsilon:
            raise InputError(
                f"the parameters have epsilon = {p.epsilon:g}, the scales {scales.epsilon:g}: "
                f"give scales with retrograde_velocity={p.epsilon * scales.velocity!r}"
            )
        rate = 1.0 / scales.time
        return cls(
            radius=scales.length,
            off_rate=rate,
            on_rate=p.r_on * rate,
            adhesion_length=p.epsilon * scales.length,
            viscous_friction=scales.viscous_friction,
            adhesive_friction=p.zeta_1 * scales.viscous_friction,
            diffusivity=scales.to_physical(p.D, "diffusivity"),
            lamellipodium_height=p.h * scales.length,
            contraction=scales.to_physical(p.sigma_c, "friction"),
            membrane_stiffness=scales.to_physical(p.k_sigma, "membrane_stiffness"),
            polymerization_speed=scales.to_physical(p.v_p, "retrograde_velocity"),
            elasticity=p.elasticity,
        )

    @checked
    def quantity(self, name: str) -> Any:
        """Return one value as a pint quantity."""
        one_of("name", name, QUANTITIES)
        return quantity(getattr(self, name), QUANTITIES[name].unit)

    def _ratio(self, name: str, ratio: _Ratio) -> float:
        """Return a dimensionless parameter; out of range, name the physical values behind it."""
        value: float = as_written(ratio.of(self))
        low, high = DESCRIPTIONS[name].low, DESCRIPTIONS[name].high
        nearest = min(max(value, low), high)
        if abs(value - nearest) <= _ROUNDING * nearest:
            return nearest
        field, *others = ratio.fields
        given = ", ".join(f"{other} = {self._text(other)}" for other in others)
        raise InputError(
            f"{field} = {self._text(field)} is out of range: {ratio.formula} = {value:g}, and "
            f"{name} must be from {low:g} to {high:g} (with {given})"
        )

    def _text(self, name: str) -> str:
        return f"{getattr(self, name):g} {QUANTITIES[name].unit}"


class _Ratio(NamedTuple):
    """How a dimensionless parameter follows: in words, the fields that enter, in numbers."""

    formula: str
    fields: tuple[str, ...]
    of: Callable[[PhysicalParameters], float]


_RATIOS: Final[dict[str, _Ratio]] = {
    "r_on": _Ratio(
        "r_on = k_on / k_off0", ("on_rate", "off_rate"), lambda p: p.on_rate / p.off_rate
    ),
    "zeta_1": _Ratio(
        "zeta_1 / zeta_0",
        ("adhesive_friction", "viscous_friction"),
        lambda p: p.adhesive_friction / p.viscous_friction,
    ),
    "D": _Ratio(
        "D / (k_off0 R_0^2)",
        ("diffusivity", "off_rate", "radius"),
        lambda p: p.diffusivity / (p.off_rate * p.radius**2),
    ),
    "epsilon": _Ratio(
        "epsilon = f_0 / (k_b R_0)",
        ("adhesion_length", "radius"),
        lambda p: p.adhesion_length / p.radius,
    ),
    "h": _Ratio(
        "h / R_0",
        ("lamellipodium_height", "radius"),
        lambda p: p.lamellipodium_height / p.radius,
    ),
    "sigma_c": _Ratio(
        "sigma_c / (zeta_0 v_beta)",
        ("contraction", "viscous_friction", "off_rate", "adhesion_length"),
        lambda p: p.contraction / (p.viscous_friction * p.retrograde_velocity),
    ),
    "k_sigma": _Ratio(
        "2 k_sigma R_0 / (zeta_0 k_off0)",
        ("membrane_stiffness", "radius", "viscous_friction", "off_rate"),
        lambda p: 2.0 * p.membrane_stiffness * p.radius / (p.viscous_friction * p.off_rate),
    ),
    "r_p": _Ratio(
        "r_p with r_p log r_p = v_p / v_beta",
        ("polymerization_speed", "off_rate", "adhesion_length"),
        lambda p: _off_rate_of_flow(p.polymerization_speed / p.retrograde_velocity),
    ),
}


def _off_rate_of_flow(velocity: float) -> float:
    """Return the ``r >= 1`` with ``r log r = velocity``: Newton from above, which cannot miss."""
    r = 1.0 + velocity
    for _ in range(100):
        following = (r + velocity) / (1.0 + math.log(r))
        if not following < r:
            break
        r = following
    return r
