"""Other laws and surroundings: growth rates and drifts that theory gives, limits that are known."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any, Final

import numpy as np
import xarray as xr

from cellcrawl.laws import (
    PAPER,
    CatchSlip,
    Law,
    Parameter,
    PolymerizationUnderLoad,
    Stiffness,
    SweptMyosin,
    rest_states,
    sqrt,
)
from cellcrawl.linear.any_law import law_growth_rates
from cellcrawl.linear.theory import base_state, growth_rates
from cellcrawl.parameters import Parameters
from cellcrawl.simulation import simulate
from cellcrawl.starts import PerturbedCircle
from cellcrawl.surroundings import Channel, Place, Surrounding
from cellcrawl.verification.check import Result, at_most, near

_RESTING: Final = ((60.0, 500.0), (58.0, 540.0))
_WEAK = 5e-4
_WITHIN = 1e-3  # of a drift: theory is of first order in what causes it
_CATCH: Final = CatchSlip(catch=40.0, catch_force=0.8, slip=0.6, slip_force=1.1)
# force on a resting bond, on-rate, growth rate of k = 1 by an independent code
_CAUGHT: Final = (
    (1.0, 10.0, -41.78),
    (1.6, 10.0, -32.55),
    (2.5, 10.0, -11.51),
    (3.5, 15.0, 15.206),
)
# stiffness, drift for a change of 0.001 along x at (26, 600), by an independent code
_SOFT: Final = (
    (0.5, -2.539e-3),
    (0.3, -3.825e-4),
    (0.25, -1.703e-4),
    (0.2, 4.98e-5),
    (0.1, 7.993e-4),
)


class Tilt(Surrounding):
    """Parameters that go with the cosine of the polar angle, a force and a field along x."""

    r_on = Parameter(0.0, -1.0, 1.0, "change of the on-rate")
    zeta_1 = Parameter(0.0, -1.0, 1.0, "change of the adhesive friction")
    force = Parameter(0.0, -10.0, 10.0, "force on a unit length of edge")
    field = Parameter(0.0, -10.0, 10.0, "gain of polymerisation along the normal")

    def change(self, at: Place, p: Any) -> Mapping[str, Any]:
        cosine = at.x / sqrt(at.x * at.x + at.y * at.y)
        return {
            "r_on": p.r_on + self.r_on * cosine,
            "zeta_1": p.zeta_1 + self.zeta_1 * cosine,
            "pressure": p.pressure - self.force * at.normal_x,
            "v_p": p.v_p + self.field * at.normal_x,
        }


class SoftTilt(Surrounding):
    """Stiffness that goes with the cosine of the polar angle."""

    chi = Parameter(0.0, -1.0, 1.0, "change of the stiffness")

    def change(self, at: Place, p: Any) -> Mapping[str, Any]:
        return {"chi": p.chi + self.chi * at.x / sqrt(at.x * at.x + at.y * at.y)}


def spectra(full: bool) -> Iterator[Result]:
    """Growth rates made from a law's own derivatives."""
    k = np.arange(21)
    worst = 0.0
    for point in (*_RESTING, (26.0, 600.0), (16.0, 600.0)):
        for elasticity in ("printed", "consistent"):
            p = Parameters(r_on=point[0], zeta_1=point[1], elasticity=elasticity)
            true = growth_rates(p, k)
            made = law_growth_rates(p, k, PAPER)
            worst = max(worst, float(np.max(np.abs(made - true) / (1.0 + np.abs(true)))))
    yield at_most(
        "growth rates of the paper's law from its derivatives against the closed quadratics, "
        "k = 0 to 20, relative",
        worst,
        1e-10,
    )
    for force, r_on, rate in _CAUGHT:
        flow = force * float(_CATCH.off_rate(force, None))
        p = Parameters(r_on=r_on, zeta_1=600.0, r_p=_rate_of_flow(flow))
        rest = min(rest_states(p, _CATCH), key=lambda state: abs(state.bond_force - force))
        found = law_growth_rates(p, np.array(1), _CATCH, rest)
        yield near(
            f"growth rate of k = 1 with catch-slip bonds that bear {force:g} at rest",
            _largest_apart_from_the_shift(found),
            rate,
            5e-4 * abs(rate),
        )
    cell = Parameters(r_on=26.0, zeta_1=600.0)
    yield near(
        "growth rate of k = 1 at (26, 600) with swept myosin, sweep = 1",
        float(growth_rates(cell, 1, laws=SweptMyosin(sweep=1.0))[0].real),
        47.4,
        0.05,
    )


