"""What a bank teaches through one microscope: networks, their calibration, and the alarm."""

from __future__ import annotations

import functools
from typing import Final, NamedTuple

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.infer import approximate
from cellcrawl.infer.approximate import Reference, Samples
from cellcrawl.infer.bank import Bank
from cellcrawl.infer.microscope import Microscope, View, look
from cellcrawl.infer.regression import Scaling
from cellcrawl.threads import on_one_thread

FEWEST_RUNS: Final = 60
_ASIDE: Final = 0.15  # of the runs are set apart, to try the method on
_MOST_ASIDE: Final = 600
_LEVELS: Final = (0.5, 0.8, 0.9, 0.95)
FALSE_ALARMS: Final = 0.03
_FAR: Final = 12.0  # spreads beyond which one summary counts no more


class Calibration(NamedTuple):
    """How posteriors of cells of the bank, that nothing was trained on, stand to the truth.

    Attributes
    ----------
    names : tuple of str
    truth, mean : ndarray, shape (cell, name)
        As parts 0 to 1 of the ranges of the prior.
    rank : ndarray, shape (cell, name)
        Part of the posterior below the truth: evenly spread if the method is right.
    """

    names: tuple[str, ...]
    truth: np.ndarray
    mean: np.ndarray
    rank: np.ndarray

    def coverage(self, level: float) -> np.ndarray:
        """Part of the cells whose central interval of this level holds the truth."""
        half = 0.5 * (1.0 - level)
        return np.asarray(((self.rank > half) & (self.rank < 1.0 - half)).mean(axis=0))

    @property
    def levels(self) -> dict[float, np.ndarray]:
        """Coverage at 50, 80, 90 and 95 percent."""
        return {level: self.coverage(level) for level in _LEVELS}

    @property
    def recovered(self) -> np.ndarray:
        """Part of the variance of each parameter that the posterior means tell, R²."""
        left = ((self.mean - self.truth) ** 2).sum(axis=0)
        there = ((self.truth - self.truth.mean(axis=0)) ** 2).sum(axis=0)
        return np.asarray(1.0 - left / np.maximum(there, 1e-12))

    @property
    def evenness(self) -> np.ndarray:
        """Probability of ranks as uneven as these if they were even (Kolmogorov and Smirnov)."""
        return np.array([_even(column) for column in self.rank.T])


class Alarm(NamedTuple):
    """What films of the model look like, so that one that does not can be told.

    The summaries are foretold from the parameters that a film is thought to have; what is left is
    measured against what is left of films of the bank.
    """

    scaling: Scaling
    foretell: np.ndarray
    axes: np.ndarray
    size: np.ndarray
    spread: np.ndarray
    threshold: float

    def left(self, thought: np.ndarray, summaries: np.ndarray) -> np.ndarray:
        """Return what the parameters do not foretell, in spreads, shape (film, summary)."""
        return np.asarray(
            (_wide(self.scaling, summaries) - _powers(thought) @ self.foretell) / self.spread
        )

    def strangeness(self, thought: np.ndarray, summaries: np.ndarray) -> np.ndarray:
        """Return how far films are from the bank's, shape (film,)."""
        along = self.left(thought, summaries) @ self.axes
        return np.asarray((along**2 / self.size).mean(axis=1))


class Trained(NamedTuple):
    """All that is needed to fit cells seen through one microscope by one bank."""

    bank: Bank
    microscope: Microscope
    view: View
    references: list[Reference]
    calibration: Calibration
    alarm: Alarm
    aside: np.ndarray
    """Rows of the view that nothing was trained on, one a run."""
    width: np.ndarray
    """Factors of the spread of each parameter; see `approximate.fair_width`."""

    def thought(self, summaries: np.ndarray) -> np.ndarray:
        """Return the parameters that films are thought to have, shape (film, name)."""
        return approximate.thought(self.references, summaries)


