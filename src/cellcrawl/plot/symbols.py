"""How the parameters and the numbers of linear theory are written."""

from __future__ import annotations

from typing import Final

PARAMETER_SYMBOLS: Final[dict[str, str]] = {
    "r_on": r"$r_\mathrm{on}$",
    "zeta_1": r"$\zeta_1$",
    "D": r"$D$",
    "epsilon": r"$\varepsilon$",
    "h": r"$h$",
    "sigma_c": r"$\sigma_c$",
    "k_sigma": r"$k_\sigma$",
    "r_p": r"$r_p$",
}
PARAMETER_NAMES: Final[dict[str, str]] = {
    "r_on": "on-rate",
    "zeta_1": "adhesion strength",
    "D": "diffusivity",
    "epsilon": "adhesion length",
    "h": "lamellipodium height",
    "sigma_c": "contraction",
    "k_sigma": "membrane stiffness",
    "r_p": "polymerization rate",
}
MEASURE_LABELS: Final[dict[str, str]] = {
    "confidence": "confidence in the mode",
    "speed": r"speed ($R_0k_\mathrm{off}^0$)",
    "turning_rate": r"turning rate (rad $k_\mathrm{off}^0$)",
    "tension": r"mean tension $\sigma$",
    "tension_low": r"least tension $\sigma$",
    "tension_high": r"largest tension $\sigma$",
    "tension_period": r"period of the tension ($1/k_\mathrm{off}^0$)",
    "circularity": r"circularity $4\pi A/L^2$",
    "x_c": r"mean distance from the start $x_c$ ($R_0$)",
    "area": r"area ($R_0^2$)",
    "length": r"length of the edge ($R_0$)",
}
GROWTH_LABEL: Final = r"growth rate $\mathrm{Re}\,\lambda_k$ ($k_\mathrm{off}^0$)"
FREQUENCY_LABEL: Final = r"frequency $\mathrm{Im}\,\lambda_k$ ($k_\mathrm{off}^0$)"
WAVENUMBER_LABEL: Final = "wavenumber $k$"


def parameter_label(name: str) -> str:
    """Return a parameter's name with its symbol."""
    return f"{PARAMETER_NAMES[name]} {PARAMETER_SYMBOLS[name]}"
