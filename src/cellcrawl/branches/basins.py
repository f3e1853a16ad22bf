"""Basins: which starts lead to which of the motions that live side by side."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.laws import as_law
from cellcrawl.laws.law import PAPER
from cellcrawl.modes import classify
from cellcrawl.parameters import Parameters
from cellcrawl.simulation import simulate
from cellcrawl.starts import PerturbedCircle, RandomPerturbation
from cellcrawl.starts.base import CellState, Start
from cellcrawl.validation import real_number, whole_number

BREATHING: Final = "breathing at rest"
_BREATHES = 1e-3  # relative range of the tension late in a run
_LATE = 0.7
_T95 = 1.959963984540054  # of a normal distribution
_MOST_STARTS = 100_000


@dataclass(frozen=True)
class BasinShare:
    """How many of some starts lead to one motion.

    Attributes
    ----------
    mode : str
        A mode of `cellcrawl.classify`, "breathing at rest", or the status of a run that ended.
    count, of : int
        Starts that lead there, of how many.
    low, high : float
        The interval of 95 percent around the fraction (Wilson).
    starts : tuple of int
        Numbers of these starts, from 0.
    """

    mode: str
    count: int
    of: int
    low: float
    high: float
    starts: tuple[int, ...]

    @property
    def fraction(self) -> float:
        """Part of the starts."""
        return self.count / self.of

    def __repr__(self) -> str:
        return f"{self.mode}: {self.fraction:.3g} ({self.low:.3g} to {self.high:.3g})"


@dataclass(frozen=True)
class Threshold:
    """The kick between two motions.

    Attributes
    ----------
    low, high : float
        The largest kick known to lead to the one and the smallest known to lead to the other.
    below, above : str
        The motions.
    """

    low: float
    high: float
    below: str
    above: str

    @property
    def value(self) -> float:
        """The kick halfway."""
        return 0.5 * (self.low + self.high)

    def __repr__(self) -> str:
        return f"Threshold({self.below} up to {self.low:.4g}, {self.above} from {self.high:.4g})"


def wilson(count: int, of: int) -> tuple[float, float]:
    """Return the interval of 95 percent of a fraction (Wilson, J. Am. Stat. Assoc. 22, 1927)."""
    part, square = count / of, _T95**2 / of
    middle = (part + 0.5 * square) / (1.0 + square)
    half = math.sqrt(part * (1.0 - part) * square + 0.25 * square**2) / (1.0 + square)
    return max(0.0, middle - half), min(1.0, middle + half)


def fate(parameters: Parameters, start: Start, t_end: float, laws: Any) -> str:
    """Return what a cell does from a start: its mode, a breathing cell told from one at rest."""
    run = simulate(
        parameters, t_end, start=start, laws=laws, nodes=128, save_every=min(0.2, t_end / 200.0)
    )
    if run.attrs["status"] != "completed":
        return str(run.attrs["status"])
    mode = str(classify(run).mode)
    if mode != "stationary":
        return mode
    late = run["tension"].values[int(_LATE * run.sizes["time"]) :]
    return BREATHING if np.ptp(late) > _BREATHES * max(abs(late.mean()), 1.0) else mode


def _fate(task: tuple[dict[str, Any], Start, float, Any]) -> str:
    values, start, t_end, laws = task
    return fate(Parameters.from_dict(values), start, t_end, as_law(laws))


@checked
def basins(
    parameters: Parameters,
    starts: Any = 50,
    *,
    amplitude: float = 0.05,
    t_end: float = 100.0,
    laws: Any = None,
    executor: Executor | None = None,
) -> tuple[BasinShare, ...]:
    """Return which share of some starts leads to which motion, the largest first.

    Parameters
    ----------
    parameters : Parameters
    starts : int or sequence of Start
        So many random ones, with seeds from 1; or these.
    amplitude : float
        Of the random ones, of each of their first 5 waves, 0 to 0.1.
    t_end : float
        How long each runs, 20 to 1e5.
    executor : Executor, optional
        Any of `concurrent.futures`, as for `sweep`.

    Notes
    -----
    A share is one of this set of starts: a basin has no size of its own.

    Examples
    --------
    >>> from cellcrawl import Parameters, branches
    >>> branches.basins(Parameters(r_on=11.5, zeta_1=600), 4, t_end=60)  # doctest: +SKIP
    (gliding: 1 (0.51 to 1),)
    """
    t_end = real_number("t_end", t_end, 20.0, 1e5)
    law = PAPER if laws is None else as_law(laws)
    if isinstance(starts, int | np.integer):
        count = whole_number("starts", starts, 1, _MOST_STARTS)
        size = real_number("amplitude", amplitude, 0.0, 0.1)
        many: Sequence[Start] = [
            RandomPerturbation(seed=seed, amplitude=size, modes=5) for seed in range(1, count + 1)
        ]
    else:
        many = list(starts)
        if not many:
            raise InputError("starts is empty: give a number of random starts, or some starts")
    tasks = [(parameters.to_dict(), start, t_end, law) for start in many]
    found = list((executor.map if executor is not None else map)(_fate, tasks))
    shares = []
    for mode in dict.fromkeys(found):
        numbers = tuple(k for k, one in enumerate(found) if one == mode)
        shares.append(
            BasinShare(mode, len(numbers), len(found), *wilson(len(numbers), len(found)), numbers)
        )
    return tuple(sorted(shares, key=lambda share: -share.count))


def front(kick: float) -> Start:
    """Return a circle whose bound fraction is larger on one side by ``kick``."""
    return PerturbedCircle(bound_fraction={1: (kick, 0.0)})


@dataclass(frozen=True)
class Swollen:
    """A circle with more linkers bound all round, by ``kick``, and a faint front: it breathes.

    Its front, a first wave of the bound fraction by ``front``, is what could grow into crawling.
    """

    kick: float
    front: float = 1e-4

    def state(self, parameters: Parameters, nodes: int) -> CellState:
        """Return the first state on ``nodes`` nodes."""
        made = PerturbedCircle(bound_fraction={1: (self.front, 0.0), 2: (0.0, 0.3 * self.front)})
        cell = made.state(parameters, nodes)
        bound = np.clip(cell.bound_fraction + self.kick, 0.0, 1.0)
        return CellState(cell.curve, bound, cell.tension)

    def describe(self) -> dict[str, Any]:
        """Return what this start is, as plain values for JSON."""
        return {"kind": "Swollen", "kick": self.kick, "front": self.front}


@checked
def threshold_kick(
    parameters: Parameters,
    *,
    kick: Callable[[float], Start] = front,
    low: float = 0.0,
    high: float = 0.05,
    within: float = 1e-3,
    t_end: float = 150.0,
    laws: Any = None,
) -> Threshold:
    """Return how strong a kick takes a cell from one motion to another, by halving.

    Parameters
    ----------
    parameters : Parameters
    kick : function
        Start of a kick's strength; a larger bound fraction on one side (`front`) unless given, or
        all round with `Swollen`.
    low, high : float
        Kicks that lead to different motions.
    within : float
        How near to bring them, relative to ``high``; 1e-6 to 0.5.
    t_end : float
        How long each runs, 20 to 1e5: near the threshold a cell lingers.

    Raises
    ------
    InputError
        If both lead to the same motion.
    """
    within = real_number("within", within, 1e-6, 0.5)
    t_end = real_number("t_end", t_end, 20.0, 1e5)
    low, high = real_number("low", low, -1e3, 1e3), real_number("high", high, -1e3, 1e3)
    law = PAPER if laws is None else as_law(laws)
    below, above = (fate(parameters, kick(size), t_end, law) for size in (low, high))
    if below == above:
        raise InputError(
            f"kicks of {low:g} and of {high:g} both lead to {below!r}: give others for low and high"
        )
    width = within * abs(high - low)
    while abs(high - low) > width:
        middle = 0.5 * (low + high)
        found = fate(parameters, kick(middle), t_end, law)
        if found == below:
            low = middle
        else:
            high, above = middle, found
    return Threshold(low, high, below, above)
