"""The paper's claims about trends with the adhesion parameters, at some points of Fig. 7.

The whole diagram is for the sweeps; these are averages at a few of its points, as the figure takes
them, t = 5 to 100.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from cellcrawl.observables import circularity, heading, mean_distance
from cellcrawl.verification.check import Result
from cellcrawl.verification.claims import TRENDS, claim, crawl, spread

ON_RATES = (16, 24, 32, 40, 48, 56)
STRENGTHS = (560, 580, 600)
ROTATIONAL, ZIGZAG = ((24, 540), (26, 540)), ((26, 600), (30, 580))


class Average(NamedTuple):
    """Averages over seeds and over t = 5 to 100 of the runs that do not tear."""

    circularity: float
    tension: float
    distance: float
    contrast: float
    """Bound fraction at the front less that at the rear."""


@functools.lru_cache(maxsize=64)
def average(point: tuple[int, int], seeds: int) -> Average:
    """Return the averages at one point."""
    rows: list[list[float]] = []
    for seed in range(1, seeds + 3):  # two more, for those that tear
        run = crawl(*point, seed=seed)
        if run.attrs["status"] != "completed" or len(rows) == seeds:
            continue
        late = run.sel(time=slice(5.0, None))
        facing = np.cos(late["theta"].values - 0.5 * np.pi - heading(late).values[:, None])
        n = late["bound_fraction"].values
        contrast = n[facing > 0.7].mean() - n[facing < -0.7].mean()
        rows.append(
            [
                float(circularity(late).mean()),
                float(late["tension"].mean()),
                mean_distance(run, after=5.0),
                contrast,
            ]
        )
    return Average(*np.mean(rows, axis=0).tolist())


def trends(full: bool) -> Iterator[Result]:
    """Measure the trends of circularity, tension and distance."""
    seeds = 5 if full else 1
    told = f"{seeds} seed{'s' if seeds > 1 else ''} a point, t = 5 to 100"
    grid = [[average((r_on, z), seeds) for r_on in ON_RATES] for z in STRENGTHS]
    round_ = np.array([[cell.circularity for cell in row] for row in grid])
    tension = np.array([[cell.tension for cell in row] for row in grid])
    contrast = np.array([[cell.contrast for cell in row] for row in grid])
    yield claim(
        "gliding cells at low on-rate are far from round, whatever the adhesion strength",
        f"{TRENDS}A",
        "circularity at r_on = 16 below 0.85, and the same within 0.05 for zeta_1 = 560 to 600",
        spread(round_[:, 0], ".3f"),
        round_[:, 0].max() < 0.85 and np.ptp(round_[:, 0]) < 0.05,
        note=told,
    )
    yield claim(
        "with the on-rate cells become rounder, whatever their mode",
        f"{TRENDS}A",
        "circularity rises along r_on = 16, 24, 32, 40, 48, 56 at zeta_1 = 560, 580, 600",
        f"from {spread(round_[:, 0], '.3f')} to {spread(round_[:, -1], '.4f')}; smallest rise "
        f"{np.diff(round_, axis=1).min():.2g}",
        np.all(np.diff(round_, axis=1) > 0.0),
        note=told,
    )
    yield claim(
        "for the difference in bound linkers between front and rear gets smaller",
        TRENDS,
        "that difference falls along the same on-rates",
        f"from {spread(contrast[:, 0], '.2f')} at r_on = 16 to "
        f"{spread(contrast[:, -1], '.2f')} at 56",
        np.all(np.diff(contrast, axis=1) < 0.0),
        note=told,
    )
    yield claim(
        "tension is set by on-rate and adhesion strength, and rises with both",
        f"{TRENDS}B",
        "mean tension rises along every row and column of the same points",
        f"{tension.min():.0f} to {tension.max():.0f}; smallest rises "
        f"{np.diff(tension, axis=1).min():.0f} and {np.diff(tension, axis=0).min():.0f}",
        np.all(np.diff(tension, axis=1) > 0.0) and np.all(np.diff(tension, axis=0) > 0.0),
        note=told,
    )
    circling = [average(point, seeds).distance for point in ROTATIONAL]
    for mode, points in (
        ("gliding cells of low on-rate and zigzagging cells", ((16, 600), *ZIGZAG)),
        ("gliding cells of high on-rate", ((56, 560),)),
    ):
        straight = [average(point, seeds).distance for point in points]
        yield claim(
            f"{mode} get farther than rotating ones",
            f"{TRENDS}C",
            f"mean distance at {_named(points)} above that at {_named(ROTATIONAL)}, which rotate",
            f"{spread(straight, '.1f')} against {spread(circling, '.1f')}",
            min(straight) > max(circling),
            unless="they move straight on but slowly, at a speed of 0.055, a quarter of that of "
            "the rotating cells"
            if points == ((56, 560),)
            else "",
            note=told,
        )
    along = [average((r_on, 580), seeds).distance for r_on in (28, 32, 36)]
    yield claim(
        "zigzags bend into arcs as the on-rate rises, and get less far",
        f"{TRENDS}C",
        "mean distance falls along r_on = 28, 32, 36 at zeta_1 = 580",
        ", ".join(f"{d:.1f}" for d in along),
        np.all(np.diff(along) < 0.0),
        note=told,
    )


def _named(points: tuple[tuple[int, int], ...]) -> str:
    return ", ".join(str(point) for point in points)
