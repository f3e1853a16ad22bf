"""Approximate Bayesian computation: the runs that look most alike, shifted to what was seen.

Beaumont, Zhang & Balding, Genetics 162, 2025 (2002), with learned summaries (Fearnhead & Prangle,
J. R. Stat. Soc. B 74, 419, 2012).
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final, NamedTuple

import numpy as np

from cellcrawl.infer.regression import Network, train

_EDGE: Final = 1e-3  # parts are kept off the ends of their range, where a logit has no value
SEEN_EDGE: Final = 3e-3  # as far as what networks expect is told apart
_SHARE: Final = 0.03  # of the rows are near enough
_FEWEST: Final = 150
FOLDS: Final = 4
_WIDTHS: Final = np.geomspace(0.5, 2.0, 57)


class Samples(NamedTuple):
    """Weighted samples of a posterior, as parts 0 to 1 of the ranges of the prior.

    Attributes
    ----------
    part : ndarray, shape (sample, name)
    weight : ndarray, shape (sample,)
        They sum to 1.
    row : ndarray of int, shape (sample,)
        The row of the reference that each sample was shifted from.
    """

    part: np.ndarray
    weight: np.ndarray
    row: np.ndarray


def local_linear(
    part: np.ndarray, seen: np.ndarray, target: np.ndarray, share: float = _SHARE
) -> Samples:
    """Return the posterior of parameters given a few summaries, by regression among the nearest.

    Parameters
    ----------
    part : ndarray, shape (row, name)
        Parameters of the reference rows, as parts 0 to 1 of their ranges.
    seen : ndarray, shape (row, name)
        What is expected of them, given their films.
    target : ndarray, shape (name,)
        What is expected of the cell.
    share : float
        Part of the rows that are taken as near.

    Notes
    -----
    Epanechnikov weights; the parameters' logits are shifted along a regression on the logits of
    what is expected, so that none leaves its range. One logit over the other is nearly a line up to
    the ends of a range; a logit over a part is not, and gave intervals that were far too wide.
    """
    count = int(np.clip(share * len(seen), min(_FEWEST, len(seen)), len(seen)))
    places, place = logit(seen, SEEN_EDGE), logit(target, SEEN_EDGE)
    spread = np.maximum(places.std(axis=0), 1e-9)
    away = np.sqrt((((places - place) / spread) ** 2).sum(axis=1))
    near = np.argpartition(away, count - 1)[:count]
    reach = max(float(away[near].max()), 1e-12) * (1.0 + 1e-9)
    weight = 1.0 - (away[near] / reach) ** 2
    weight = np.maximum(weight, 1e-6)
    weight /= weight.sum()
    x = np.column_stack([np.ones(count), (places[near] - place) / spread])
    y = logit(part[near])
    found = _weighted(x, y, weight)
    return Samples(expit(found[0] + y - x @ found), weight, near)


class Reference(NamedTuple):
    """One fold: a network, and rows that it was not trained on."""

    network: Network
    rows: np.ndarray
    part: np.ndarray
    seen: np.ndarray


def learn(
    part: np.ndarray, summaries: np.ndarray, run: np.ndarray, seed: int = 0
) -> list[Reference]:
    """Return networks and the rows to compare with, in folds by run.

    The rows that a cell is compared with are new to the network as the cell is: on its own
    training rows a network is surer than on a cell, and intervals would be too narrow.
    """
    fold = np.random.default_rng(seed).permutation(int(run.max()) + 1)[run] % FOLDS
    references = []
    for number in range(FOLDS):
        rows = np.flatnonzero(fold == number)
        others = np.flatnonzero(fold != number)
        network = train(summaries[others], part[others], seed + number)
        references.append(Reference(network, rows, part[rows], network(summaries[rows])))
    return references


def posterior(
    references: list[Reference], summaries: np.ndarray, width: np.ndarray | float = 1.0
) -> Samples:
    """Return the posterior of one cell, its summaries of shape (summary,).

    Parameters
    ----------
    references : list of Reference
    summaries : ndarray, shape (summary,)
    width : float or ndarray, shape (name,)
        Factor of the spread of each parameter, in logits; see `fair_width`.

    Notes
    -----
    The cell stands where the networks together expect it; what it is compared with are the rows of
    all of them, each expected by the one network that has not seen it.
    """
    target = thought(references, summaries[None])[0]
    part, seen, rows = (
        np.concatenate([getattr(one, name) for one in references])
        for name in ("part", "seen", "rows")
    )
    found = local_linear(part, seen, target)
    return widened(found._replace(row=rows[found.row]), width)


def thought(references: list[Reference], summaries: np.ndarray) -> np.ndarray:
    """Return the parameters that the networks together expect of films, shape (film, name)."""
    return np.asarray(np.mean([one.network(summaries) for one in references], axis=0))


def widened(samples: Samples, width: np.ndarray | float) -> Samples:
    """Return samples whose logits stand ``width`` times as far from their middle."""
    place = logit(samples.part)
    middle = samples.weight @ place
    return samples._replace(part=expit(middle + width * (place - middle)))


def fair_width(found: Iterable[Samples], part: np.ndarray) -> np.ndarray:
    """Return the factors under which intervals hold the truth as often as they say, shape (name,).

    Parameters
    ----------
    found : iterable of Samples
        Posteriors of cells that nothing was trained on.
    part : ndarray, shape (cell, name)
        Their true parameters.

    Notes
    -----
    A network that saw a part of the runs is a little less sure than several together: posteriors
    come out too wide by some percent.
    """
    ranks = np.empty((len(_WIDTHS), *part.shape))
    for row, (one, truth) in enumerate(zip(found, part, strict=True)):
        place = logit(one.part)
        middle = one.weight @ place
        # The truth is below a sample if it is so after both are drawn to the middle.
        scaled = middle + (logit(truth) - middle) / _WIDTHS[:, None]
        ranks[:, row] = np.einsum("s,wsn->wn", one.weight, place[None] < scaled[:, None])
    ordered = np.sort(np.abs(2.0 * ranks - 1.0), axis=1)  # even on 0 to 1 if widths are right
    even = (np.arange(part.shape[0]) + 0.5) / part.shape[0]
    off = np.abs((ordered - even[:, None]).mean(axis=1))
    return np.asarray(_WIDTHS[off.argmin(axis=0)])


def _weighted(x: np.ndarray, y: np.ndarray, weight: np.ndarray, ridge: float = 1e-6) -> np.ndarray:
    """Weighted least squares, coefficients of shape (column of x, column of y)."""
    keep = np.diag([0.0, *np.full(x.shape[1] - 1, ridge)])
    return np.asarray(np.linalg.solve((x.T * weight) @ x + keep, (x.T * weight) @ y))


def logit(part: np.ndarray, edge: float = _EDGE) -> np.ndarray:
    """Return log(p / (1 - p)) of parts, kept ``edge`` off the ends of their range."""
    inner = np.clip(part, edge, 1.0 - edge)
    return np.asarray(np.log(inner / (1.0 - inner)))


def expit(value: np.ndarray) -> np.ndarray:
    """Return the parts of which these are the logits."""
    return np.asarray(0.5 * (1.0 + np.tanh(0.5 * value)))
