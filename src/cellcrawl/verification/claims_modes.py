"""The paper's claims about gliding and turning cells that need no classifier: Figs. 4 and 5.

Which mode a cell has, and where in the diagram, is for the sweeps: their checks belong beside
these, in a module of their own.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

from cellcrawl.observables import centroid_velocity, circularity, heading, speed, turning_rate
from cellcrawl.verification.check import Result
from cellcrawl.verification.claims import (
    DISCUSSION,
    MODES,
    TURNS,
    claim,
    count,
    crawl,
    spread,
    swing,
)
from cellcrawl.verification.turns import period, side_difference, turns

GLIDING = ((16, 600), (56, 560))
TURNING = {"rotational": (24, 540), "zigzag": (26, 600)}
_SETTLED = slice(50.0, None)


def settled(point: tuple[int, int], seed: int = 1) -> xr.Dataset:
    """Return the second half of a run of a hundred time units."""
    return crawl(*point, seed=seed, save_every=0.05).sel(time=_SETTLED)


def width_over_length(dataset: xr.Dataset) -> np.ndarray:
    """Return the extent across the heading over that along it, shape (time,)."""
    arms = (dataset["x"] - dataset["centroid_x"]) + 1j * (dataset["y"] - dataset["centroid_y"])
    turned = arms.values * np.exp(-1j * heading(dataset).values)[:, None]
    return np.asarray(np.ptp(turned.imag, axis=1) / np.ptp(turned.real, axis=1))


def gliding(full: bool) -> Iterator[Result]:
    """Measure the claims about cells that glide."""
    runs = {point: settled(point) for point in GLIDING}
    bends = [float(np.abs(turning_rate(run)).max()) for run in runs.values()]
    yield claim(
        "for the smallest and the largest on-rates cells move straight on",
        MODES,
        "turning rate below 0.01 from t = 50 to 100 at (16, 600) and (56, 560)",
        f"at most {max(bends):.1g}",
        max(bends) < 0.01,
    )
    tension = [swing(run["tension"]) for run in runs.values()]
    speeds = [swing(speed(run)) for run in runs.values()]
    yield claim(
        "a gliding cell is steady: its tension does not change",
        TURNS,
        "range of the tension below 0.2 % of its mean, of the speed below 2 %, t = 50 to 100",
        f"{100 * max(tension):.1g} %, {100 * max(speeds):.1g} %",
        max(tension) < 2e-3 and max(speeds) < 0.02,
    )
    corners = [_corners(runs[point]) for point in GLIDING]
    circle = [float(circularity(run).mean()) for run in runs.values()]
    yield claim(
        "gliding cells are triangular for small, nearly round for large on-rates",
        MODES,
        "(16, 600): three corners, circularity below 0.8; (56, 560): no corner, above 0.999",
        f"{corners[0]} corners, {circle[0]:.3f}; {corners[1]} corners, {circle[1]:.4f}",
        corners == [3, 0] and circle[0] < 0.8 and circle[1] > 0.999,
    )
    early = crawl(*GLIDING[0], seed=1, save_every=0.05)
    wide = width_over_length(early.sel(time=slice(2.0, 4.0))).max()
    late = width_over_length(runs[GLIDING[0]]).mean()
    yield claim(
        "a gliding cell passes through a fan on its way to a triangle",
        DISCUSSION,
        "at (16, 600) wider than long between t = 2 and 4, by more than at the end",
        f"width over length {wide:.2f}, later {late:.2f}",
        wide > 1.0 and wide > late,
    )
    symmetric = [float(np.abs(side_difference(run)).max()) for run in runs.values()]
    turned = [float(np.abs(side_difference(settled(p))).max()) for p in TURNING.values()]
    yield claim(
        "gliding cells are alike left and right, turning cells are not",
        MODES,
        "largest difference of the bound fraction between the flanks: gliding below 0.005, turning "
        "above 0.02",
        f"{max(symmetric):.1g}, {min(turned):.2g}",
        max(symmetric) < 5e-3 and min(turned) > 0.02,
    )


def _corners(run: xr.Dataset) -> int:
    """Return the number of places on the last edge where curvature exceeds 4."""
    sharp = run["curvature"].isel(time=-1).values > 4.0
    return int(np.count_nonzero(sharp & ~np.roll(sharp, 1)))


def turning(full: bool) -> Iterator[Result]:
    """Measure the claims about turns, Fig. 5."""
    seeds = range(1, 4 if full else 3)
    found = {
        name: [turns(settled(point, seed)) for seed in seeds] for name, point in TURNING.items()
    }
    for name, runs in found.items():
        told, every = f"{name}, {TURNING[name]}", [turn for run in runs for turn in run]
        rises = [turn.tension_rises and 0.3 < turn.tension_peak < 3.0 for turn in every]
        yield claim(
            f"tension rises during a turn and peaks before it ends ({name})",
            TURNS,
            f"rises when the cell turns fastest, and peaks 0.3 to 3 later, in every turn, {told}",
            f"{count(rises)}; peak {spread((t.tension_peak for t in every), '.2g')} later",
            all(rises),
        )
        ways = [[turn.way for turn in run] for run in runs]
        alternates = all(np.all(np.diff(way) != 0) for way in ways)
        yield claim(
            "zigzagging cells turn left and right by turns"
            if name == "zigzag"
            else "rotating cells always turn the same way",
            MODES,
            f"ways of the turns from t = 50 to 100, {told}, seeds 1 to {len(seeds)}",
            "; ".join("".join("L" if w > 0 else "R" for w in way) for way in ways),
            alternates if name == "zigzag" else all(np.all(np.diff(way) == 0) for way in ways),
        )
        inside = [turn.prepared * turn.way for turn in every]
        yield claim(
            f"before a turn linkers gather on the side the cell then turns to ({name})",
            TURNS,
            f"bound fraction of that flank above the other's, over 1 time unit before, {told}",
            f"by {spread(inside, '.3f')}",
            min(inside) > 0.0,
            unless="the difference is small there, and on the outer side; on the inner side "
            "linkers gather once the cell turns"
            if name == "rotational"
            else "",
            note=""
            if name == "rotational"
            else "flanks are the quarters around sideways; whole halves of the edge differ by less "
            "than a tenth of that, the other way",
        )
    run = settled(TURNING["zigzag"])
    tense, lateral = period(run, run["tension"].values), period(run, side_difference(run))
    yield claim(
        "strong adhesion changes sides with every turn of a zigzag, and the tension peaks at each",
        TURNS,
        "period of the difference between the flanks twice that of the tension, within 2 %",
        f"{lateral:.2f} and {tense:.2f}",
        abs(lateral / tense - 2.0) < 0.04,
    )
    ways = [np.sign(_net_turn(seed)) for seed in range(1, 41 if full else 21)]
    left = int(np.sum(np.array(ways) > 0.0))
    share = left / len(ways)
    yield claim(
        "a rotating cell is as likely to turn left as right",
        MODES,
        "between a quarter and three quarters of the seeds turn left at (24, 540)",
        f"{left} of {len(ways)}",
        0.25 <= share <= 0.75,
        note="a mirrored start gives the mirrored run, so the model has no preference",
    )


def _net_turn(seed: int) -> float:
    """Return how far a rotating cell turns in all, from t = 15 to 30."""
    late = crawl(*TURNING["rotational"], seed=seed, t_end=30.0).sel(time=slice(15.0, None))
    way = heading(late).values
    return float(way[-1] - way[0])


def shapes(full: bool) -> Iterator[Result]:
    """Measure the claims about the shapes of turning cells."""
    wide = {name: width_over_length(settled(point)) for name, point in TURNING.items()}
    fronts = {name: _front_curvature(settled(point)) for name, point in TURNING.items()}
    fans = [np.median(wide[name]) > 1.0 and np.median(fronts[name]) < 1.5 for name in TURNING]
    yield claim(
        "zigzagging and rotating cells are fans with curved fronts",
        MODES,
        "wider than long, curvature of the front between 0 and 1.5, half of the time",
        "; ".join(
            f"{name}: {np.median(wide[name]):.2f}, {np.median(fronts[name]):.2f}"
            for name in TURNING
        ),
        all(fans),
    )


def irregular(full: bool) -> Iterator[Result]:
    """Measure how irregular the cell at (44, 560) is, which the paper calls so."""
    steady = [_steady_turn(seed) for seed in range(1, 4 if full else 2)]
    yield claim(
        "at (44, 560) the cell moves irregularly (printed tension law)",
        MODES,
        "no steady turn, the same way and within 20 %, of more than 30 time units up to t = 200",
        f"steady for {spread(steady, '.0f')} time units",
        max(steady) < 30.0,
        unless="converged, the cell turns steadily one way for about a hundred time units between "
        "irregular bursts; the errors of the published step set off bursts all the time",
    )


def _steady_turn(seed: int) -> float:
    """Return the longest time for which the turn in 5 time units keeps its sign and size."""
    way = heading(crawl(44, 560, seed=seed, t_end=200.0, save_every=0.1)).values[100:]
    step = 50
    turned = way[step:] - way[:-step]
    longest = begin = 0
    for end in range(turned.size):
        while begin < end and not _alike(turned[begin : end + 1 : 10]):
            begin += 1
        longest = max(longest, end - begin)
    return 0.1 * (longest + step)


def _alike(turned: np.ndarray) -> bool:
    size = np.abs(turned)
    one_way = bool(turned.min() > 0.0 or turned.max() < 0.0)
    return one_way and bool(size.max() - size.min() < 0.2 * (size.max() + size.min()))


def _front_curvature(run: xr.Dataset) -> np.ndarray:
    """Return the curvature straight ahead, shape (time,)."""
    velocity = centroid_velocity(run).values
    way = np.arctan2(velocity[:, 1], velocity[:, 0])
    facing = np.abs(np.angle(np.exp(1j * (run["theta"].values - 0.5 * np.pi - way[:, None]))))
    ahead = facing.argmin(axis=1)
    return np.asarray(run["curvature"].values[np.arange(ahead.size), ahead])
