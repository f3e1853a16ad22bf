"""The noise of few bonds: variances and speeds that theory gives, whatever grid and step."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Final, NamedTuple

import numpy as np

from cellcrawl.bench.cases import check_start
from cellcrawl.linear.theory import base_state
from cellcrawl.observables.motion import centroid_velocity
from cellcrawl.parameters import Parameters
from cellcrawl.simulation import simulate
from cellcrawl.starts import PerturbedCircle
from cellcrawl.verification.check import Result, at_least, at_most, near

# Without adhesive friction the off-rate does not ask for the linkers: it is held
_HELD: Final = Parameters(r_on=26.0, zeta_1=0.0)
_RESTING: Final = Parameters(r_on=60.0, zeta_1=500.0)
_FEW = 200.0
_MANY = 2e6  # theory is of first order in 1 / bonds: at 20,000 the speed is a tenth less
_DEVIATIONS = 4.0  # of the mean of so many independent records
_SETTLING = 1.0


class Ratio(NamedTuple):
    """A measured variance over that of theory, and its standard error."""

    value: float
    error: float


def _bound(p: Parameters, t_end: float, every: float, **options: Any) -> np.ndarray:
    """Bound fraction of a noisy circle, shape (records, nodes)."""
    run = simulate(
        p, t_end, start=PerturbedCircle(), solver="stochastic", save_every=every, **options
    )
    return np.asarray(run["bound_fraction"].values[math.ceil(_SETTLING / every) :])


def wave_ratio(p: Parameters, bonds: float, highest: int, t_end: float, **options: Any) -> Ratio:
    """Power of the first waves of n along a circle whose off-rate is held, over theory.

    ``<|n_k|^2> = n (1 - n) / (bonds L) * q / (q + D k^2)``, ``q = r_on + r``.
    """
    rate = p.r_on + p.r_p
    every = 2.0 / rate  # exp(-4) of a record's power is left in the next
    n = _bound(p, t_end, every, bonds=bonds, **options)
    waves = np.abs(np.fft.rfft(n, axis=1) / n.shape[1])[:, 1 : highest + 1] ** 2
    k = np.arange(1, highest + 1)
    theory = p.n_bar * (1.0 - p.n_bar) / (bonds * 2.0 * math.pi) * rate / (rate + p.D * k**2)
    ratio = waves / theory
    return Ratio(float(ratio.mean()), 1.0 / math.sqrt(ratio.size))


def arc_ratio(p: Parameters, bonds: float, part: int, t_end: float, **options: Any) -> Ratio:
    """Variance of the mean of n over arcs, 1 / ``part`` of a circle each, over theory."""
    rate = p.r_on + p.r_p
    n = _bound(p, t_end, 2.0 / rate, bonds=bonds, **options)
    means = n.reshape(len(n), part, -1).mean(axis=2)
    arc, reach = 2.0 * math.pi / part, math.sqrt(p.D / rate)
    theory = p.n_bar * (1.0 - p.n_bar) / (bonds * arc)
    theory *= 1.0 - reach / arc * (1.0 - math.exp(-arc / reach))
    value = float(np.mean((means - p.n_bar) ** 2)) / theory
    return Ratio(value, math.sqrt(2.0 / means.size))


def speed_ratio(p: Parameters, bonds: float, t_end: float, **options: Any) -> Ratio:
    """Mean square of a component of the velocity of a noisy cell at rest, over theory."""
    base = base_state(p)
    decay = p.r_on + p.r_p + p.D - base.b / base.a
    run = simulate(
        p,
        t_end,
        start=PerturbedCircle(),
        solver="stochastic",
        bonds=bonds,
        save_every=0.5 / decay,
        **options,
    )
    velocity = centroid_velocity(run).values[math.ceil(2.0 * _SETTLING * decay) :]
    gain = p.epsilon * base.c * p.zeta_1 * math.log(p.r_p) / base.a
    theory = gain**2 * p.r_p * p.n_bar / (math.pi * bonds * decay)
    independent = velocity.size * math.tanh(0.5)  # of records half a decay apart
    return Ratio(float(np.mean(velocity**2)) / theory, math.sqrt(2.0 / independent))


def _as_theory(what: str, found: Ratio, slack: float = 0.0) -> Result:
    return near(what, found.value, 1.0, round(_DEVIATIONS * found.error + slack, 4))


def spectrum(full: bool) -> Iterator[Result]:
    """Variances of the linkers with the off-rate held, on grids and steps of all sizes."""
    t_end = 200.0 if full else 20.0
    for nodes, dt in ((64, 1e-3), (64, 1e-2), (128, 2e-3), (256, 2e-3))[: 4 if full else 3]:
        yield _as_theory(
            f"power of the waves 1 to 8 of n over theory, {_FEW:g} bonds, r held, "
            f"{nodes} nodes, dt = {dt:g}",
            wave_ratio(_HELD, _FEW, 8, t_end, nodes=nodes, dt=dt),
            0.005,
        )
    for part in (4, 16):
        yield _as_theory(
            f"variance of the mean of n over a {part}th of the edge over theory, r held",
            arc_ratio(_HELD, _FEW, part, t_end, nodes=256, dt=2e-3, noise_seed=2),
            0.005,
        )
    sharp = _HELD.replace(D=0.001)
    yield _as_theory(
        "the same over a 16th with D = 0.001, where cutting n off at 0 and 1 would take 9 percent",
        arc_ratio(sharp, _FEW, 16, t_end, nodes=128, dt=2e-3, noise_seed=3),
        0.005,
    )
    n = _bound(sharp, t_end, 0.1, nodes=128, dt=2e-3, bonds=_FEW, noise_seed=4)
    independent = n.size * (1.0 - sharp.n_bar) / sharp.n_bar
    yield near(
        "mean of n over that at rest, D = 0.001",
        float(n.mean()) / sharp.n_bar,
        1.0,
        round(_DEVIATIONS * math.sqrt(2.0 / independent) + 1e-3, 4),
    )
    yield at_most("most that n leaves [0, 1]", float(max(-n.min(), n.max() - 1.0, 0.0)), 0.0)


def at_rest(full: bool) -> Iterator[Result]:
    """A noisy cell at rest: its speed, and the weak order of its error in the step."""
    t_end = 4000.0 if full else 500.0
    yield _as_theory(
        "mean square of the velocity over theory, (60, 500) at rest with 2e6 bonds, dt = 0.002",
        speed_ratio(_RESTING, _MANY, t_end if full else 200.0, nodes=64, dt=2e-3),
        0.01,
    )
    missed = {
        dt: 1.0 - speed_ratio(_RESTING, _MANY, t_end, nodes=32, dt=dt).value for dt in (1e-2, 5e-3)
    }
    for dt, error in missed.items():
        yield at_most(f"what a step of {dt:g} takes of it", error, 15.0 * dt)
    yield at_least(
        "weak order of that in the step, from 0.01 to 0.005",
        math.log2(missed[1e-2] / max(missed[5e-3], 1e-3)),
        1.0,
    )


def many_bonds(full: bool) -> Iterator[Result]:
    """Without noise the scheme is one of second order in the step and on the grid."""
    p = Parameters(r_on=26.0, zeta_1=600.0)
    start = check_start(p)
    true = simulate(p, 2.0, start=start, rtol=1e-8, save_every=1.0)

    def error(nodes: int, dt: float, bonds: float = 1e300) -> float:
        run = simulate(
            p,
            2.0,
            start=start,
            solver="stochastic",
            nodes=nodes,
            dt=dt,
            bonds=bonds,
            save_every=1.0,
        )
        return abs(float(run["length"][-1] - true["length"][-1]))

    coarse, fine = error(256, 2e-3), error(512, 1e-3)
    yield at_most("error of length at t = 2 without noise, (26, 600), 512 nodes", fine, 3e-3)
    yield at_least("order with nodes and steps together", math.log2(coarse / fine), 1.8)
    yield at_most(
        "difference of 1e20 bonds from none of the noise",
        abs(error(512, 1e-3, 1e20) - fine),
        1e-6,
    )
