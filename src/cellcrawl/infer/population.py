"""Several cells of one assay together, and two conditions beside each other."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.infer import calibrated
from cellcrawl.infer.approximate import FOLDS
from cellcrawl.infer.result import Fit, Interval, quantiles
from cellcrawl.validation import listed, one_of, real_number, shown

FEWEST_CELLS: Final = 3
_GRID: Final = 200
_WIDEST: Final = 0.6  # spread between cells, as a part of the range of the prior
_RIDGE: Final = 1e-4
_OF_FEW: Final = FOLDS / (FOLDS - 2.0)  # a variance from so few networks may be too small


@dataclass(frozen=True, eq=False)
class Group:
    """What the cells of an assay have in common, and how much they differ.

    Attributes
    ----------
    fits : tuple of Fit
    names : tuple of str
    centre, centre_weight : ndarray, shape (name, grid)
        Where the middle of the cells may be, as parts of the ranges, and how likely.
    between, between_weight : ndarray, shape (name, grid)
        Standard deviation between cells, likewise.
    """

    fits: tuple[Fit, ...]
    names: tuple[str, ...]
    centre: np.ndarray
    centre_weight: np.ndarray
    between: np.ndarray
    between_weight: np.ndarray

    @checked
    def interval(self, name: str, level: float = 0.9) -> Interval:
        """Return the middle of the cells with its interval, in the parameter's unit."""
        place = self._place(name)
        at = _ends(level)
        part = quantiles(self.centre[place], self.centre_weight[place], at)
        found = self.fits[0].trained.view.ranges[place].value(part)
        return Interval(*(float(value) for value in found))

    @checked
    def between_cells(self, name: str, level: float = 0.9) -> Interval:
        """Return the spread between cells as a part of the range of the prior."""
        place = self._place(name)
        found = quantiles(self.between[place], self.between_weight[place], _ends(level))
        return Interval(*(float(value) for value in found))

    def _place(self, name: str) -> int:
        one_of("name", name, self.names)
        return self.names.index(name)

    def lines(self) -> list[str]:
        """Return what the cells say together, in a few lines."""
        said = [f"together {len(self.fits)} cells"]
        alarms = sum(fit.alarm for fit in self.fits)
        for name in self.names:
            found, spread = self.interval(name), self.between_cells(name)
            said.append(
                f"{name:12} {found.value:.4g}, 90 % from {found.low:.4g} to {found.high:.4g}; "
                f"between cells {spread.value:.2f} of the prior's range ({spread.low:.2f} to "
                f"{spread.high:.2f})"
            )
        if alarms:
            said.append(f"note     the model makes no such film as {alarms} of the cells show")
        return said

    def summary(self) -> str:
        """Return `lines` as one text."""
        return "\n".join(self.lines())


@dataclass(frozen=True, eq=False)
class Comparison:
    """Two conditions: what moved, by how much, and how sure that is.

    Attributes
    ----------
    names : tuple of str
    shift, error : ndarray, shape (name,)
        Of the mean from the first condition to the second, and its standard error, as parts of the
        ranges of the prior.
    rises : ndarray, shape (name,)
        Probability that each parameter rose.
    moved : ndarray, shape (name,)
        Probability that it is this parameter that moved, if one did and the others did not.
    control, treated : Group
    """

    names: tuple[str, ...]
    shift: np.ndarray
    error: np.ndarray
    rises: np.ndarray
    moved: np.ndarray
    control: Group
    treated: Group

    @property
    def likeliest(self) -> str:
        """The parameter whose move alone explains the difference best."""
        return self.names[int(self.moved.argmax())]

    @checked
    def factor(self, name: str, level: float = 0.9) -> Interval:
        """Return by which factor a parameter changed, at the middle of the first condition."""
        one_of("name", name, self.names)
        place = self.names.index(name)
        range_ = self.control.fits[0].trained.view.ranges[place]
        middle = float(range_.part(np.array(self.control.interval(name).value)))
        wide = _normal_quantile(0.5 + 0.5 * level) * self.error[place]
        moved = middle + self.shift[place] + np.array([0.0, -wide, wide])
        start = float(range_.value(np.array(middle)))
        return Interval(*(float(value) / start for value in range_.value(moved)))

    def lines(self) -> list[str]:
        """Return what moved, in a few lines."""
        said = [
            f"compared {len(self.control.fits)} cells with {len(self.treated.fits)}: "
            f"{self.likeliest} moved, if one parameter did (probability {self.moved.max():.2f})"
        ]
        for i, name in enumerate(self.names):
            found = self.factor(name)
            said.append(
                f"{name:12} times {found.value:.3f}, 90 % from {found.low:.3f} to "
                f"{found.high:.3f}; rose with probability {self.rises[i]:.3f}"
            )
        return said

    def summary(self) -> str:
        """Return `lines` as one text."""
        return "\n".join(self.lines())


