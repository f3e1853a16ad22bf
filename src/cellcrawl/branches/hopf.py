"""From a Hopf point to the small orbits that are born there."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.branches.flow import Flow
from cellcrawl.branches.orbit import Orbit, nodes_or_none
from cellcrawl.branches.points import HOPF, SpecialPoint
from cellcrawl.branches.shooting import COARSE, Border, close, scaled, unscaled
from cellcrawl.branches.spectrum import ANTISYMMETRIC
from cellcrawl.branches.system import NotFound
from cellcrawl.curve import Curve
from cellcrawl.errors import InputError
from cellcrawl.starts.base import CellState
from cellcrawl.threads import on_one_thread
from cellcrawl.validation import real_number

_SMALL = 1e-4  # change of angle by which the direction of the orbits is measured
_NODES = 1024
_LEAST: Final = 1e-3


@checked
@on_one_thread
def from_hopf(point: SpecialPoint, *, amplitude: float = 0.01, nodes: int | None = None) -> Orbit:
    """Return a small orbit beside a Hopf point, stable or not.

    Parameters
    ----------
    point : SpecialPoint
        A Hopf point of a branch of gliding or turning cells.
    amplitude : float
        Mean change of angle and bound fraction from the steady cell, 1e-3 to 0.3; halved, down to
        1e-3, where Newton's method leads nowhere.
    nodes : int, optional
        Even nodes along the edge, a multiple of 8 from 64; as many as the shape asks for unless
        given.

    Raises
    ------
    InputError
        At another kind of point, or if no orbit is found.

    Notes
    -----
    The orbit is found at the amplitude, with the parameter as the unknown: on which side of the
    point it lies says whether the wobble sets in gently (stable orbits where the steady cell is
    unstable) or with a jump. The parameter is that of the point plus a multiple of the amplitude's
    square. An antisymmetric change comes back after half its period as its mirror image.
    """
    size = real_number("amplitude", amplitude, _LEAST, 0.3)
    count = nodes_or_none(nodes)
    if point.kind != HOPF or point.vector is None:
        raise InputError(f"orbits are born at a Hopf point, and this is a {point.kind}")
    setting = point.state.setting
    flow = Flow(setting, COARSE)
    ahead = _shape(flow, point, _SMALL) - _shape(flow, point, -_SMALL)
    direction = scaled(ahead) / np.linalg.norm(scaled(ahead))
    reflected = point.symmetry == ANTISYMMETRIC
    period = (1.0 if reflected else 2.0) * math.pi / point.frequency
    border = Border(point.name, direction, 0.0, 0.0, 1.0)
    why = ""
    while size >= _LEAST:
        guess = flow.canonical(_shape(flow, point, 0.0) + size * unscaled(direction))
        try:
            found = close(setting, reflected, guess, period, nodes=count, border=border)
        except (NotFound, np.linalg.LinAlgError) as error:
            why, size = str(error), 0.5 * size
            continue
        return Orbit.of(setting.replace(point.name, found.parameter), reflected, found)
    raise InputError(f"no orbit was found beside the Hopf point ({why}): give another amplitude")


def _shape(flow: Flow, point: SpecialPoint, amplitude: float) -> np.ndarray:
    """Return the shape of the steady cell with the point's change added."""
    state, setting = point.state, point.state.setting
    alpha = 2.0 * math.pi * np.arange(_NODES) / _NODES
    w, n, length = point.eigenvector(_NODES)
    base = [state.mesh.values(f, alpha) for f in (state.fields.w, state.fields.n)]
    theta = 0.5 * math.pi + alpha + base[0] + amplitude * w.real
    bound = np.clip(base[1] + amplitude * n.real, 0.0, 1.0)
    curve = Curve(theta, state.length + amplitude * float(np.real(length))).closed()
    return flow.from_cell(CellState(curve, bound, setting.tension(curve.area)))
