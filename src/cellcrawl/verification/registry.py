"""All checks by name, in the order in which they are told."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial
from typing import Final

from cellcrawl.errors import InputError, nearest_name
from cellcrawl.verification import (
    agreement,
    along_edge,
    branches,
    claims_diagram,
    claims_linear,
    claims_modes,
    claims_numerics,
    claims_onset,
    claims_parameters,
    claims_robustness,
    claims_trends,
    geometry,
    growth,
    invariants,
    laws,
    long_runs,
    noise,
    orders,
    restart,
)
from cellcrawl.verification.check import Check

# What is not verified yet gets a module with functions that yield results, and lines here.
CHECKS: Final[tuple[Check, ...]] = (
    Check("curves", "geometry", geometry.curves),
    Check("frames", "geometry", geometry.of_solvers),
    *(
        Check(f"kept-by-{solver}", "invariants", partial(invariants.of_runs, solver))
        for solver in ("adaptive", "paper", "spline")
    ),
    Check("symmetries", "invariants", invariants.of_symmetry),
    *(
        Check(f"law-in-{solver}", "long-runs", partial(long_runs.law_in, solver))
        for solver in ("adaptive", "paper", "spline")
    ),
    Check("states", "long-runs", long_runs.states),
    Check("periods", "long-runs", long_runs.periods),
    Check("orders-of-adaptive", "orders", orders.of_adaptive),
    Check("orders-of-paper", "orders", orders.of_paper),
    Check("orders-of-spline", "orders", orders.of_spline),
    Check("growth-in-adaptive", "growth", growth.growth_in_adaptive),
    Check("growth-in-paper", "growth", growth.growth_in_paper),
    Check("deterministic-check", "agreement", agreement.with_reference),
    Check("between-solvers", "agreement", agreement.between_solvers),
    Check("resume", "restart", restart.of_solvers),
    Check("spectra", "laws", laws.spectra),
    Check("drifts", "laws", laws.drifts),
    Check("limits", "laws", laws.limits),
    Check("motion", "laws", along_edge.motion),
    Check("bond-noise", "laws", noise.spectrum),
    Check("noise-at-rest", "laws", noise.at_rest),
    Check("many-bonds", "laws", noise.many_bonds),
    Check("steady-states", "branches", branches.states),
    Check("crossings", "branches", branches.crossings),
    Check("orbits", "branches", branches.orbits),
    Check("growth-of-nearby-cells", "branches", branches.growth_of_nearby_cells),
    Check("basins", "branches", branches.basins_side_by_side),
    Check("breathing", "claims-linear", claims_linear.breathing),
    Check("translation", "claims-linear", claims_linear.translation),
    Check("dispersion", "claims-linear", claims_linear.dispersion),
    Check("dependence", "claims-linear", claims_parameters.dependence),
    Check("mechanism", "claims-linear", claims_parameters.mechanism),
    Check("short-times", "claims-numerics", claims_numerics.short_times),
    Check("schemes", "claims-numerics", claims_numerics.schemes),
    Check("noise", "claims-onset", claims_onset.noise),
    Check("front-and-rear", "claims-onset", claims_onset.front_and_rear),
    Check("rest-or-motion", "claims-onset", claims_onset.rest_or_motion),
    Check("gliding", "claims-modes", claims_modes.gliding),
    Check("turning", "claims-modes", claims_modes.turning),
    Check("shapes", "claims-modes", claims_modes.shapes),
    Check("irregular", "claims-modes", claims_modes.irregular),
    Check("diagram", "claims-modes", claims_diagram.diagram),
    Check("transitions", "claims-robustness", claims_robustness.transitions),
    Check("starts", "claims-robustness", claims_robustness.starts),
    Check("trends", "claims-trends", claims_trends.trends),
)

PARTS: Final[dict[str, str]] = {
    "geometry": "Geometry: ellipses, whose measures are known",
    "invariants": "Invariants: what no run may break",
    "long-runs": "Long runs: the tension law of the shape, exact states and periods",
    "orders": "Orders of accuracy in space and time",
    "growth": "Growth rates of the nonlinear solvers against linear theory",
    "agreement": "Agreement between solvers, and with independent programs",
    "restart": "Restart to the same bits",
    "laws": "Other laws and surroundings: theory and limits",
    "branches": "Branches: steady cells and where they lose their hold",
    "claims-linear": "Claims of the paper: linear stability",
    "claims-numerics": "Claims of the paper: its numerics",
    "claims-onset": "Claims of the paper: how a round cell sets off",
    "claims-modes": "Claims of the paper: motility modes",
    "claims-robustness": "Claims of the paper: starts and transitions",
    "claims-trends": "Claims of the paper: trends with the adhesion parameters",
}


def chosen(
    only: Iterable[str], full: bool, checks: Sequence[Check] | None = None
) -> tuple[Check, ...]:
    """Return the checks that are asked for by their names or those of their parts.

    A check that takes part in the long version only is taken if it is asked for by name.

    Raises
    ------
    InputError
        For a name that neither a part nor a check has.
    """
    known = CHECKS if checks is None else tuple(checks)
    asked = [only] if isinstance(only, str) else list(only)
    names = {check.name for check in known} | {check.part for check in known}
    for name in asked:
        if name not in names:
            raise InputError(f"there is no check or part {name!r}: {nearest_name(name, names)}")
    return tuple(
        check
        for check in known
        if check.name in asked
        or ((not asked or check.part in asked) and (full or not check.only_in_full))
    )
