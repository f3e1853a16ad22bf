"""The paper's claims about how a round cell sets off: its section on k = 1, and Fig. 3."""

from __future__ import annotations

import functools
import math
from collections.abc import Iterator
from typing import Final, NamedTuple

import numpy as np

from cellcrawl.linear import growth_rates
from cellcrawl.observables import speed
from cellcrawl.parameters import Parameters
from cellcrawl.simulation import simulate
from cellcrawl.solvers import Frame
from cellcrawl.starts import RandomPerturbation
from cellcrawl.verification.check import Result
from cellcrawl.verification.claims import ONSET, claim, count, spread
from cellcrawl.verification.engines import frames, started
from cellcrawl.verification.modal import modal_amplitudes

CELL: Final = Parameters(r_on=25, zeta_1=600)
"""The cell of Fig. 3."""

_WAVES: Final = range(1, 101)
_FINE: Final = 40  # wavenumbers from here on are noise: the theory has k = 16 and above decay
_HALF: Final = math.pi / 4.0  # front, rear and sides are quarters of normals from the heading
TIMES: Final = (0.0, 0.25, 0.5, 1.0, 1.5, 2.0)


class Moment(NamedTuple):
    """What a cell is like at one time; front, sides and rear as means over the edge there."""

    waves: np.ndarray
    """Amplitudes of k = 1 to 100 in the bound fraction, where the edge allows polar angles."""
    bound_fraction: tuple[float, float, float]
    retrograde: tuple[float, float, float]
    off_rate: tuple[float, float, float]
    outward: tuple[float, float, float]
    friction: tuple[float, float, float]
    front_curvature: float
    friction_and_curvature: float
    """Their correlation along the edge."""
    speed: float
    width_over_length: float


@functools.lru_cache(maxsize=64)
def moments(seed: int) -> dict[float, Moment]:
    """Return the early moments of a cell from the paper's random start."""
    solver = started("adaptive", CELL, RandomPerturbation(seed), nodes=1024)
    return {frame.time: _moment(frame) for frame in frames(solver, TIMES)}


def _moment(frame: Frame) -> Moment:
    arms = frame.points - (frame.centroid_x, frame.centroid_y)
    velocity = (arms * frame.normal_velocity[:, None]).mean(axis=0) * frame.length / frame.area
    speed = float(np.hypot(*velocity))
    heading = math.atan2(velocity[1], velocity[0])
    facing = np.abs(np.angle(np.exp(1j * (frame.theta - 0.5 * math.pi - heading))))
    front, rear = facing < _HALF, facing > math.pi - _HALF
    sides = ~front & ~rear

    def thirds(values: np.ndarray) -> tuple[float, float, float]:
        return tuple(float(values[part].mean()) for part in (front, sides, rear))  # type: ignore[return-value]

    turned = (arms[:, 0] + 1j * arms[:, 1]) * np.exp(-1j * heading)
    r = frame.off_rate
    waves = [abs(modal_amplitudes(frame, k, CELL.n_bar)[1]) for k in _WAVES]
    return Moment(
        waves=np.array(waves),
        bound_fraction=thirds(frame.bound_fraction),
        retrograde=thirds(r * np.log(r)),
        off_rate=thirds(r),
        outward=thirds(frame.normal_velocity),
        friction=thirds(frame.friction),
        front_curvature=float(frame.curvature[front].max()),
        friction_and_curvature=float(np.corrcoef(frame.friction, frame.curvature)[0, 1]),
        speed=speed,
        width_over_length=float(np.ptp(turned.imag) / np.ptp(turned.real)),
    )


def lead(seed: int) -> float:
    """Return the share of k = 1 in the square of the bound fraction's waves at t = 1."""
    waves = moments(seed)[1.0].waves
    return float(waves[0] ** 2 / np.sum(waves**2))


def polarised(seed: int) -> bool:
    """Whether k = 1 has more than half of the square of the bound fraction's waves at t = 1."""
    return lead(seed) > 0.5


def noise(full: bool) -> Iterator[Result]:
    """Measure the claims about noise and k = 1 at early times."""
    seeds = range(1, 41 if full else 21)
    fine = np.array(
        [[np.linalg.norm(moments(s)[t].waves[_FINE - 1 :]) for t in (0.0, 0.5)] for s in seeds]
    )
    coarse = np.array([np.linalg.norm(moments(s)[0.5].waves[: _FINE - 1]) for s in seeds])
    yield claim(
        "high-frequency noise has decayed by t = 0.5",
        ONSET,
        f"waves k = {_FINE} to 100 of the bound fraction below a tenth of their start, and below "
        "1 % of the longer ones",
        f"at most {np.max(fine[:, 1] / fine[:, 0]):.2g} of their start, "
        f"{np.max(fine[:, 1] / coarse):.1g} of the longer ones",
        np.all(fine[:, 1] < 0.1 * fine[:, 0]) and np.all(fine[:, 1] < 0.01 * coarse),
        note=f"{len(seeds)} random starts",
    )
    leads = [polarised(seed) for seed in seeds]
    yield claim(
        "k = 1 outgrows the rest and makes one front and one rear by t = 1",
        ONSET,
        "more than half of the square of the bound fraction's waves in k = 1, in most of "
        f"{len(seeds)} random starts",
        count(leads),
        sum(leads) > 0.5 * len(leads),
        unless=f"k = 2 to 5 grow nearly as fast (rates {_rates_told()} for k = 1 to 5), and by "
        "t = 1 the waves have saturated: which of them leads is left to the start. Fig. 3 "
        "shows a start in which k = 1 does",
    )


