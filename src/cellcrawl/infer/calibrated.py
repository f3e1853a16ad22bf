"""Parameters of cells as the runs of the bank near them say that networks read such films.

A network draws what a film hardly tells towards the middle of the prior, and errs in its own way,
alike for all cells of a condition. What it says of runs like these, which it was not trained on,
tells both.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from cellcrawl.infer.approximate import Reference

_SHARE: Final = 0.15  # of a network's rows are near enough
_FEWEST: Final = 80
_LEAST_SLOPE: Final = 0.02
_ROUNDS: Final = 3


def thoughts(fits: Sequence[Any]) -> np.ndarray:
    """Return what each network says of each cell, shape (cell, network, name)."""
    return np.array(
        [[one.network(fit.summaries[None])[0] for one in fit.trained.references] for fit in fits]
    )


def estimates(fits: Sequence[Any], said: np.ndarray, centre: np.ndarray) -> np.ndarray:
    """Return calibrated parameters of cells, shape (cell, network, name), as parts of the ranges.

    Parameters
    ----------
    fits : sequence of Fit
    said : ndarray, shape (cell, network, name)
        See `thoughts`.
    centre : ndarray, shape (name,)
        Near which parameters the networks are held to runs of the bank.
    """
    found = np.empty_like(said)
    known: dict[int, list[tuple[np.ndarray, np.ndarray]]] = {}
    for i, fit in enumerate(fits):
        references = fit.trained.references
        lines = known.setdefault(id(references), [_line(one, centre) for one in references])
        for k, (offset, slope) in enumerate(lines):
            found[i, k] = centre + np.linalg.solve(slope, said[i, k] - offset)
    return found


def centre_of(fits: Sequence[Any], said: np.ndarray, groups: Sequence[slice]) -> np.ndarray:
    """Return the middle between groups of cells, each as heavy, to which `estimates` hold."""
    centre = np.mean([said[one].mean(axis=(0, 1)) for one in groups], axis=0)
    for _ in range(_ROUNDS):
        found = estimates(fits, said, np.clip(centre, 0.0, 1.0))
        centre = np.mean([found[one].mean(axis=(0, 1)) for one in groups], axis=0)
    return np.asarray(np.clip(centre, 0.0, 1.0))


def _line(reference: Reference, centre: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return what a network says of runs at the centre, and how that changes with what is true."""
    away = np.sqrt(((reference.part - centre) ** 2).sum(axis=1))
    count = min(max(int(_SHARE * len(away)), _FEWEST), len(away))
    near = np.argsort(away)[:count]
    weight = 1.0 - (away[near] / (away[near].max() * (1.0 + 1e-9))) ** 2
    x = np.column_stack([np.ones(count), reference.part[near] - centre])
    gram = (x.T * weight) @ x
    gram += 1e-6 * weight.sum() * np.eye(len(gram))
    line = np.linalg.solve(gram, (x.T * weight) @ reference.seen[near])
    names = len(centre)
    return line[0], line[1:].T + _LEAST_SLOPE * np.eye(names)
