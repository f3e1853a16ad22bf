"""The paper's claims about its numerics: its two schemes, its frame, its step."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.linear import growth_rates
from cellcrawl.linear.eigenmodes import linear_mode
from cellcrawl.parameters import Parameters
from cellcrawl.simulation import simulate
from cellcrawl.starts import RandomPerturbation
from cellcrawl.verification.agreement import disagreement, last, summary
from cellcrawl.verification.check import Result
from cellcrawl.verification.claims import NUMERICS, claim
from cellcrawl.verification.engines import frames, started
from cellcrawl.verification.modal import modal_amplitudes

CELL: Final = Parameters(r_on=25, zeta_1=600)
PUBLISHED: Final[dict[str, Any]] = {"nodes": 2000, "dt": 1e-3}


def short_times(full: bool) -> Iterator[Result]:
    """Measure a random start against linear theory, as the paper's Fig. S2 does."""
    time, waves = 0.1, 20
    cases: tuple[tuple[str, dict[str, Any], float], ...] = (
        ("adaptive", {"rtol": 1e-8}, 1e-3),
        ("paper", PUBLISHED, 0.2),
    )
    for solver, options, limit in cases:
        start = RandomPerturbation(1, amplitude=1e-6, modes=waves)
        ends = frames(started(solver, CELL, start, **options), (0.0, time))
        misses = []
        for k in range(1, waves + 1):
            before, after = (modal_amplitudes(frame, k, CELL.n_bar) for frame in ends)
            expected = _carried(k, before, time)
            misses.append(float(abs(after[1] - expected[1]) / abs(expected[1])))
        yield claim(
            f"at short times a simulation follows linear theory ({solver} solver)",
            f"{NUMERICS}, Fig. S2",
            f"amplitudes of k = 1 to {waves} in the bound fraction at t = {time:g} within "
            f"{100 * limit:g} %, random start",
            f"within {100 * max(misses):.2g} %",
            max(misses) < limit,
            note="the step of 1e-3 is long for waves that grow or turn at rates of 13"
            if solver == "paper"
            else "",
        )


def _carried(k: int, amplitudes: np.ndarray, time: float) -> np.ndarray:
    """Return amplitudes of radius and bound fraction of ``k`` after a time, by linear theory."""
    rates = growth_rates(CELL, k)
    modes = np.array([linear_mode(CELL, k, complex(rate))[:2] for rate in rates]).T
    if k == 1:  # the shift: radius alone, at rate 0
        modes[:, 1] = (1.0, 0.0)
    return np.asarray(modes @ (np.exp(rates * time) * np.linalg.solve(modes, amplitudes)))


def schemes(full: bool) -> Iterator[Result]:
    """Measure the claims about the two schemes."""
    paper, spline = (
        summary(last(CELL, 5.0, solver, **options))
        for solver, options in (("paper", PUBLISHED), ("spline", {}))
    )
    yield claim(
        "the scheme in tangent angle and length and one with splines agree excellently",
        NUMERICS,
        "length, tension, area (relative) and centroid at t = 5 within 1 %, published nodes and "
        "step, (25, 600)",
        f"within {100 * disagreement(paper, spline):.2g} %",
        disagreement(paper, spline) < 0.01,
        note="only with the transport term T n_s, which the paper does not print",
    )
    run = simulate(CELL, 5.0, start=RandomPerturbation(1), solver="paper", save_every=1.0)
    x, y = run["x"].values, run["y"].values
    chords = np.hypot(np.roll(x, -1, axis=1) - x, np.roll(y, -1, axis=1) - y)[:, :-1]
    uneven = float(np.max(np.ptp(chords, axis=1) / chords.mean(axis=1)))
    yield claim(
        "nodes stay equally spaced along the edge",
        NUMERICS,
        "chords between neighbours differ by less than 1 %, t = 0 to 5, published nodes and step",
        f"by {100 * uneven:.2g} %",
        uneven < 0.01,
    )
    for law in ("printed", "consistent"):
        p = CELL.replace(elasticity=law)
        try:
            status = simulate(p, 0.5, solver="paper", save_every=0.5, **PUBLISHED).attrs["status"]
        except InputError as error:
            status = str(error)
        yield claim(
            f"2000 nodes and a step of 1e-3 suffice ({law} tension law)",
            NUMERICS,
            "such a run is stable",
            status if status == "completed" else status.split(";")[0],
            status == "completed",
            unless="the breathing mode of that law decays at a rate of 3408, and the paper's "
            "explicit step of the tension must stay below 5.9e-4: its simulations were made with "
            "the law as printed, its theory with the other"
            if law == "consistent"
            else "",
        )
