"""Whether a law can be used: derivatives, a unique root of the force balance, no NaN."""

from __future__ import annotations

from typing import Any

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.laws.law import Law
from cellcrawl.laws.rest import local_values, rest_state
from cellcrawl.parameters.dimensionless import Parameters

_FORCES = np.linspace(0.0, 6.0, 61)
_BOUND = np.linspace(0.02, 1.0, 50)


@checked
def check(law: Law, parameters: Parameters | None = None) -> None:
    """Raise `InputError` in one line if a law cannot be used at some parameters.

    Over forces on a bond up to 6 and bound fractions from 0.02 to 1 its formulas must be finite,
    their derivatives those of differences, and the balance of forces must rise with the force on a
    bond, so that it has one root. There must be a resting circle.

    Parameters
    ----------
    law : Law
    parameters : Parameters, optional
        The paper's unless given.

    Raises
    ------
    InputError
        For the first thing that is wrong.
    """
    cell = Parameters() if parameters is None else parameters
    rest = rest_state(cell, law)
    phi, n = np.meshgrid(_FORCES, _BOUND, indexing="ij")
    values: dict[str, Any] = {
        **local_values(cell, law), "phi": phi, "n": n, "sigma": rest.tension, "kappa": 1.0
    }  # fmt: skip
    evaluate = law.compiled.evaluate
    values["r"] = evaluate("off_rate", values)
    for what in ("off_rate", "velocity", "friction", "balance", "binding"):
        made = np.broadcast_to(evaluate(what, values), phi.shape)
        wrong = np.argwhere(~np.isfinite(made))
        if wrong.size:
            i, j = wrong[0]
            raise InputError(
                f"{law.name}: {what} is not finite at phi = {phi[i, j]:g}, n = {n[i, j]:g}"
            )
    if np.any(np.asarray(values["r"]) < 0.0):
        raise InputError(f"{law.name}: the off-rate is below 0 somewhere")
    slope = np.broadcast_to(evaluate("balance/phi", values), phi.shape)
    falls = np.argwhere(slope <= 0.0)
    if falls.size:
        worst = falls[np.argmax(n[tuple(falls.T)])]
        raise InputError(
            f"{law.name}: the balance of forces has no unique root for n up to "
            f"{n[tuple(worst)]:.3g}: friction less pull falls with the force on a bond at phi = "
            f"{phi[tuple(worst)]:.3g}"
        )
