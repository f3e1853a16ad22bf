"""Law sets: the model's pointwise formulas, those of the paper and others, and how to add one.

A law is a class with a formula for what differs from the paper's, and the numbers in it::

    class ForceOnRate(cc.laws.Law):
        \"\"\"Bonds form faster where others bear a load.\"\"\"

        gain = cc.laws.Parameter(0.1, 0.0, 10.0, "growth of the on-rate with the force on a bond")

        def binding(self, phi, r, n, p):
            return p.r_on * (1.0 + self.gain * phi) * (1.0 - n) - r * n

    run = cc.simulate(cc.Parameters(r_on=26), laws=ForceOnRate(gain=0.2))

Derivatives and compiled code are made from the formulas.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import Any, Final

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError, nearest_name
from cellcrawl.laws.catch_slip import CatchSlip
from cellcrawl.laws.check import check
from cellcrawl.laws.expressions import cos, exp, log, maximum, minimum, sin, sqrt, tanh, where
from cellcrawl.laws.law import PAPER, Law, Paper, Parameter, described
from cellcrawl.laws.load import PolymerizationUnderLoad
from cellcrawl.laws.myosin import SweptMyosin
from cellcrawl.laws.rest import RestState, rest_state, rest_states
from cellcrawl.laws.stiffness import Stiffness
from cellcrawl.validation import shown

SHIPPED: Final[dict[str, type[Law]]] = {
    "paper": Paper,
    "catch-slip": CatchSlip,
    "stiffness": Stiffness,
    "load": PolymerizationUnderLoad,
    "swept-myosin": SweptMyosin,
}
"""Law sets by the names that `simulate` and the command line take."""

__all__ = [
    "PAPER",
    "SHIPPED",
    "CatchSlip",
    "Law",
    "Paper",
    "Parameter",
    "PolymerizationUnderLoad",
    "RestState",
    "Stiffness",
    "SweptMyosin",
    "as_law",
    "check",
    "cos",
    "exp",
    "log",
    "maximum",
    "minimum",
    "rest_state",
    "rest_states",
    "sin",
    "sqrt",
    "tanh",
    "where",
]


@checked
def as_law(given: Any) -> Law:
    """Return a law set from itself, its class, a name, ``module:Class`` or what describes it.

    Raises
    ------
    InputError
        For anything else, or a name that is not known.
    """
    if isinstance(given, Law):
        return given
    if isinstance(given, type) and issubclass(given, Law):
        return given()
    if isinstance(given, Mapping):
        found: Law = described(given, Law, "law set")
        return found
    if not isinstance(given, str):
        raise InputError(
            f"laws must be a law set of cellcrawl.laws or the name of one, not {shown(given)}"
        )
    if given in SHIPPED:
        return SHIPPED[given]()
    module, separator, name = given.partition(":")
    if not separator:
        raise InputError(f"there is no law set {shown(given)}: {nearest_name(given, SHIPPED)}")
    try:
        imported = getattr(importlib.import_module(module), name)
    except (ImportError, AttributeError, ValueError) as error:
        raise InputError(f"the law set {shown(given)} cannot be imported: {error}") from None
    return as_law(imported)
