"""A wide mixture of tracks with known modes: what the confidence of an answer is measured on.

The tracks of `synthetic` are those of a good microscope. These are those that people bring: from 12
records to 1,000, of three records a turn to hundreds, with localisation errors up to the step
itself, pauses, dropped frames, positions held over, wrong links and whole pixels.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from cellcrawl.modes.synthetic import SyntheticTrack

SHARES: Final = {
    "straight": ("gliding", 2.0),
    "straight with pauses": ("gliding", 1.0),
    "circle": ("rotational", 1.5),
    "uneven circle": ("rotational", 0.5),
    "circle with pauses": ("rotational", 0.5),
    "sine": ("zigzag", 1.0),
    "zigzag": ("zigzag", 1.0),
    "zigzag with pauses": ("zigzag", 0.5),
    "Brownian motion": ("other", 1.0),
    "persistent random walk": ("other", 1.25),
    "run and tumble": ("other", 0.75),
    "walk with pauses": ("other", 0.5),
    "loops": ("other", 0.5),
    "switching spin": ("other", 0.5),
    "one turn of a circling cell": ("rotational", 0.15),
    "one turn of a zigzag": ("zigzag", 0.2),
    "one turn of a walk": ("other", 0.3),
    "one swing of a zigzag": ("zigzag", 0.25),
    "one swing of a walk": ("other", 0.25),
    "at rest": ("stationary", 1.0),
    "comes to rest": ("stationary", 0.25),
}
"""Kinds of track, each with its mode and how often it is drawn, relative to the others."""
FEWEST, MOST = 12, 1000
_FINE = 8  # steps from one record to the next
_DEGREES = math.pi / 180.0


def mixture(
    count: int, seed: int, *, fewest: int = FEWEST, most: int = MOST
) -> Iterator[SyntheticTrack]:
    """Draw tracks of known mode.

    Parameters
    ----------
    count : int
        How many.
    seed : int
        Of the random numbers; the same seed gives the same tracks.
    fewest, most : int
        Records a track has; drawn evenly in their logarithm.

    Yields
    ------
    SyntheticTrack
    """
    kinds = list(SHARES)
    weights = np.array([share for _, share in SHARES.values()])
    for number in range(count):
        random = np.random.default_rng([seed, number])
        kind = kinds[int(random.choice(len(kinds), p=weights / weights.sum()))]
        records = round(_even_in_logarithm(random, fewest, most))
        path = _path(random, kind, records)
        yield SyntheticTrack(kind, SHARES[kind][0], *_recorded(random, kind, path, records))


def _even_in_logarithm(random: np.random.Generator, low: float, high: float) -> float:
    return math.exp(random.uniform(math.log(low), math.log(max(low, high))))


def _path(random: np.random.Generator, kind: str, records: int) -> np.ndarray:
    """Return a path (2, fine), in steps from record to record at full speed."""
    size = (records - 1) * _FINE + 1
    when = np.arange(size) / _FINE  # in records
    if kind == "at rest":
        return np.zeros((2, size))
    if kind == "Brownian motion":
        steps = random.standard_normal((2, size)) / math.sqrt(_FINE)
        return np.cumsum(steps, axis=1)
    if kind == "comes to rest":
        settles = records * random.uniform(0.01, 0.04)
        return np.stack([settles * (1.0 - np.exp(-when / settles)), np.zeros(size)])
    pace = _pace(random, kind, when)
    moving = np.concatenate([[0.0], np.cumsum(pace[1:] > 0.0)]) / _FINE
    heading = _heading(random, kind, moving, records)
    speed = pace * (1.0 + _varies(random, when))
    steps = speed / _FINE * np.stack([np.cos(heading), np.sin(heading)])
    return np.cumsum(steps, axis=1)


def _varies(random: np.random.Generator, when: np.ndarray) -> np.ndarray:
    waves = random.uniform(1.0, 8.0)
    wave: np.ndarray = np.sin(2.0 * math.pi * (waves * when / when[-1] + random.random()))
    return random.uniform(0.0, 0.4) * wave


def _pace(random: np.random.Generator, kind: str, when: np.ndarray) -> np.ndarray:
    """Return 1 while the cell moves and 0 in its pauses, from a rest at the start at times."""
    pace = np.ones(when.size)
    if "pauses" in kind:
        on = _even_in_logarithm(random, 3.0, max(4.0, when[-1] / 4.0))
        off = _even_in_logarithm(random, 2.0, max(3.0, min(on * 2.0, when[-1] / 5.0)))
        scatter = random.uniform(0.0, 0.5)
        lengths = np.array([on, off] * (int(when[-1] / (on + off)) + 3))
        lengths *= random.uniform(1.0 - scatter, 1.0 + scatter, lengths.size)
        ends = np.cumsum(lengths) - random.uniform(0.0, on)
        pace = (np.searchsorted(ends, when) % 2 == 0).astype(float)
    if random.random() < 0.3:
        rest = random.uniform(0.0, 0.06) * when[-1]
        pace /= 1.0 + np.exp(-np.clip((when - rest) / (0.004 * when[-1]), -50.0, 50.0))
        pace[pace < 1e-3] = 0.0
    return pace


def _heading(random: np.random.Generator, kind: str, when: np.ndarray, records: int) -> np.ndarray:
    """Return the heading (fine,) against the time on the move, in records."""
    total = max(float(when[-1]), 1.0)
    part = when / total
    match kind.replace(" with pauses", "").partition(" of ")[0]:
        case "straight":
            settles = random.uniform(0.001, 0.1)
            return (
                random.uniform(-0.5, 0.5) * np.exp(-part / settles)
                + random.uniform(-35.0, 35.0) * _DEGREES * part
            )
        case "circle" | "uneven circle":
            turns = _even_in_logarithm(random, 120.0 / 360.0, max(0.5, total / 3.0))
            angle: np.ndarray = 2.0 * math.pi * turns * part
            if kind == "uneven circle":
                waves = random.uniform(4.0, 20.0)
                phase = 2.0 * math.pi * waves * part
                angle += turns * random.uniform(0.2, 0.9) / waves * np.sin(phase)
            return angle
        case "sine" | "zigzag" as shape:
            cycles = _even_in_logarithm(random, 1.75, max(2.0, total / 2.5))
            phase = 2.0 * math.pi * (cycles * part + random.random())
            swing = random.uniform(40.0, 140.0) * _DEGREES
            wave = np.sin(phase)
            if shape == "zigzag":
                wave = np.tanh(random.uniform(1.0, 8.0) * wave)
            arc = random.uniform(-0.15, 0.15) * swing * cycles
            return 0.5 * swing * wave + arc * part
        case "persistent random walk" | "walk":
            forgets = _even_in_logarithm(random, 0.5, max(1.0, total / 8.0))
            kicks = math.sqrt(2.0 / _FINE / forgets) * random.standard_normal(when.size)
            return np.cumsum(kicks)
        case "run and tumble":
            mean = _even_in_logarithm(random, 1.5, max(2.0, total / 8.0))
            ends = np.cumsum(random.exponential(mean, int(4.0 * total / mean) + 20))
            angles = np.cumsum(random.uniform(-math.pi, math.pi, ends.size + 1))
            tumbled: np.ndarray = angles[np.searchsorted(ends, when)]
            return tumbled
        case "loops":
            cycles = _even_in_logarithm(random, 1.75, max(2.0, total / 6.0))
            swing = random.uniform(230.0, 330.0) * _DEGREES
            return 0.5 * swing * np.sin(2.0 * math.pi * (cycles * part + random.random()))
        case "one turn":  # what its cell did before and after is not seen: it may be of any
            at, lasts = random.uniform(0.15, 0.85), random.uniform(0.005, 0.06)
            way = random.choice([-1.0, 1.0]) * random.uniform(70.0, 180.0) * _DEGREES
            turned: np.ndarray = 0.5 * way * np.tanh((part - at) / lasts)
            return turned
        case "one swing":
            first, last = random.uniform(0.1, 0.4), random.uniform(0.6, 0.9)
            lasts = random.uniform(0.005, 0.08)
            way = random.choice([-1.0, 1.0]) * random.uniform(70.0, 180.0) * _DEGREES
            back = random.uniform(0.75, 1.25)
            there, again = (np.tanh((part - at) / lasts) for at in (first, last))
            swung: np.ndarray = 0.5 * way * (there - back * again)
            return swung
        case _:  # switching spin
            changes = np.cumsum(random.uniform(0.05, 0.3, 60))
            sense = np.where(np.searchsorted(changes, part) % 2 == 0, 1.0, -1.0)
            turns = _even_in_logarithm(random, 2.0, max(2.5, total / 6.0))
            return 2.0 * math.pi * turns / when.size * np.cumsum(sense)


def _recorded(
    random: np.random.Generator, kind: str, path: np.ndarray, records: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Record a path as microscopes and trackers do, in units of its own."""
    at = np.arange(records, dtype=float)
    if random.random() < 0.2:
        at[1:-1] += random.uniform(-0.4, 0.4, records - 2)
    fine = np.arange(path.shape[1]) / _FINE
    places = np.stack([np.interp(at, fine, values) for values in path])
    angle = random.uniform(0.0, 2.0 * math.pi)
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    if random.random() < 0.5:
        turn[:, 0] *= -1.0
    places = turn @ places
    noise = 0.0
    if kind == "at rest" or random.random() < 0.7:
        noise = _even_in_logarithm(random, 0.01, 0.7)
    places = places + noise * random.standard_normal(places.shape)
    if random.random() < 0.1:
        pixel = random.uniform(0.1, 1.0)
        places = np.round(places / pixel) * pixel
    if random.random() < 0.1 and kind != "at rest":
        _hold(random, places)
    if random.random() < 0.05:
        which = int(random.integers(records))
        places[:, which] += random.uniform(8.0, 40.0) * np.array([math.cos(angle), math.sin(angle)])
    kept = np.ones(records, dtype=bool)
    if random.random() < 0.3:
        lost = random.random(records) < random.uniform(0.02, 0.4)
        lost[[0, -1]] = False
        if records - np.count_nonzero(lost) >= FEWEST:
            kept = ~lost
    length, time = np.exp(random.uniform(-5.0, 5.0, 2))
    x, y = length * places[:, kept] + random.uniform(-10.0, 10.0, (2, 1)) * length
    return time * at[kept], x, y


def _hold(random: np.random.Generator, places: np.ndarray) -> None:
    """Repeat positions of a cell that the tracker lost for a record or two."""
    size = places.shape[1]
    starts = random.integers(1, size, int(random.integers(1, 1 + max(1, size // 30))))
    for start in [*starts.tolist(), size - 1][-2:]:
        places[:, start : start + int(random.integers(1, 3))] = places[:, start - 1][:, None]
