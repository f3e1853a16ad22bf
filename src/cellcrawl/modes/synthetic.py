"""Tracks whose mode is known, to put the classifier to the test.

Each is drawn in the model's own scales (a cell of radius 1 that crawls at about 0.2) and then
given another unit of length and time, turned, mirrored and moved, so that nothing but its form can
name it. Sampling, run length, localisation noise and the transient are drawn as well.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

_FINE = 4000  # steps in which a track is integrated before it is sampled
_NOISIEST = 0.03  # localisation error, of the cell's radius


@dataclass(frozen=True, eq=False)
class SyntheticTrack:
    """A track and what it is.

    Attributes
    ----------
    kind : str
        Which recipe of `RECIPES` drew it.
    mode : str
        Its mode.
    t, x, y : ndarray, shape (record,)
        Times and positions.
    """

    kind: str
    mode: str
    t: np.ndarray
    x: np.ndarray
    y: np.ndarray


Heading = Callable[[np.random.Generator, np.ndarray], np.ndarray]


def synthetic_tracks(
    count: int, seed: int = 0, kinds: tuple[str, ...] = ()
) -> Iterator[SyntheticTrack]:
    """Draw tracks with known modes, all kinds in turn.

    Parameters
    ----------
    count : int
        How many.
    seed : int
        Of the random numbers; the same seed gives the same tracks.
    kinds : tuple of str
        Names from `RECIPES`; all unless given.

    Yields
    ------
    SyntheticTrack
    """
    names = kinds or tuple(RECIPES)
    for number in range(count):
        kind = names[number % len(names)]
        mode, recipe = RECIPES[kind]
        random = np.random.default_rng([seed, number])
        duration = random.uniform(50.0, 150.0)
        times = np.linspace(0.0, duration, _FINE + 1)
        path = recipe(random, times)
        if mode != "stationary":
            path = _delayed(random, path)
        yield SyntheticTrack(kind, mode, *_observed(random, times, path))


def _observed(
    random: np.random.Generator, times: np.ndarray, path: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Sample a path (2, fine) as a microscope would, in units of its own."""
    duration = float(times[-1])
    interval = math.exp(random.uniform(math.log(0.05), math.log(1.0)))
    sampled = np.linspace(0.0, duration, int(duration / interval) + 1)
    if random.random() < 0.3:
        step = sampled[1]
        sampled[1:-1] += random.uniform(-0.4, 0.4, sampled.size - 2) * step
    places = np.stack([np.interp(sampled, times, values) for values in path])
    noise = random.uniform(0.0, _NOISIEST)
    if random.random() < 0.5 and np.ptp(path) > 0.0:
        noise = 0.0
    places += noise * random.standard_normal(places.shape)
    angle = random.uniform(0.0, 2.0 * math.pi)
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    if random.random() < 0.5:
        turn[:, 0] *= -1.0
    length, time = np.exp(random.uniform(-5.0, 5.0, 2))
    x, y = length * (turn @ places + random.uniform(-10.0, 10.0, (2, 1)))
    return time * (sampled + random.uniform(-5.0, 5.0)), x, y


def _delayed(random: np.random.Generator, path: np.ndarray) -> np.ndarray:
    """Rest for a while at the beginning, then speed up, as a cell that breaks its symmetry."""
    rest = random.uniform(0.0, 0.06) * _FINE
    step = np.arange(_FINE + 1)
    pace = 1.0 / (1.0 + np.exp(-(step - rest) / (0.003 * _FINE)))
    along = np.concatenate([[0.0], np.cumsum(pace[1:])])
    return np.stack([np.interp(along, step, values) for values in path])


def _walk(random: np.random.Generator, times: np.ndarray, heading: np.ndarray) -> np.ndarray:
    """Integrate a heading (fine,) at a speed that varies a little."""
    speed = random.uniform(0.1, 0.3)
    wave = 1.0 + random.uniform(0.0, 0.3) * np.sin(
        2.0 * math.pi * random.uniform(2.0, 12.0) * times / times[-1]
    )
    step = speed * wave * np.stack([np.cos(heading), np.sin(heading)])
    path = np.zeros((2, times.size))
    np.cumsum(0.5 * (step[:, 1:] + step[:, :-1]), axis=1, out=path[:, 1:])
    return path * float(times[1] - times[0])


def _straight(random: np.random.Generator, times: np.ndarray) -> np.ndarray:
    heading = np.zeros_like(times)
    settle = random.uniform(0.0, 0.1) * times[-1]
    heading += random.uniform(-0.5, 0.5) * np.exp(-times / max(settle, 1e-3))
    return _walk(random, times, heading)


def _slightly_curved(random: np.random.Generator, times: np.ndarray) -> np.ndarray:
    return _walk(random, times, math.radians(random.uniform(5.0, 35.0)) * times / times[-1])


def _circle(random: np.random.Generator, times: np.ndarray) -> np.ndarray:
    turned = math.radians(math.exp(random.uniform(math.log(150.0), math.log(2000.0))))
    return _walk(random, times, turned * times / times[-1])


def _polygon(random: np.random.Generator, times: np.ndarray) -> np.ndarray:
    """One-way turns with straight legs between, five to twelve of them."""
    turns = int(random.integers(5, 13))
    angle = math.radians(random.uniform(40.0, 110.0))
    at = (np.arange(turns) + random.uniform(0.2, 0.8)) / turns * times[-1]
    lasts = random.uniform(0.02, 0.1) * times[-1] / turns
    rises = np.tanh((times[:, None] - at) / lasts)
    return _walk(random, times, 0.5 * angle * rises.sum(axis=1))