@checked
def together(fits: Sequence[Fit]) -> Group:
    """Return what several cells say together: the middle of each parameter, and the spread.

    Parameters
    ----------
    fits : sequence of Fit
        Of one assay, by `fit_all`; at least 3.

    Raises
    ------
    InputError
        For too few cells, or fits with other banks or microscopes.

    Notes
    -----
    Cells are taken as normally spread about a middle, parameter by parameter, and the posterior of
    each as normal; the prior of a cell is flat over its range, so that posterior is its likelihood.
    """
    cells = _alike(fits)
    ranges = cells[0].trained.view.ranges
    mean = np.array([fit.mean for fit in cells])
    spread = np.array([fit.spread for fit in cells])
    centres = np.linspace(0.0, 1.0, _GRID)
    widths = np.linspace(0.0, _WIDEST, _GRID)
    found: dict[str, list[np.ndarray]] = {"centre": [], "between": []}
    for place in range(len(ranges)):
        variance = spread[:, place] ** 2 + widths[:, None] ** 2 + 1e-6
        away = (mean[:, place] - centres[:, None, None]) ** 2  # (centre, width, cell)
        log = -0.5 * (away / variance + np.log(variance)).sum(axis=-1)
        weight = np.exp(log - log.max())
        found["centre"].append(weight.sum(axis=1) / weight.sum())
        found["between"].append(weight.sum(axis=0) / weight.sum())
    names = cells[0].names
    return Group(
        tuple(cells),
        names,
        np.tile(centres, (len(names), 1)),
        np.array(found["centre"]),
        np.tile(widths, (len(names), 1)),
        np.array(found["between"]),
    )


@checked
def compare(control: Sequence[Fit], treated: Sequence[Fit]) -> Comparison:
    """Return which parameter moved between two conditions, by how much and how surely.

    Parameters
    ----------
    control, treated : sequence of Fit
        Cells of each, by `fit_all` with one bank and one microscope; at least 3 each.

    Raises
    ------
    InputError
        For too few cells, or fits that do not go together.

    Notes
    -----
    Each cell's parameters are read by the networks of the fit, held to runs of the bank near them
    that the networks were not trained on: what a film hardly tells is not drawn to the middle of
    the prior. The error has the scatter between cells, with its correlations between parameters,
    and what the networks differ by in the change: an error that all cells of a condition share.
    Each parameter in turn is let move alone; the better that explains the shift, the likelier it is
    the one.
    """
    one, other = _alike(control), _alike(treated)
    cells = _alike([*one, *other])
    said = calibrated.thoughts(cells)
    first, second = slice(0, len(one)), slice(len(one), None)
    centre = calibrated.centre_of(cells, said, (first, second))
    found = calibrated.estimates(cells, said, centre)
    before, after = found[first], found[second]
    shifts = after.mean(axis=0) - before.mean(axis=0)  # as each network sees it
    shift = shifts.mean(axis=0)
    scatter = _scatter(before.mean(axis=1)) / len(one) + _scatter(after.mean(axis=1)) / len(other)
    shared = shifts.var(axis=0, ddof=1) / len(shifts)
    scatter += np.diag(_OF_FEW * shared)
    error = np.sqrt(np.diag(scatter))
    precision = np.linalg.inv(scatter)
    # Of a move along one parameter alone, at its best: the squared misfit that it takes away.
    explained = (precision @ shift) ** 2 / np.diag(precision)
    weight = np.exp(0.5 * (explained - explained.max()))
    rises = np.array([_normal(s / e) for s, e in zip(shift, error, strict=True)])
    return Comparison(
        one[0].names, shift, error, rises, weight / weight.sum(), together(one), together(other)
    )


def _scatter(means: np.ndarray) -> np.ndarray:
    """Covariance between cells, drawn a little to its diagonal: cells are few."""
    found = np.cov(means.T)
    share = means.shape[1] / (means.shape[1] + 2.0 * len(means))
    return np.asarray(
        (1.0 - share) * found + share * np.diag(np.diag(found)) + _RIDGE * np.eye(len(found))
    )


def _alike(fits: Any) -> list[Fit]:
    cells = listed("fits", fits, "a list of fits")
    for one in cells:
        if not isinstance(one, Fit):
            raise InputError(f"fits must be what fit or fit_all returns, not {shown(one)}")
    if len(cells) < FEWEST_CELLS:
        raise InputError(f"{len(cells)} cells are too few to go together: give {FEWEST_CELLS}")
    first = cells[0].trained
    for one in cells[1:]:
        here = one.trained
        if here.bank.digest != first.bank.digest or here.view.names != first.view.names:
            raise InputError("cells that go together are fitted with one bank, all units alike")
    return cells


def _ends(level: float) -> np.ndarray:
    real_number("level", level, 0.0, 1.0)
    return np.array([0.5, 0.5 - 0.5 * level, 0.5 + 0.5 * level])


def _normal(value: float) -> float:
    return 0.5 * (1.0 + math.erf(value / math.sqrt(2.0)))


def _normal_quantile(part: float) -> float:
    from statistics import NormalDist

    return NormalDist().inv_cdf(min(part, 1.0 - 1e-12))
