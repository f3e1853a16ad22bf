"""Why laws or surroundings do not suit a cell: no numbers, walls in it, no unique root."""

from __future__ import annotations

import dataclasses
from typing import Any, Final

import numpy as np

from cellcrawl.errors import CellcrawlError, InputError
from cellcrawl.laws.rest import local_values
from cellcrawl.solvers import Breakdown, Frame, Solver
from cellcrawl.solvers.conditions import Conditions
from cellcrawl.starts.base import CellState
from cellcrawl.surroundings import Place

_FAILED: Final = ("out_of_range", "step_too_small", "not_finite", "unresolved")
_NEVER_BELOW_0: Final = ("r_on", "zeta_1", "D", "epsilon", "h", "v_p")
_FORCES: Final = np.linspace(0.0, 6.0, 121)[:, None]
_AROUND: Final = (0.0, 1e-3, -1e-3, 1e-2)  # outwards from the edge, where the next step may be


def check_start(conditions: Conditions, state: CellState) -> None:
    """Raise `InputError` if surroundings cannot be had where the cell starts."""
    around = conditions.surroundings
    if around is None:
        return
    curve = state.curve
    for part in around.parts:
        conflict = part.conflict(curve.points)
        if conflict is not None:
            raise InputError(f"{part!r} {conflict}: give another start or place")
    x, y = curve.points.T
    wrong = _unusable(conditions, 0.0, x, y, curve.theta)
    if wrong is not None:
        raise InputError(f"{wrong}, under the edge of the start")


def explained(ended: Breakdown, solver: Solver, conditions: Conditions) -> Breakdown:
    """Return a breakdown with the law or surrounding that caused it named, if one did."""
    if ended.status not in _FAILED:
        return ended
    try:
        frame = solver.frame(solver.time)
    except (CellcrawlError, ValueError):
        return ended
    why = _ill_placed(conditions, frame) or _ill_made(conditions, frame)
    if why is None and conditions.surroundings is not None and ended.status == "out_of_range":
        around = conditions.around()
        if around is not None and around.moves and frame.curvature.min() > -50.0:
            why = "no velocity of the cell goes with what its surroundings make of it"
    if why is None:
        return ended
    return dataclasses.replace(ended, message=f"{why} at t = {ended.time:.6g}")


def _ill_placed(conditions: Conditions, frame: Frame) -> str | None:
    if conditions.surroundings is None:
        return None
    for ahead in _AROUND:
        x = frame.x + ahead * np.sin(frame.theta)
        y = frame.y - ahead * np.cos(frame.theta)
        found = _unusable(conditions, frame.time, x, y, frame.theta, frame)
        if found is not None:
            return found
    return None


def _unusable(
    conditions: Conditions,
    time: float,
    x: np.ndarray,
    y: np.ndarray,
    theta: np.ndarray,
    frame: Frame | None = None,
) -> str | None:
    """What a surrounding makes of a parameter that cannot be, and where; None if nothing."""
    place: dict[str, Any] = {"time": np.full_like(x, time), "x": x, "y": y}
    place |= {"normal_x": np.sin(theta), "normal_y": -np.cos(theta)}
    place |= {"arm_x": x - x.mean(), "arm_y": y - y.mean()}
    if frame is not None:
        place["curvature"] = frame.curvature
    now: dict[str, Any] = local_values(conditions.at(time), conditions.laws_at(time))
    assert conditions.surroundings is not None
    for part in conditions.surroundings.parts:
        with np.errstate(all="ignore"):
            changes = conditions.surroundings.after(part, now, Place(**place))
        for name, value in changes.items():
            values = np.broadcast_to(np.asarray(value, float), x.shape)
            bad = ~np.isfinite(values)
            if name in _NEVER_BELOW_0:
                bad |= values < 0.0
            if bad.any():
                i = int(np.argmax(bad))
                return (
                    f"{type(part).__name__} makes {name} = {values[i]:.4g} at x = {x[i]:.4g}, "
                    f"y = {y[i]:.4g}"
                )
        now |= changes
    return None


def _ill_made(conditions: Conditions, frame: Frame) -> str | None:
    """Whether a formula is no number, or the balance has several roots, near an edge's state."""
    laws = conditions.laws_at(frame.time)
    at: dict[str, Any] = dict(local_values(conditions.at(frame.time), laws))
    n = np.concatenate([frame.bound_fraction + change for change in _AROUND])
    at |= {"phi": _FORCES, "n": n, "sigma": frame.tension, "kappa": 1.0}
    with np.errstate(all="ignore"):
        at["r"] = laws.compiled.evaluate("off_rate", at)
        for what in ("off_rate", "velocity", "balance", "binding", "balance/phi"):
            values = np.broadcast_to(laws.compiled.evaluate(what, at), (_FORCES.size, n.size))
            is_slope = what == "balance/phi"
            bad = np.argwhere(values <= 0.0 if is_slope else ~np.isfinite(values))
            if bad.size:
                force, node = bad[0]
                told = "the balance of forces has no unique root" if is_slope else f"{what} is "
                told += "" if is_slope else "not finite"
                return (
                    f"under {laws!r} {told} where n = {n[node]:.3g} (phi = {_FORCES[force, 0]:.3g})"
                )
    return None
