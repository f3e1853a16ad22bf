"""How a cell's physical parameters change with temperature: Arrhenius's law and Bell's."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from cellcrawl.errors import InputError
from cellcrawl.parameters.named import NamedFields
from cellcrawl.parameters.quantities import magnitude_in
from cellcrawl.validation import real_number

GAS_CONSTANT: Final = 8.31446261815324
"""In J/(mol K)."""
REFERENCE: Final = 298.15
"""Temperature of a cell's own values unless said otherwise: 25 degrees Celsius, in K."""
_COLDEST, _HOTTEST = 260.0, 330.0  # K; keratocytes have been filmed from 267 to 308
_LEAST, _MOST = 1e3, 5e5  # J/mol; a smaller energy is one given in kJ/mol or kcal/mol
_ZERO_CELSIUS = 273.15


@dataclass(frozen=True, kw_only=True)
class ActivationEnergies(NamedFields):
    """How strongly heat speeds each process of a cell, as activation energies; immutable.

    Numbers are in J/mol; pint quantities are accepted. 50 kJ/mol doubles a rate every 10 K near
    room temperature.

    Parameters
    ----------
    on_rate : float
        Of the binding of linkers. The default, 75 kJ/mol (18 kcal/mol), is what Bell, Redmann and
        Terentjev (Biophysical Journal, 2019) found for the onset of spreading, which waits for
        adhesions to assemble, the same for two cell lines on soft and stiff ground.
    off_rate : float
        Of their unbinding under no force. The default, 50 kJ/mol, is the usual doubling every 10 K,
        for want of a measured one.
    polymerization_speed : float
        Of the growth of actin at the edge. Keratocytes of all fish crawl faster when warmed (Ream,
        Theriot and Somero, Journal of Experimental Biology 206, 4539, 2003); the default is that of
        ``off_rate``, with which ``v_p / v_beta`` hardly changes.
    viscous_friction : float
        Of the flow past what causes the viscous friction, which falls as the flow eases. The
        default is that of ``off_rate``, as if weak bonds caused it; for water it is 17 kJ/mol.
    diffusivity : float
        Of the diffusion of bound linkers along the edge; the default is that of ``off_rate``.
    contraction : float
        Of the contractile force; it does not change with temperature unless given.

    Raises
    ------
    InputError
        For an unknown name, or a value that is neither 0 nor from 1e3 to 5e5 J/mol.

    Notes
    -----
    Only differences matter to the mode of a cell, as a rate that all others follow is a change of
    the unit of time. See `PhysicalParameters.at_temperature`.
    """

    on_rate: float = 75e3
    off_rate: float = 50e3
    polymerization_speed: float = 50e3
    viscous_friction: float = 50e3
    diffusivity: float = 50e3
    contraction: float = 0.0

    def __post_init__(self) -> None:
        for name in self.field_names():
            field = f"ActivationEnergies {name}"
            value = magnitude_in(field, getattr(self, name), "J/mol")
            value = real_number(field, value, 0.0, _MOST, unit="J/mol")
            if 0.0 < value < _LEAST:
                raise InputError(
                    f"{field} = {value:g} J/mol is out of range: it must be 0 or from {_LEAST:g} "
                    f"to {_MOST:g} J/mol; 1 kJ/mol is 1000 J/mol, 1 kcal/mol is 4184"
                )
            object.__setattr__(self, name, value)


def arrhenius(energy: float, temperature: float, reference: float) -> float:
    """Return by what factor a rate grows from ``reference`` to ``temperature``, both in K.

    ``exp(-(E/R) (1/T - 1/T_0))`` with the activation energy ``E`` in J/mol.
    """
    return math.exp(-energy / GAS_CONSTANT * (1.0 / temperature - 1.0 / reference))


def factors(energies: ActivationEnergies, temperature: float, reference: float) -> dict[str, float]:
    """Return by what each physical parameter that depends on temperature is multiplied."""

    def grows(energy: float) -> float:
        return arrhenius(energy, temperature, reference)

    return {
        "on_rate": grows(energies.on_rate),
        "off_rate": grows(energies.off_rate),
        "adhesion_length": temperature / reference,  # f_0 = k_B T / (distance to the barrier)
        "viscous_friction": 1.0 / grows(energies.viscous_friction),
        "adhesive_friction": 1.0 / grows(energies.off_rate),  # density times k_b / k_off^0
        "diffusivity": grows(energies.diffusivity),
        "contraction": grows(energies.contraction),
        "polymerization_speed": grows(energies.polymerization_speed),
    }


def kelvin(name: str, value: object) -> float:
    """Return a temperature in K, from a number in K or a quantity, or raise `InputError`."""
    number = magnitude_in(name, value, "K")
    try:
        return real_number(name, number, _COLDEST, _HOTTEST, unit="K")
    except InputError as error:
        celsius = isinstance(number, (int, float)) and -20.0 <= number <= 60.0
        if not celsius or isinstance(number, bool):
            raise
        meant = f"{number:g} degrees Celsius are {number + _ZERO_CELSIUS:g} K"
        raise InputError(f"{error} ({meant})") from None
