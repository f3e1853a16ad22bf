"""What a fit says: intervals, what the film does not tell, whether the model makes such films."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, NamedTuple, Self

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.infer.approximate import Samples
from cellcrawl.infer.cells import Cell
from cellcrawl.infer.prior import LENGTH_UNIT, meaning_of, unit_of
from cellcrawl.infer.trained import Calibration, Trained
from cellcrawl.parameters import DESCRIPTIONS, Parameters
from cellcrawl.sweeps.identity import code_version
from cellcrawl.validation import one_of, real_number

UNTOLD: Final = 0.75
"""A posterior of this part of the prior's spread, or more, tells next to nothing."""
_EDGE: Final = 0.03  # of a range: a posterior with much of itself there wants a wider prior
_PILED: Final = 0.25
_ODD: Final = 5.0  # spreads that a single summary may be off
_LISTED: Final = 8
_SHAKING: Final = "velocity correlation at 1 frames"
_APART: Final = 1.0  # standard deviations between two methods that are told


class Interval(NamedTuple):
    """A number and the bounds between which it lies with the probability asked for."""

    value: float
    low: float
    high: float


class Strange(NamedTuple):
    """A summary that the model does not make with any parameters like the cell's."""

    name: str
    unit: str
    spreads: float


@dataclass(frozen=True, eq=False)
class Fit:
    """The posterior of one cell.

    Attributes
    ----------
    cell : Cell
    trained : Trained
        The bank as seen through the cell's microscope, with its calibration.
    summaries : ndarray, shape (summary,)
    samples : Samples
        As parts of the ranges of the prior; `values` has them in units.
    method : str
    abc : Samples
        The posterior of regression ABC, to which that of ``method`` is held.
    strangeness : float
        Distance from what the model makes, over that of the alarm: above 1 it is no cell of it.
    estimate : object
        The trained network, of a neural posterior.
    """

    cell: Cell
    trained: Trained
    summaries: np.ndarray
    samples: Samples
    method: str
    abc: Samples
    strangeness: float
    estimate: Any = None

    @classmethod
    def of(
        cls,
        cell: Cell,
        trained: Trained,
        summaries: np.ndarray,
        samples: Samples,
        method: str,
        plain: Samples,
        estimate: Any = None,
    ) -> Self:
        """Return the fit with its alarm."""
        thought = trained.thought(summaries[None])
        away = float(trained.alarm.strangeness(thought, summaries[None])[0])
        away /= trained.alarm.threshold
        return cls(cell, trained, summaries, samples, method, plain, away, estimate)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of what was unknown."""
        return self.trained.view.names

    @property
    def values(self) -> np.ndarray:
        """Samples of the posterior, shape (sample, name), in the units of the parameters."""
        return self._in_units(self.samples.part)

    @property
    def calibration(self) -> Calibration:
        """How posteriors of the method stand to the truth, of cells of the bank set apart."""
        known: Calibration = self.trained.calibration
        return known if self.estimate is None else self.estimate.calibration

    def _in_units(self, part: np.ndarray) -> np.ndarray:
        ranges = self.trained.view.ranges
        return np.column_stack([r.value(part[:, i]) for i, r in enumerate(ranges)])

    @property
    def alarm(self) -> bool:
        """Whether the model makes no such film, as far as the alarm can tell."""
        return self.strangeness > 1.0

    @checked
    def interval(self, name: str, level: float = 0.9) -> Interval:
        """Return the median and the central interval of a parameter.

        Raises
        ------
        InputError
            For a name that was not unknown.
        """
        one_of("name", name, self.names)
        real_number("level", level, 0.0, 1.0)
        place = self.names.index(name)
        at = np.array([0.5, 0.5 - 0.5 * level, 0.5 + 0.5 * level])
        part = quantiles(self.samples.part[:, place], self.samples.weight, at)
        return Interval(*(float(v) for v in self.trained.view.ranges[place].value(part)))

    @property
    def mean(self) -> np.ndarray:
        """Mean of the posterior, as parts of the ranges, shape (name,)."""
        return np.asarray(self.samples.weight @ self.samples.part)

    @property
    def spread(self) -> np.ndarray:
        """Standard deviation of the posterior, as parts of the ranges."""
        return _spread(self.samples)

    @property
    def narrowed(self) -> np.ndarray:
        """Spread of the posterior over that of the prior: 1 where the film tells nothing."""
        return np.asarray(self.spread / np.sqrt(1.0 / 12.0))

    @property
    def untold(self) -> tuple[str, ...]:
        """Parameters that the film does not tell."""
        return tuple(
            name for name, part in zip(self.names, self.narrowed, strict=True) if part > UNTOLD
        )

    @property
    def at_the_edge(self) -> tuple[str, ...]:
        """Parameters that pile up at an end of their prior: the cell may lie beyond."""
        found = []
        for place, name in enumerate(self.names):
            part = self.samples.part[:, place]
            for end in (part < _EDGE, part > 1.0 - _EDGE):
                if self.samples.weight @ end > _PILED:
                    found.append(name)
        return tuple(dict.fromkeys(found))

    @property
    def strange(self) -> tuple[Strange, ...]:
        """Summaries that the model does not make, the strangest first."""
        thought = self.trained.thought(self.summaries[None])
        left = self.trained.alarm.left(thought, self.summaries[None])[0]
        order = np.argsort(-np.abs(left))
        told = self.trained.view.told
        return tuple(
            Strange(told[i].name, told[i].unit, float(left[i]))
            for i in order[:_LISTED]
            if abs(left[i]) > _ODD
        )

    @property
    def disagreement(self) -> dict[str, float]:
        """Parameters on which the two methods differ by more than a standard deviation."""
        if self.samples is self.abc:
            return {}
        wide = np.maximum(np.minimum(self.spread, _spread(self.abc)), 1e-9)
        away = np.abs(self.mean - self.abc.weight @ self.abc.part) / wide
        return {n: float(a) for n, a in zip(self.names, away, strict=True) if a > _APART}

    @property
    def radius(self) -> Interval | None:
        """The unit of length R_0 in µm, where it is read off the outlines; 90 percent."""
        if self.trained.microscope.length_unit is not None or self.cell.modes is None:
            return None
        unit = self.trained.view.unit[self.abc.row] * (
            self.cell.radius / self.trained.microscope.radius
        )
        found = quantiles(unit, self.abc.weight, np.array([0.5, 0.05, 0.95]))
        return Interval(*(float(value) for value in found))

    def parameters(self, sample: int | None = None) -> Parameters:
        """Return the cell at the median of the posterior, or at one of its samples."""
        if sample is None:
            chosen = np.array([self.interval(name).value for name in self.names])
        else:
            chosen = self.values[sample]
        named = dict(zip(self.names, chosen, strict=True))
        own = {name: float(value) for name, value in named.items() if name in DESCRIPTIONS}
        return self.trained.bank.held.replace(**own)

    def table(self, level: float = 0.9) -> list[dict[str, Any]]:
        """Return a row a parameter: name, unit, meaning, median, bounds and what is to be said."""
        rows = []
        for name, narrowed in zip(self.names, self.narrowed, strict=True):
            found = self.interval(name, level)
            rows.append(
                {
                    "name": name,
                    "unit": "" if self.cell.model_units else unit_of(name),
                    "meaning": meaning_of(name),
                    **found._asdict(),
                    "of the prior": float(narrowed),
                }
            )
        if self.radius is not None:
            rows.append(
                {
                    "name": LENGTH_UNIT,
                    "unit": "" if self.cell.model_units else unit_of(LENGTH_UNIT),
                    "meaning": meaning_of(LENGTH_UNIT),
                    **self.radius._asdict(),
                    "of the prior": float("nan"),
                }
            )
        return rows

    @property
    def caveats(self) -> tuple[str, ...]:
        """What a reader of the intervals must know, a sentence each."""
        said = list(self.cell.notes)
        if self.alarm:
            said.append(
                f"the model makes no such film (alarm {self.strangeness:.2f}, above 1): do not "
                "believe the intervals"
            )
        if self.strange:
            odd = ", ".join(f"{one.name} ({one.spreads:+.0f} spreads)" for one in self.strange[:3])
            said.append(f"what the model does not make: {odd}")
        if any(one.name == _SHAKING and one.spreads < 0.0 for one in self.strange):
            said.append(
                "the path goes to and fro from frame to frame, as one does whose position has an "
                f"error: it is taken for {self.trained.microscope.error:g}; give the error"
            )
        said += [f"this film does not fix {name}" for name in self.untold]
        said += [
            f"{name} piles up at an end of its prior: the cell may lie beyond it, in a wider bank"
            for name in self.at_the_edge
        ]
        said += [
            f"the two methods differ on {name} by {away:.1f} standard deviations"
            for name, away in self.disagreement.items()
        ]
        if self.trained.bank.header["code"] != code_version():
            said.append(
                f"the bank was made by cellcrawl {self.trained.bank.header['code']}, another "
                "version than this"
            )
        shortest = self.calibration.coverage(0.9)
        for name, held in zip(self.names, shortest, strict=True):
            if not 0.84 <= held <= 0.96:
                said.append(
                    f"intervals of 90 % of {name} hold the truth for {held:.0%} of cells of the "
                    "bank set apart"
                )
        return tuple(said)

    def lines(self) -> list[str]:
        """Return what was found, in a few lines."""
        microscope = self.trained.microscope
        kind = "track and outlines" if self.cell.modes is not None else "track alone"
        bank = self.trained.bank
        said = [
            f"cell     {self.cell.name}: {len(self.cell.path)} frames every {self.cell.frame:g} "
            f"{'/k_off0' if self.cell.model_units else 's'}, {kind}",
            f"bank     {bank.path.name}: {self.trained.view.outcomes['seen']} looks at "
            f"{len(bank)} runs, law {type(bank.law).__name__}, hash {bank.digest}",
            f"method   {'regression ABC' if self.method == 'abc' else 'neural posterior'}, "
            f"pixel {microscope.pixel:g}, error {microscope.error:g}",
        ]
        for row in self.table():
            unit = f" {row['unit']}" if row["unit"] else ""
            said.append(
                f"{row['name']:12} {row['value']:.4g}{unit}, 90 % from {row['low']:.4g} to "
                f"{row['high']:.4g}"
            )
        return [*said, *(f"note     {one}" for one in self.caveats)]

    def summary(self) -> str:
        """Return `lines` as one text."""
        return "\n".join(self.lines())

    def __repr__(self) -> str:
        return f"<Fit of {self.cell.name} by {self.method}: {len(self.names)} unknowns>"


def quantiles(values: np.ndarray, weight: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return weighted quantiles of samples."""
    order = np.argsort(values)
    cumulated = np.cumsum(weight[order])
    middle = (cumulated - 0.5 * weight[order]) / cumulated[-1]
    return np.asarray(np.interp(at, middle, values[order]))


def _spread(samples: Samples) -> np.ndarray:
    mean = samples.weight @ samples.part
    return np.asarray(np.sqrt(np.maximum(samples.weight @ (samples.part - mean) ** 2, 0.0)))
