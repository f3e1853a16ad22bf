"""The paper's claims about how the resting circle depends on the parameters: Fig. 2 A to D."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Final

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.linear import (
    base_state,
    cutoff_wavenumber,
    growth_rates,
    oscillation_onset,
    unstable_modes,
)
from cellcrawl.linear.characteristic import characteristic
from cellcrawl.parameters import Parameters
from cellcrawl.verification.check import Result
from cellcrawl.verification.claims import DISCUSSION, EQUATIONS, STABILITY, claim, count
from cellcrawl.verification.claims_linear import FIGURE, PLANE

_ON_RATES: Final = np.linspace(1.0, 200.0, 400)


def dependence(full: bool) -> Iterator[Result]:
    """Measure the claims about how rates depend on the parameters, Fig. 2 A-D."""
    strengths = np.linspace(500.0, 640.0, 29)
    larger = growth_rates(FIGURE, np.arange(1, 8)[:, None], zeta_1=strengths)[..., 0].real
    modes = [_highest(FIGURE.replace(zeta_1=float(zeta_1))) for zeta_1 in strengths]
    rising = bool(np.all(np.diff(larger, axis=1) > 0.0))
    yield claim(
        "stronger adhesion makes modes grow faster, and more of them grow",
        f"{STABILITY}, Fig. 2A",
        "larger rate of k = 1 to 7, and highest growing k, rise with zeta_1 = 500 to 640",
        f"{'all rise' if rising else 'not all rise'}; highest k {modes[0]} to {modes[-1]}",
        rising and bool(np.all(np.diff(modes) >= 0)) and modes[-1] > modes[0],
        note="the smaller of two positive rates falls: their product hardly changes",
    )
    rate = _nontrivial(FIGURE, r_on=_ON_RATES)
    peak = int(rate.argmax())
    cutoffs = np.nan_to_num(cutoff_wavenumber(FIGURE, r_on=_ON_RATES))
    yield claim(
        "with the on-rate, growth first rises, then falls",
        f"{STABILITY}, Fig. 2B",
        "one maximum of the rate of k = 1, and of the highest growing k, over r_on = 1 to 200",
        f"at r_on = {_ON_RATES[peak]:.0f} and {_ON_RATES[cutoffs.argmax()]:.0f}",
        _one_peak(rate) and _one_peak(cutoffs),
    )
    yield claim(
        "the circle is stable for very small and very large on-rates",
        STABILITY,
        "k = 1 decays at r_on = 1 and 200 with zeta_1 = 600, and grows between",
        f"{rate[0]:.3g}, {rate.max():.3g}, {rate[-1]:.3g}",
        rate[0] < 0.0 < rate.max() and rate[-1] < 0.0,
    )
    threshold = _threshold()
    yield claim(
        "adhesion must be strong enough for any instability",
        f"{STABILITY}; {DISCUSSION}",
        "below some zeta_1 k = 1 decays at every on-rate, above it does not",
        f"the least zeta_1 is {threshold:.0f}",
        _nontrivial(FIGURE, r_on=_ON_RATES, zeta_1=threshold - 5.0).max() < 0.0
        and _nontrivial(FIGURE, r_on=_ON_RATES, zeta_1=threshold + 5.0).max() > 0.0,
    )
    diffusion = np.linspace(0.01, 0.1, 10)
    damped = growth_rates(FIGURE, np.array([1, 5, 10, 15])[:, None], D=diffusion)[..., 0].real
    change = damped[:, 0] - damped[:, -1]
    yield claim(
        "diffusion damps the higher modes",
        f"{STABILITY}, Fig. 2C",
        "rates of k = 5, 10 and 15 fall with D = 0.01 to 0.1, that of k = 1 by less than 2 %",
        f"over that range k = 1 by {change[0]:.2g}, k = 5, 10 and 15 by {change[1]:.2g}, "
        f"{change[2]:.2g} and {change[3]:.2g}",
        np.all(np.diff(damped[1:], axis=1) < 0.0) and change[0] < 0.02 * damped[0, 0],
    )
    contraction = np.linspace(0.0, 200.0, 9)
    pulled = growth_rates(FIGURE, np.array([1, 2, 5, 10, 15])[:, None], sigma_c=contraction)
    growth = pulled[..., 0].real
    gain = growth[:, -1] / growth[:, 0] - 1.0
    yield claim(
        "contraction destabilises, weakly",
        f"{STABILITY}, Fig. 2D",
        "rates of k = 2 to 15 rise, by less than 5 % from sigma_c = 0 to 200",
        f"by {100 * gain[1:].min():.1f} to {100 * gain[1:].max():.1f} %; k = 1 by "
        f"{100 * abs(gain[0]):.2g} %",
        np.all(np.diff(growth[1:], axis=1) > 0.0) and gain[1:].max() < 0.05,
        note="k = 1, the fastest, does not feel it",
    )
    born = {
        name: oscillation_onset(FIGURE, k=8, **{name: limits})
        for name, limits in (("zeta_1", (300.0, 1200.0)), ("r_on", (1.0, 200.0)))
    }
    yield claim(
        "high modes pass from real to complex rates as parameters vary",
        STABILITY,
        "k = 8 does so along zeta_1 and along r_on",
        ", ".join(f"{name} = {found[0].value:.1f}" for name, found in born.items() if found),
        all(born.values()),
    )


def mechanism(full: bool) -> Iterator[Result]:
    """Measure the claims about the biphasic friction and the feedback."""
    p = FIGURE
    r = np.linspace(1.0, 400.0, 40_000)

    def friction(zeta_1: float) -> np.ndarray:
        return np.asarray((r + zeta_1 * p.r_on / (p.r_on + r)) * np.log(r))

    weak, strong = (bool(np.any(np.diff(friction(z)) < 0.0)) for z in (200.0, 600.0))
    yield claim(
        "friction first rises, then falls with the retrograde flow, if adhesion is strong enough",
        f"{EQUATIONS}; {STABILITY}",
        "in steady binding at r_on = 20, a falling stretch with zeta_1 = 600, none with 200",
        f"{'a' if strong else 'no'} falling stretch, {'a' if weak else 'none'}",
        strong and not weak,
    )
    slope = np.gradient((r + 600.0 * p.r_on / (p.r_on + r)) * np.log(r), r)
    falls = float(np.interp(p.r_p, r, slope)) < 0.0
    grows = bool(_nontrivial(p, D=0.001) > 0.0)
    yield claim(
        "the instability is that of stick and slip: on the falling stretch the circle is unstable",
        f"{STABILITY}; {DISCUSSION}",
        "k = 1 grows (D = 0.001) just where friction falls at r = r_p, over the plane of Fig. 4",
        count(_falling(p, PLANE) == (_nontrivial(p, D=0.001, **PLANE) > 0.0)),
        falls == grows
        and float(np.mean(_falling(p, PLANE) == (_nontrivial(p, D=0.001, **PLANE) > 0.0))) > 0.999,
    )
    base = base_state(p)
    by_linkers = -p.zeta_1 * math.log(p.r_p) / base.a
    by_tension = (1.0 + p.h) / base.a
    yield claim(
        "fewer bound linkers speed unbinding up, less tension slows it down",
        f"{DISCUSSION}, Fig. 8",
        "off-rate falls with n, rises with sigma, at the resting circle",
        f"dr/dn = {by_linkers:.3g}, dr/dsigma = {by_tension:.2g}",
        by_linkers < 0.0 < by_tension,
    )


def _falling(p: Parameters, values: dict[str, Any]) -> np.ndarray:
    """Whether friction in steady binding falls with the off-rate at ``r_p``."""
    r_on, zeta_1, log_r = values["r_on"], values["zeta_1"], math.log(p.r_p)
    n = r_on / (r_on + p.r_p)
    slope = 1.0 + log_r + zeta_1 * n / p.r_p - zeta_1 * n * log_r / (r_on + p.r_p)
    return np.asarray(slope < 0.0)


def _nontrivial(p: Parameters, **values: Any) -> np.ndarray:
    """Return the rate of k = 1 that is not the shift's 0."""
    found = characteristic(p, 1, values)
    return np.asarray(-found.damping / found.a)


def _highest(p: Parameters) -> int:
    try:
        return int(unstable_modes(p).max(initial=0))
    except InputError:
        return 10**6


def _one_peak(values: np.ndarray) -> bool:
    peak = int(values.argmax())
    rises, falls = np.diff(values[: peak + 1]), np.diff(values[peak:])
    return bool(0 < peak < values.size - 1 and np.all(rises >= 0.0) and np.all(falls <= 0.0))


def _threshold() -> float:
    """Return the least adhesion strength with an instability at some on-rate, by bisection."""
    low, high = 0.0, 2000.0
    while high - low > 0.01:
        middle = 0.5 * (low + high)
        if _nontrivial(FIGURE, r_on=_ON_RATES, zeta_1=middle).max() > 0.0:
            high = middle
        else:
            low = middle
    return high