def drifts(full: bool) -> Iterator[Result]:
    """Speeds at which weak surroundings move a cell at rest, against first-order theory."""
    for r_on, zeta_1 in _RESTING[: 2 if full else 1]:
        p = Parameters(r_on=r_on, zeta_1=zeta_1)
        base = base_state(p)
        n, c, q, log_r = p.n_bar, base.c, r_on + p.r_p + p.D, math.log(p.r_p)
        decay = -(base.b / base.a - q)
        told = f"({r_on:g}, {zeta_1:g}) at rest"
        pace = p.epsilon * c / (base.a * decay)
        for what, around, speed in (
            ("r_on + g cos phi", Tilt(r_on=_WEAK), pace * base.b * (1.0 - n) / n * _WEAK),
            ("zeta_1 + g cos phi", Tilt(zeta_1=_WEAK), pace * q * n * log_r * _WEAK),
            ("a force of 0.01 along x", Tilt(force=0.01), pace * q * 0.01),
            ("a field of 0.01 along x", Tilt(field=0.01), p.epsilon * 0.01),
        ):
            yield near(
                f"speed over theory with {what}, {told}",
                _drift(p, around) / speed,
                1.0,
                _WITHIN,
            )
    cell = Parameters(r_on=26.0, zeta_1=600.0)
    for chi, speed in _SOFT if full else _SOFT[3:4]:
        yield near(
            f"speed with chi + 0.001 cos phi at (26, 600), chi = {chi:g}",
            1e3 * _drift(cell, SoftTilt(chi=1e-3), Stiffness(chi=chi)),
            1e3 * speed,
            1e-3 * abs(1e3 * speed) + 5e-5,
        )


def limits(full: bool) -> Iterator[Result]:
    """Laws whose limits are runs that are known."""
    cell = Parameters(r_on=26.0, zeta_1=600.0)
    start = PerturbedCircle(
        {1: (0.01, 0.0), 2: (0.02, 0.0), 3: (0.0, 0.01)}, {1: (0.02, 0.01), 2: (0.0, 0.01)}
    )
    t_end = 3.0
    base = simulate(cell, t_end, start=start, rtol=1e-8)
    steep = PolymerizationUnderLoad(stall=3000.0, steepness=128.0)
    for what, law in (
        ("a rigid ground", Stiffness()),
        ("a steep law of load below the stall", steep),
    ):
        run = simulate(cell, t_end, start=start, rtol=1e-8, laws=law)
        yield at_most(f"{what} against the paper's law, (26, 600), t = 3", _apart(run, base), 1e-7)
    if not full:
        return
    soft = 0.6
    run = simulate(cell, t_end, start=start, rtol=1e-8, laws=Stiffness(chi=soft))
    # the same cell on a rigid ground: forces, speeds and the tension's stiffness go with chi
    stiff = _rigid_twin(cell, soft)
    twin = simulate(stiff, t_end, start=start, rtol=1e-8)
    yield at_most(
        f"a soft ground, chi = {soft:g}, against a rigid one with scaled parameters, t = 3",
        max(
            _apart(run, twin, ("length", "area", "centroid_x", "centroid_y")),
            float(np.abs(soft * run["tension"] / twin["tension"] - 1.0).max()),
        ),
        1e-6,
    )
    p, channel = Parameters(r_on=60.0, zeta_1=500.0), Channel(width=1.9, stiffness=1e4)
    run = simulate(p, 60.0, start=PerturbedCircle(), surroundings=channel, save_every=30.0)
    last = run.isel(time=-1)
    at = int(np.argmax(last["y"].values))
    pressure = channel.stiffness * (float(last["y"][at]) - 0.5 * channel.width)
    sigma, kappa = float(last["tension"]), float(last["curvature"][at])
    wanted = p.v_p + p.zeta_1 * p.n_bar * math.log(p.r_p) - p.sigma_c
    wanted -= sigma * (1.0 + kappa * p.h)
    yield near(
        "pressure of a wall over what balances the forces, (60, 500) squeezed in a channel of 1.9",
        pressure / wanted,
        1.0,
        5e-3,
    )


def _drift(p: Parameters, around: Surrounding, laws: Law = PAPER, t_end: float = 8.0) -> float:
    run = simulate(
        p,
        t_end,
        start=PerturbedCircle(),
        surroundings=around,
        laws=laws,
        save_every=0.5 * t_end,
        rtol=1e-7,
    )
    x = run["centroid_x"].values
    return float(x[-1] - x[1]) / (0.5 * t_end)


def _apart(
    run: xr.Dataset,
    base: xr.Dataset,
    names: tuple[str, ...] = ("tension", "length", "area", "centroid_x", "centroid_y"),
) -> float:
    """Largest difference of two runs, relative where a field is above 1."""
    return max(
        float((np.abs(run[name] - base[name]) / np.maximum(np.abs(base[name]), 1.0)).max())
        for name in names
    )


def _rigid_twin(p: Parameters, chi: float) -> Parameters:
    """Return the cell on a rigid ground that moves as ``p`` does on one of stiffness ``chi``."""
    return p.replace(
        zeta_1=chi * p.zeta_1,
        sigma_c=chi * p.sigma_c,
        epsilon=p.epsilon / chi,
        k_sigma=chi * p.k_sigma,
        r_p=_rate_of_flow(chi * p.v_p),
    )


def _rate_of_flow(flow: float) -> float:
    """Return the off-rate ``r`` of a slip bond with ``r log r = flow``, by Newton's method."""
    y = math.log1p(flow)
    for _ in range(100):
        y -= (y * math.exp(y) - flow) / (math.exp(y) * (1.0 + y))
    return math.exp(y)


def _largest_apart_from_the_shift(rates: np.ndarray) -> float:
    """Growth rate of k = 1 beside 0, that of a shift of the circle."""
    return float(max(rates.real, key=abs))