@on_one_thread
def train(bank: Bank, microscope: Microscope, looks: int = 3, seed: int = 0) -> Trained:
    """Look at a bank through a microscope, learn, and try it on runs set apart.

    Raises
    ------
    InputError
        If too few runs give such a film.
    """
    view = look(bank, microscope, looks, seed)
    runs = np.unique(view.run)
    if runs.size < FEWEST_RUNS:
        raise InputError(
            f"{bank.path} has {runs.size} runs that give such a film: at least {FEWEST_RUNS} are "
            "needed; make a larger bank"
        )
    order = np.random.default_rng(seed).permutation(runs)
    apart = order[: min(int(_ASIDE * runs.size), _MOST_ASIDE)]
    is_apart = np.isin(view.run, apart)
    rows = np.flatnonzero(~is_apart)
    aside = np.array([np.flatnonzero(view.run == run)[0] for run in np.sort(apart)])
    part, summaries = view.part[rows], view.summaries[rows]
    found = approximate.learn(part, summaries, view.run[rows], seed)
    references = [one._replace(rows=rows[one.rows]) for one in found]
    alarm = _alarm(view, rows, aside, references)
    width, calibration = calibrated(
        view, aside, [approximate.posterior(references, seen) for seen in view.summaries[aside]]
    )
    return Trained(bank, microscope, view, references, calibration, alarm, aside, width)


@functools.lru_cache(maxsize=4)
def _kept(path: str, digest: str, microscope: Microscope, looks: int, seed: int) -> Trained:
    return train(Bank(path), microscope, looks, seed)


def trained(bank: Bank, microscope: Microscope, looks: int = 3, seed: int = 0) -> Trained:
    """Return `train` of these, kept in memory for the next cell of the same film."""
    return _kept(str(bank.path), bank.digest, microscope, looks, seed)


def calibrated(
    view: View, rows: np.ndarray, found: list[Samples]
) -> tuple[np.ndarray, Calibration]:
    """Return the fair width of posteriors of these rows, and how they stand to the truth then."""
    truth = view.part[rows]
    width = approximate.fair_width(found, truth)
    fair = [approximate.widened(one, width) for one in found]
    mean = np.array([one.weight @ one.part for one in fair])
    rank = np.array([one.weight @ (one.part < true) for one, true in zip(fair, truth, strict=True)])
    return width, Calibration(view.names, truth, mean, rank)


def _alarm(view: View, rows: np.ndarray, aside: np.ndarray, references: list[Reference]) -> Alarm:
    """Learn what is foretold, on rows that the networks have not seen, and set the threshold."""
    scaling = Scaling.of(view.summaries[rows])
    expected = np.empty_like(view.part)
    for one in references:
        expected[one.rows] = one.seen
    thought = expected[rows]
    scaled = _wide(scaling, view.summaries[rows])
    powers = _powers(thought)
    gram = powers.T @ powers + 1e-3 * len(rows) * np.eye(powers.shape[1])
    foretell = np.linalg.solve(gram, powers.T @ scaled)
    left = scaled - powers @ foretell
    spread = np.maximum(left.std(axis=0), 1e-3)
    values, axes = np.linalg.eigh(np.cov((left / spread).T))
    size = np.maximum(values, 0.02)
    alarm = Alarm(scaling, foretell, axes, size, spread, np.inf)
    among = approximate.thought(references, view.summaries[aside])
    tried = np.sort(alarm.strangeness(among, view.summaries[aside]))
    place = min(int(np.ceil((len(tried) + 1) * (1.0 - FALSE_ALARMS))), len(tried)) - 1
    return alarm._replace(threshold=float(tried[place]))


def _wide(scaling: Scaling, values: np.ndarray) -> np.ndarray:
    return np.asarray(np.clip((values - scaling.middle) / scaling.spread, -_FAR, _FAR))


def _powers(thought: np.ndarray) -> np.ndarray:
    """Return 1, the parameters and their products up to the third degree."""
    x = np.clip(thought, -0.2, 1.2)
    count = x.shape[1]
    columns = [np.ones(len(x)), *x.T]
    for i in range(count):
        for j in range(i, count):
            columns.append(x[:, i] * x[:, j])
            columns += [x[:, i] * x[:, j] * x[:, k] for k in range(j, count)]
    return np.column_stack(columns)


def _even(ranks: np.ndarray) -> float:
    """Return the p-value of the test of Kolmogorov and Smirnov against an even spread."""
    ordered = np.sort(ranks)
    count = ordered.size
    steps = np.arange(count + 1) / count
    away = max(float((steps[1:] - ordered).max()), float((ordered - steps[:-1]).max()))
    root = np.sqrt(count)
    value = (root + 0.12 + 0.11 / root) * away
    if value < 0.2:
        return 1.0
    k = np.arange(1, 101)
    return float(np.clip(2.0 * np.sum((-1.0) ** (k - 1) * np.exp(-2.0 * (k * value) ** 2)), 0, 1))