def _wobbling_circle(random: np.random.Generator, times: np.ndarray) -> np.ndarray:
    """A circle whose turning rate goes up and down and never changes sign."""
    turned = math.radians(random.uniform(250.0, 1500.0))
    waves = random.uniform(4.0, 20.0)
    depth = random.uniform(0.2, 0.9)
    phase = 2.0 * math.pi * waves * times / times[-1]
    return _walk(
        random,
        times,
        turned * (times / times[-1] + depth * np.sin(phase) / (2.0 * math.pi * waves)),
    )


def _cycles(random: np.random.Generator, times: np.ndarray) -> np.ndarray:
    """Return the phase of three to ten left-right cycles."""
    cycles = random.uniform(3.0, 10.0)
    phase: np.ndarray = 2.0 * math.pi * (cycles * times / times[-1] + random.random())
    return phase


def _sinusoid(random: np.random.Generator, times: np.ndarray) -> np.ndarray:
    """A sine wave in space, run along at a steady pace of its axis."""
    phase = _cycles(random, times)
    steepest = math.tan(math.radians(random.uniform(20.0, 65.0)))
    per_phase = 0.2 * times[-1] / (phase[-1] - phase[0])
    return np.stack([per_phase * phase, steepest * per_phase * np.sin(phase)])


def _zigzag(random: np.random.Generator, times: np.ndarray) -> np.ndarray:
    """Straight legs, alternating turns that take a part of the time."""
    swing = math.radians(random.uniform(40.0, 140.0))
    sharpness = random.uniform(1.0, 8.0)
    return _walk(random, times, 0.5 * swing * np.tanh(sharpness * np.sin(_cycles(random, times))))


def _zigzag_on_an_arc(random: np.random.Generator, times: np.ndarray) -> np.ndarray:
    phase = _cycles(random, times)
    swing = math.radians(random.uniform(60.0, 120.0))
    cycles = (phase[-1] - phase[0]) / (2.0 * math.pi)
    drift = random.uniform(0.05, 0.25) * swing * cycles
    return _walk(random, times, 0.5 * swing * np.sin(phase) + drift * times / times[-1])


def _meander(random: np.random.Generator, times: np.ndarray) -> np.ndarray:
    """Alternating turns of much more than half round: loops, not a way ahead."""
    swing = math.radians(random.uniform(230.0, 330.0))
    return _walk(random, times, 0.5 * swing * np.sin(_cycles(random, times)))


def _run_and_tumble(random: np.random.Generator, times: np.ndarray) -> np.ndarray:
    """Straight runs of random length, sudden turns of any size to either side."""
    lengths = random.exponential(times[-1] / random.uniform(12.0, 40.0), 400)
    return _walk(random, times, _reorientations(random, times, lengths))


def _levy_walk(random: np.random.Generator, times: np.ndarray) -> np.ndarray:
    """Runs with a power law of lengths, cut off at a tenth of the track."""
    lengths = np.minimum(times[-1] / 200.0 * random.pareto(1.5, 2000), 0.1 * times[-1])
    return _walk(random, times, _reorientations(random, times, lengths))


def _reorientations(
    random: np.random.Generator, times: np.ndarray, lengths: np.ndarray
) -> np.ndarray:
    ends = np.cumsum(lengths)
    angles = random.uniform(-math.pi, math.pi, ends.size)
    turned = np.concatenate([[0.0], np.cumsum(angles)])
    heading: np.ndarray = turned[np.searchsorted(ends, times)]
    return heading


def _persistent_random_walk(random: np.random.Generator, times: np.ndarray) -> np.ndarray:
    """A heading that diffuses: the track forgets its direction ten to thirty times over."""
    forgets = times[-1] / random.uniform(10.0, 30.0)
    step = times[1] - times[0]
    turns = math.sqrt(2.0 * step / forgets) * random.standard_normal(times.size)
    return _walk(random, times, np.cumsum(turns))


def _brownian(random: np.random.Generator, times: np.ndarray) -> np.ndarray:
    steps = random.standard_normal((2, times.size)) * math.sqrt(0.05 * (times[1] - times[0]))
    return np.cumsum(steps, axis=1)


def _switching_spin(random: np.random.Generator, times: np.ndarray) -> np.ndarray:
    """Circles one way and the other, changing over at random."""
    ends = np.cumsum(random.uniform(0.05, 0.3, 40)) * times[-1]
    way = np.where(np.searchsorted(ends, times) % 2 == 0, 1.0, -1.0)
    rate = math.radians(random.uniform(1500.0, 3000.0)) / times[-1]
    return _walk(random, times, np.cumsum(way) * rate * (times[1] - times[0]))


def _at_rest(random: np.random.Generator, times: np.ndarray) -> np.ndarray:
    """No motion but the microscope's."""
    return np.zeros((2, times.size))


RECIPES = {
    "straight": ("gliding", _straight),
    "slightly curved": ("gliding", _slightly_curved),
    "circle": ("rotational", _circle),
    "polygon": ("rotational", _polygon),
    "wobbling circle": ("rotational", _wobbling_circle),
    "sinusoid": ("zigzag", _sinusoid),
    "zigzag": ("zigzag", _zigzag),
    "zigzag on an arc": ("zigzag", _zigzag_on_an_arc),
    "meander": ("other", _meander),
    "run and tumble": ("other", _run_and_tumble),
    "Lévy walk": ("other", _levy_walk),
    "persistent random walk": ("other", _persistent_random_walk),
    "Brownian motion": ("other", _brownian),
    "switching spin": ("other", _switching_spin),
    "at rest": ("stationary", _at_rest),
}
"""Kinds of track, each with its mode."""
