"""The paper's claims about the resting circle: its section on linear stability, and Fig. 2."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Final

import numpy as np

from cellcrawl.linear import (
    base_state,
    cutoff_wavenumber,
    growth_rates,
    hopf_points,
    oscillation_onset,
    unstable_modes,
)
from cellcrawl.linear.characteristic import characteristic
from cellcrawl.parameters import DESCRIPTIONS, Parameters
from cellcrawl.verification.check import Result, complex_text
from cellcrawl.verification.claims import (
    DISCUSSION,
    STABILITY,
    claim,
    count,
    spread,
)

FIGURE: Final = Parameters(r_on=20, zeta_1=600, D=0.01)
"""The cell that the families of Fig. 2 start from."""

PLANE: Final[dict[str, Any]] = {
    "r_on": np.linspace(10.0, 60.0, 51)[:, None],
    "zeta_1": np.linspace(400.0, 600.0, 41),
}
"""On-rates and adhesion strengths of the diagram of Fig. 4."""

_DRAWS: Final = 20_000


def any_parameters() -> dict[str, np.ndarray]:
    """Return parameters drawn from the whole range the package supports, always the same."""
    draw = np.random.default_rng(0)
    return {name: draw.uniform(d.low, d.high, _DRAWS) for name, d in DESCRIPTIONS.items()}


def breathing(full: bool) -> Iterator[Result]:
    """Measure the claims about k = 0."""
    for law in ("consistent", "printed"):
        growth = [
            growth_rates(Parameters(elasticity=law, D=D), 0, **PLANE)[..., 0].real
            for D in (0.01, 0.05, 0.1)
        ]
        share = float(np.mean([g > 0.0 for g in growth]))
        highest = float(np.max(growth))
        at = growth_rates(Parameters(elasticity=law), 0)[0]
        yield claim(
            f"the breathing mode k = 0 decays at physiological stiffness ({law} tension law)",
            f"{STABILITY}, Fig. 2",
            "decays at all of r_on = 10 to 60, zeta_1 = 400 to 600, D = 0.01 to 0.1",
            f"grows at {100 * share:.0f} % of them; highest rate {highest:.3g}",
            share == 0.0,
            unless="the law as printed lacks a factor 1/epsilon, and its membrane is too soft to "
            f"hold the breathing mode: {at.real:.2f} ± {abs(at.imag):.1f}i at (25, 600). The "
            "paper's k = 0 theory is that of the consistent law"
            if law == "printed"
            else "",
            highest=highest,
        )
    stiffness = {
        law: growth_rates(
            Parameters(elasticity=law), [0, 1, 2, 8, 15], k_sigma=10.0 ** _column(2, 5)
        )
        for law in ("printed", "consistent")
    }
    others = max(float(np.abs(np.ptp(g[:, 1:], axis=0)).max()) for g in stiffness.values())
    breath = min(float(np.abs(np.ptp(g[:, 0], axis=0)).max()) for g in stiffness.values())
    yield claim(
        "only k = 0 feels the stiffness of the membrane",
        STABILITY,
        "rates of k = 1, 2, 8, 15 the same for k_sigma = 100 to 100,000; those of k = 0 not",
        f"they change by {others:.1g}, and by {breath:.2g} at k = 0",
        others < 1e-9 < breath,
    )


def _column(low: float, high: float) -> np.ndarray:
    return np.linspace(low, high, 7)[:, None]


def translation(full: bool) -> Iterator[Result]:
    """Measure the claims about k = 1."""
    values = any_parameters()
    growth = growth_rates(Parameters(), np.arange(61)[:, None], **values)
    frequency = float(np.abs(growth[1].imag).max())
    yield claim(
        "the growth rate of k = 1 is real whatever the parameters",
        STABILITY,
        f"frequency 0 for {_DRAWS:,} parameter sets of the whole range",
        f"largest frequency {frequency:.2g}",
        frequency == 0.0,
    )
    tense = characteristic(Parameters(), 2, values).stiffness > 0.0
    first = growth[..., 0].real
    grows = first[1] > 1e-9
    fastest = first.argmax(axis=0) == 1
    yield claim(
        "k = 1 is the fastest mode wherever it grows",
        f"{STABILITY}; {DISCUSSION}",
        "k = 1 ahead of k = 0 and 2 to 60 at every unstable set with the circle under tension",
        f"{count(fastest[grows & tense])} sets",
        np.all(fastest[grows & tense]),
        note="the circle is under tension unless contraction exceeds its friction; then the "
        "shortest waves grow fastest",
    )
    alone = first[2:].max(axis=0) > 1e-9
    yield claim(
        "no other mode of shape grows unless k = 1 does",
        STABILITY,
        "none of k = 2 to 60 grows where k = 1 does not, the circle under tension",
        f"{int(np.sum(alone & tense & ~grows))} of {int(np.sum(tense & ~grows))} sets",
        not np.any(alone & tense & ~grows),
    )
    shapes = {k: _first_order_shape(k) for k in (1, 2, 3, 5, 8)}
    yield claim(
        "k = 1 is the only mode that moves the centre of mass",
        STABILITY,
        "shift of the centroid over amplitude: 1 for k = 1, 0 for others",
        ", ".join(f"k = {k}: {abs(shift):.2g}" for k, (shift, _) in shapes.items()),
        abs(shapes[1][0] - 1.0) < 1e-3 and all(shapes[k][0] < 1e-3 for k in shapes if k > 1),
    )
    without = [k for k, (_, asymmetry) in shapes.items() if asymmetry > 0.5]
    yield claim(
        "k = 1 is the only mode that lacks a centre of symmetry",
        STABILITY,
        "edges of k = 2, 3, 5, 8 are mapped on themselves by half a turn",
        f"not so for k = {', '.join(map(str, without))}",
        without == [1],
        unless="half a turn takes every odd wave to its negative: a three- or five-sided cell has "
        "no centre of symmetry either. What sets k = 1 apart is that it moves the centre of mass",
    )


def _first_order_shape(k: int) -> tuple[float, float]:
    """Return the shift of the centroid and the oddness under half a turn, over the amplitude."""
    size, phi = 1e-3, 2.0 * math.pi * np.arange(720) / 720
    radius = 1.0 + size * np.cos(k * phi)
    area = 0.5 * np.mean(radius**2)
    shift = abs(np.mean(radius**3 * np.exp(1j * phi))) / (3.0 * area)
    odd = 0.5 * np.abs(radius - np.roll(radius, 360)).max()
    return float(shift / size), float(odd / size)


def dispersion(full: bool) -> Iterator[Result]:
    """Measure the claims about how rates depend on the wavenumber."""
    families = _families()
    low = [np.all((g := growth_rates(p, 2)).imag == 0.0) and np.all(g.real > 0) for p in families]
    yield claim(
        "low wavenumbers have two real positive rates",
        f"{STABILITY}, Fig. 2",
        f"so at k = 2 in the {len(families)} unstable cells of the families",
        count(low),
        all(low),
    )
    onsets = [oscillation_onset(p, k=(1.0, 100.0)) for p in families]
    yield claim(
        "towards higher k the two rates become a complex pair, so that waves travel round the edge",
        f"{STABILITY}, Fig. 2",
        "the pair appears at a k between 2 and the highest that grows, in every family",
        f"first at k = {spread((found[0].value for found in onsets), '.1f')}",
        all(
            found and 2.0 < found[0].value < float(cutoff_wavenumber(p))
            for found, p in zip(onsets, families, strict=True)
        ),
        note="the paper calls this a Hopf bifurcation; no mode gains or loses stability there",
    )
    crossings = [hopf_points(p, k=(1.0, 100.0)) for p in families]
    yield claim(
        "beyond some wavenumber all modes decay",
        STABILITY,
        "one crossing of the axis, and no growth from there to k = 1000",
        f"highest k that grows: {spread((unstable_modes(p).max() for p in families), '.0f')}",
        all(
            len(found) == 1 and growth_rates(p, _beyond(p))[:, 0].real.max() < 0.0
            for found, p in zip(crossings, families, strict=True)
        ),
    )
    ratios = [_amplitude_ratios(FIGURE, k) for k in (3, 15)]
    yield claim(
        "a wavenumber has two independent perturbations, whose amplitude ratios are complex "
        "conjugates",
        STABILITY,
        "conjugate ratios of off-rate to radius, at k = 3 and k = 15",
        "; ".join(f"{complex_text(a)} and {complex_text(b)}" for a, b in ratios),
        all(a.imag != 0.0 and abs(a - b.conjugate()) < 1e-9 * abs(a) for a, b in ratios),
        unless="there are two, but they are conjugate only where the rates are a complex pair; at "
        "low k both are real",
    )


def _families() -> list[Parameters]:
    """Return the unstable cells of the families of Fig. 2, with values of our own choice."""
    varied = {
        "zeta_1": (500.0, 550.0, 600.0),
        "r_on": (15.0, 20.0, 30.0, 45.0),
        "D": (0.001, 0.01, 0.05, 0.1),
        "sigma_c": (0.0, 100.0, 200.0),
    }
    cells = [FIGURE.replace(**{name: value}) for name, values in varied.items() for value in values]
    return [p for p in cells if growth_rates(p, 2)[0].real > 0.0]


def _beyond(p: Parameters) -> np.ndarray:
    return np.arange(int(unstable_modes(p).max()) + 1, 1001)


def _amplitude_ratios(p: Parameters, k: int) -> tuple[complex, complex]:
    """Return off-rate over radius of both modes: ``lam R = -epsilon c r``."""
    a, b = (-growth_rates(p, k) / (p.epsilon * base_state(p).c)).tolist()
    return complex(a), complex(b)
