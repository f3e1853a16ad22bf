"""The paper's claims about which mode appears where, Fig. 4, named by the rule on turns."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from cellcrawl.linear import growth_rates
from cellcrawl.modes import classify, combine
from cellcrawl.parameters import Parameters
from cellcrawl.parameters.paper_cells import PAPER_MODES
from cellcrawl.verification.check import Result
from cellcrawl.verification.claims import MODES, TRENDS, claim, count, crawl

_WAVES: Final = np.arange(1, 41)


def diagram(full: bool) -> Iterator[Result]:
    """Name the modes of the nine cells, and of others over the whole diagram."""
    seeds = 5 if full else 3
    yield _named_cells(seeds)
    apart = (2, 20) if full else (10, 40)
    points = [
        (r_on, zeta_1) for zeta_1 in range(400, 601, apart[1]) for r_on in range(10, 61, apart[0])
    ]
    modes, shifts = {}, []
    for point in points:
        run = crawl(*point, save_every=0.5)
        modes[point] = classify(run).mode
        if run.attrs["status"] == "completed" and modes[point] != "stationary":
            resting = _cell(*point).sigma_bar
            shifts.append(float(run["tension"].sel(time=slice(5.0, None)).mean()) / resting - 1.0)
    told = f"{len(points)} points of r_on = 10 to 60, zeta_1 = 400 to 600, one seed each"
    agrees = [(modes[point] == "stationary") == _is_stable(*point) for point in points]
    yield claim(
        "a cell moves where linear theory calls the circle unstable, and rests elsewhere",
        MODES,
        "the named mode is stationary exactly where no wave grows",
        f"{count(agrees)} points agree, {count(_is_stable(*point) for point in points)} at rest",
        all(agrees),
        note=told,
    )
    largest = max(map(abs, shifts))
    yield claim(
        "the tension follows the adhesion parameters and not the mode",
        f"{TRENDS}B",
        "mean tension of every cell that moves within 6 % of the resting circle's",
        f"within {100.0 * largest:.2g} %",
        largest < 0.06,
        note=told,
    )


def _named_cells(seeds: int) -> Result:
    verdicts = {
        point: combine(classify(crawl(*point, seed=seed)) for seed in range(1, seeds + 1))
        for point in PAPER_MODES
    }
    wrong = [
        f"{point} {verdict.majority}"
        for point, verdict in verdicts.items()
        if verdict.majority != PAPER_MODES[point]
    ]
    right = [verdicts[point].majority == mode for point, mode in PAPER_MODES.items()]
    return claim(
        "the nine named cells glide, rotate, zigzag or do something else as labelled",
        MODES,
        "the majority of the starts, torn cells apart, has the paper's mode at all nine points",
        f"{count(right)}" + (f"; not {', '.join(wrong)}" if wrong else ""),
        all(right),
        note=f"{seeds} seeds a point. (44, 560) counts as other because it circles within its "
        "own outline: by the form of its track it rotates, see the page on modes",
    )


def _cell(r_on: float, zeta_1: float) -> Parameters:
    return Parameters(r_on=r_on, zeta_1=zeta_1)


def _is_stable(r_on: float, zeta_1: float) -> bool:
    rates = growth_rates(_cell(r_on, zeta_1), _WAVES)
    return bool(rates.real.max() <= 1e-9)
