"""A small network from summaries to parameters, by NumPy alone: which numbers tell what."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, Final, NamedTuple

import numpy as np

from cellcrawl.threads import on_one_thread

_HIDDEN: Final = (256, 128)
_BATCH: Final = 256
_RATE: Final = 3e-3
_DECAY: Final = 1e-3
_CLIP: Final = 5.0  # in spreads: a summary beyond says no more than that it is beyond
_FEWEST_STEPS, _MOST_STEPS = 400, 6000


class Scaling(NamedTuple):
    """How summaries are brought to a common size: middle and spread of each."""

    middle: np.ndarray
    spread: np.ndarray

    @classmethod
    def of(cls, values: np.ndarray) -> Scaling:
        """Return the scaling under which these values have middle 0 and spread about 1."""
        low, middle, high = np.quantile(values, [0.1587, 0.5, 0.8413], axis=0)
        spread = np.maximum(0.5 * (high - low), 0.2 * values.std(axis=0))
        return cls(middle, np.where(spread > 1e-9, spread, np.inf))

    def __call__(self, values: np.ndarray) -> np.ndarray:
        """Return scaled values, those far out clipped."""
        scaled = np.clip((values - self.middle) / self.spread, -_CLIP, _CLIP)
        return np.asarray(scaled, np.float32)


class Network(NamedTuple):
    """A linear map and a network of two hidden layers, added."""

    scaling: Scaling
    linear: np.ndarray
    offset: np.ndarray
    weights: tuple[np.ndarray, ...]

    def __call__(self, values: np.ndarray) -> np.ndarray:
        """Return what is expected of the targets, shape (row, target)."""
        x = self.scaling(values)
        return np.asarray(x @ self.linear + self.offset + _forward(self.weights, x)[-1], float)


@on_one_thread
def train(values: np.ndarray, targets: np.ndarray, seed: int = 0) -> Network:
    """Return a network that expects targets from values, by least squares.

    Parameters
    ----------
    values : ndarray, shape (row, summary)
    targets : ndarray, shape (row, target)
    seed : int
        Of the first weights and of the order of the rows.

    Notes
    -----
    Ridge regression first, then Adam on what it leaves, with weight decay and a rate that falls to
    nothing: no early stopping, and so no rows set apart.
    """
    random = np.random.default_rng(seed)
    scaling = Scaling.of(values)
    x = scaling(values)
    offset = targets.mean(axis=0)
    gram = x.T.astype(float) @ x + 10.0 * np.sqrt(len(x)) * np.eye(x.shape[1])
    linear = np.linalg.solve(gram, x.T.astype(float) @ (targets - offset)).astype(np.float32)
    left = (targets - offset - x @ linear).astype(np.float32)
    sizes = (x.shape[1], *_HIDDEN, targets.shape[1])
    weights: list[np.ndarray] = []
    for layer, (below, above) in enumerate(pairwise(sizes)):
        size = 0.0 if layer == len(_HIDDEN) else 1.0 / np.sqrt(below)
        weights.append((size * random.standard_normal((below, above))).astype(np.float32))
        weights.append(np.zeros(above, np.float32))
    _descend(weights, x, left, random)
    return Network(scaling, linear, offset, tuple(weights))


def _descend(
    weights: list[np.ndarray], x: np.ndarray, y: np.ndarray, random: np.random.Generator
) -> None:
    """Adam, in place."""
    steps = min(max(100 * len(x) // _BATCH, _FEWEST_STEPS), _MOST_STEPS)
    mean = [np.zeros_like(w) for w in weights]
    square = [np.zeros_like(w) for w in weights]
    for step in range(1, steps + 1):
        rows = random.integers(0, len(x), min(_BATCH, len(x)))
        slopes = _slopes(weights, x[rows], y[rows])
        rate = _RATE * 0.5 * (1.0 + np.cos(np.pi * step / steps)) * min(1.0, step / 100)
        for i, slope in enumerate(slopes):
            mean[i] += 0.1 * (slope - mean[i])
            square[i] += 0.001 * (slope**2 - square[i])
            move = mean[i] / (1 - 0.9**step) / (np.sqrt(square[i] / (1 - 0.999**step)) + 1e-8)
            decay = _DECAY * weights[i] if weights[i].ndim == 2 else 0.0
            weights[i] -= rate * (move + decay)


def _forward(weights: Any, x: np.ndarray) -> list[np.ndarray]:
    layers = [x]
    for i in range(0, len(weights), 2):
        x = x @ weights[i] + weights[i + 1]
        if i < len(weights) - 2:
            x = np.tanh(x)
        layers.append(x)
    return layers


def _slopes(weights: list[np.ndarray], x: np.ndarray, y: np.ndarray) -> list[np.ndarray]:
    layers = _forward(weights, x)
    back = (2.0 / len(x)) * (layers[-1] - y)
    slopes: list[np.ndarray] = []
    for i in range(len(weights) - 2, -1, -2):
        below = layers[i // 2]
        slopes = [below.T @ back, back.sum(axis=0), *slopes]
        if i:
            back = (back @ weights[i].T) * (1.0 - below**2)
    return slopes