def _rates_told() -> str:
    return ", ".join(f"{rate.real:.1f}" for rate in growth_rates(CELL, range(1, 6))[:, 0])


def front_and_rear(full: bool) -> Iterator[Result]:
    """Measure the claims about front, sides and rear, where k = 1 leads."""
    seeds = [seed for seed in range(1, 41 if full else 21) if polarised(seed)]
    told = f"{len(seeds)} random starts in which k = 1 leads"
    one, later, two = ([moments(s)[t] for s in seeds] for t in (1.0, 1.5, 2.0))
    n = np.array([m.bound_fraction for m in one])
    yield claim(
        "a front forms where more linkers are bound, and a rear with fewer",
        ONSET,
        "bound fraction at the front above that at the rear, t = 1",
        f"{spread(n[:, 0], '.2f')} against {spread(n[:, 2], '.2f')}",
        np.all(n[:, 0] > n[:, 2] + 0.1),
        note=told,
    )
    flow = np.array([m.retrograde for m in later])
    yield claim(
        "retrograde flow is slow at the front and fast at the rear",
        ONSET,
        f"slower than the polymerisation, {CELL.v_p:.1f}, at the front and faster at the rear, "
        "t = 1.5",
        f"{spread(flow[:, 0], '.0f')} against {spread(flow[:, 2], '.0f')}",
        np.all(flow[:, 0] < CELL.v_p) and np.all(flow[:, 2] > CELL.v_p),
    )
    outward = np.array([m.outward for m in later])
    speeds = [m.speed for m in later]
    yield claim(
        "the front expands, the rear shrinks, and the cell moves",
        ONSET,
        "normal velocity above 0 at the front, below 0 at the rear, speed above 0.1, t = 1.5",
        f"{spread(outward[:, 0], '.2f')}, {spread(outward[:, 2], '.2f')}, speed "
        f"{spread(speeds, '.2f')}",
        np.all(outward[:, 0] > 0.0) and np.all(outward[:, 2] < 0.0) and min(speeds) > 0.1,
    )
    bound = np.array([m.bound_fraction for m in two])
    yield claim(
        "at the front most linkers are bound, at the rear most are not",
        ONSET,
        "bound fraction above one half and below, t = 2",
        f"{spread(bound[:, 0], '.2f')} and {spread(bound[:, 2], '.2f')}",
        np.all(bound[:, 0] > 0.5) and np.all(bound[:, 2] < 0.5),
    )
    yield claim(
        "along the sides, too, most linkers are unbound",
        ONSET,
        "bound fraction below one half over the quarters that face sideways, t = 2",
        spread(bound[:, 1], ".2f"),
        np.all(bound[:, 1] < 0.5),
        unless="the bound fraction falls from front to rear along each side, and its mean there is "
        "about one half",
    )
    friction = np.array([m.friction for m in two])
    above = friction[:, 1] - friction[:, [0, 2]].max(axis=1)
    yield claim(
        "friction is highest along the sides",
        ONSET,
        "mean friction of the sides above that of front and rear, t = 2, in most of those starts",
        f"{count(above > 0.0)}, by {spread(above, '.1f')} of about {friction.mean():.0f}",
        np.mean(above > 0.0) > 0.5,
        note="friction hardly varies along the edge",
    )
    match = [m.friction_and_curvature for s in seeds for m in list(moments(s).values())[1:]]
    yield claim(
        "friction is high where curvature is",
        ONSET,
        "correlation of friction, from off-rate and linkers, with curvature above 0.999",
        f"at least {min(match):.6f}",
        min(match) > 0.999,
        note="tension and contraction being uniform, the force balance leaves no choice",
    )
    clear = [m for seed, m in zip(seeds, two, strict=True) if lead(seed) > 0.8]
    wide = [m.width_over_length for m in clear]
    fans = [m.width_over_length > 1.1 and m.front_curvature < 1.5 for m in clear]
    yield claim(
        "by t = 2 the cell is a fan with a smooth leading edge",
        ONSET,
        "wider than long by a tenth, curvature of the front below 1.5, where k = 1 has more than "
        "four fifths of the square at t = 1",
        f"{count(fans)}; width over length {spread(wide, '.2f')}",
        all(fans) and len(fans) > 1,
        note="with a lesser lead the front may be bumpy, or the cell not yet wide",
    )


def rest_or_motion(full: bool) -> Iterator[Result]:
    """Measure that motion begins just where k = 1 grows."""
    points = ((25, 600), (25, 500), (56, 560), (25, 400), (10, 500), (150, 600))
    speeds, growing = [], []
    for r_on, zeta_1 in points:
        p = Parameters(r_on=r_on, zeta_1=zeta_1)
        run = simulate(p, 40.0, start=RandomPerturbation(1), save_every=10.0)
        speeds.append(float(speed(run)[-1]))
        growing.append(bool(growth_rates(p, 1)[0].real > 1e-9))
    moving = [pace > 1e-2 for pace in speeds]
    yield claim(
        "a round cell sets off by itself where k = 1 grows, and nowhere else",
        ONSET,
        f"speed at t = 40 above 0.01 just where k = 1 grows, at {len(points)} points",
        ", ".join(f"{point}: {pace:.2g}" for point, pace in zip(points, speeds, strict=True)),
        moving == growing,
    )
