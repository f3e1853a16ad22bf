"""Which law a cell obeys: banks of several laws, seen through the microscope of one cell."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.infer.bank import Bank
from cellcrawl.infer.cells import cells_of
from cellcrawl.infer.fitting import microscope_of
from cellcrawl.infer.microscope import look, summaries_of
from cellcrawl.infer.regression import train
from cellcrawl.validation import listed, shown, whole_number

_ASIDE = 4  # one run of so many is set apart
_NEAR = 0.05  # of the runs set apart, those whose scores are nearest
_FEWEST = 20


@dataclass(frozen=True, eq=False)
class Choice:
    """How likely each law is, for one cell.

    Attributes
    ----------
    laws : tuple of str
    probability : ndarray, shape (law,)
        Each law as likely as the others beforehand.
    error_rate : float
        Part of films of the banks, set apart, of which another law than theirs is likeliest.
    confusion : ndarray, shape (law, law)
        Part of the films of a law (row) for which each law (column) is likeliest.
    """

    laws: tuple[str, ...]
    probability: np.ndarray
    error_rate: float
    confusion: np.ndarray

    @property
    def likeliest(self) -> str:
        """The likeliest law."""
        return self.laws[int(self.probability.argmax())]

    def summary(self) -> str:
        """Return what was found in a line."""
        told = ", ".join(f"{n} {p:.2f}" for n, p in zip(self.laws, self.probability, strict=True))
        return f"law      {told}; such a choice is wrong for {self.error_rate:.0%} of films"


@checked
def choose(
    observed: Any,
    banks: Sequence[Bank],
    *,
    outlines: Any = None,
    time_unit: Any = None,
    length_unit: Any = None,
    pixel: float | None = None,
    error: float | None = None,
    looks: int = 1,
    seed: int = 0,
) -> Choice:
    """Return which of several banks' laws a filmed cell obeys, with the rate of error.

    Parameters
    ----------
    observed, outlines, time_unit, length_unit, pixel, error, looks, seed
        As in `fit`.
    banks : sequence of Bank
        One a law, two or more. A prior that is wider in one of them counts against its law.

    Raises
    ------
    InputError
        As in `fit`; for fewer than two banks or two of the same law.

    Notes
    -----
    A law that is in no bank is not found out: see the alarm of `fit`.
    """
    whole_number("looks", looks, 1, 20)
    whole_number("seed", seed, 0, 2**31)
    given = listed("banks", banks, "a list of banks")
    for one in given:
        if not isinstance(one, Bank):
            raise InputError(f"banks must be what bank or open_bank returns, not {shown(one)}")
    laws = tuple(type(one.law).__name__ for one in given)
    if len(given) < 2 or len({repr(one.law.describe()) for one in given}) < len(given):
        raise InputError("to choose takes two banks or more, each of another law")
    cells = cells_of(observed, outlines)
    if len(cells) != 1:
        raise InputError(f"there are {len(cells)} cells: choose one")
    shortest = min(given, key=lambda one: one.duration)
    cut, microscope = microscope_of(cells, shortest, time_unit, length_unit, pixel, error)
    views = [look(one, microscope, looks, seed) for one in given]
    values = np.concatenate([view.summaries for view in views])
    law = np.concatenate([np.full(len(view.run), i) for i, view in enumerate(views)])
    run = np.concatenate([view.run for view in views])
    apart = np.random.default_rng(seed).permutation(int(run.max()) + 1)[run] % _ASIDE == 0
    is_law = np.eye(len(given))[law]
    network = train(values[~apart], is_law[~apart], seed)
    film = cut[0].film(microscope.usual_time, microscope.usual_length)
    scores = network(values[apart])
    target = network(summaries_of(film, microscope)[1])[0]
    probabilities = np.array(
        [_near(scores, is_law[apart], score, i) for i, score in enumerate(scores)]
    )
    said, truth = probabilities.argmax(axis=1), law[apart]
    confusion = np.array(
        [[(said[truth == i] == j).mean() for j in range(len(given))] for i in range(len(given))]
    )
    return Choice(
        laws,
        _near(scores, is_law[apart], target),
        float(1.0 - np.diag(confusion).mean()),
        confusion,
    )


def _near(
    scores: np.ndarray, is_law: np.ndarray, target: np.ndarray, without: int | None = None
) -> np.ndarray:
    """Return how often each law is among the films set apart whose scores are nearest."""
    away = ((scores - target) ** 2).sum(axis=1)
    if without is not None:
        away[without] = np.inf
    count = min(max(_FEWEST, int(_NEAR * len(scores))), len(scores) - 1)
    near = np.argpartition(away, count)[:count]
    share = is_law.sum(axis=0)
    counted = (is_law[near] / share).sum(axis=0) + 0.5 / share.max() / len(share)
    return np.asarray(counted / counted.sum())
