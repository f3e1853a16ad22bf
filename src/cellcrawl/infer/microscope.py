"""A bank seen through one microscope: the same camera, length of film and noise as the data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.infer import camera, films
from cellcrawl.infer.bank import Bank, Block
from cellcrawl.infer.prior import LENGTH_UNIT, TIME_UNIT, Prior, Range
from cellcrawl.infer.summaries import Films, Summary, summaries

_WHOLE: Final = ("completed", "resting")
_CUBIC: Final = 3  # intervals between the records that a cubic takes
_STAYING: Final = 0.25  # lengths that a resting cell stays within
_CREEPING: Final = 0.01  # lengths per usual time: what goes less far has not moved


@dataclass(frozen=True)
class Microscope:
    """What was filmed and how.

    Attributes
    ----------
    frame : float
        Time between frames, in s.
    frames : int
        Number of frames.
    pixel, error : float
        Size of a pixel and standard deviation of the position, in µm; 0 for none.
    radius : float
        Median radius of the cell (square root of area over pi) in µm; 0 for a track alone.
    time_unit : float or Range
        How many s 1/k_off0 lasts, known or not.
    length_unit : float, Range or None
        How many µm R_0 is, known or not; None to read it off the outlines.
    """

    frame: float
    frames: int
    pixel: float
    error: float
    radius: float
    time_unit: float | Range
    length_unit: float | Range | None

    @property
    def outlines(self) -> bool:
        """Whether there are outlines."""
        return self.radius > 0.0

    @property
    def unknown(self) -> dict[str, Range]:
        """The units that are not known."""
        given = {TIME_UNIT: self.time_unit, LENGTH_UNIT: self.length_unit}
        return {name: value for name, value in given.items() if isinstance(value, Range)}

    @property
    def usual_time(self) -> float:
        """A usual 1/k_off0 in s, in which summaries have their times."""
        return _middle(self.time_unit)

    @property
    def usual_length(self) -> float:
        """The unit of length of summaries in µm."""
        if self.length_unit is None:
            return self.radius
        return _middle(self.length_unit)

    def describe(self) -> dict[str, Any]:
        """Return this as plain values for JSON."""

        def plain(value: Any) -> Any:
            if isinstance(value, Range):
                return {"low": value.low, "high": value.high, "scale": value.scale}
            return value

        return {name: plain(value) for name, value in vars(self).items()}

    def in_usual_units(self) -> dict[str, Any]:
        """Return what decides how films look, as numbers by name, without units."""
        told: dict[str, Any] = {
            "frames": float(self.frames),
            "frame": self.frame / self.usual_time,
            "pixel": self.pixel / self.usual_length,
            "error": self.error / self.usual_length,
            "outlines": float(self.outlines),
            "size known": float(self.length_unit is not None),
        }
        for name, range_ in self.unknown.items():
            told[f"{name}, high over low"] = range_.high / range_.low
            told[f"{name}, in its logarithm"] = float(range_.scale == "log")
        return told


@dataclass(frozen=True)
class View:
    """Looks at the runs of a bank through one microscope.

    Attributes
    ----------
    names : tuple of str
        What is unknown: parameters of the cell, then units.
    ranges : tuple of Range
        Their prior.
    run : ndarray of int, shape (look,)
        The run of each look.
    part : ndarray, shape (look, name)
        The unknowns, as parts 0 to 1 of their ranges.
    told : list of Summary
    summaries : ndarray, shape (look, summary)
    unit : ndarray, shape (look,)
        How many µm R_0 is in the look.
    outcomes : dict of str to int
        What became of the looks that were tried: how many were seen, and why others were not.
    """

    names: tuple[str, ...]
    ranges: tuple[Range, ...]
    run: np.ndarray
    part: np.ndarray
    told: list[Summary]
    summaries: np.ndarray
    unit: np.ndarray
    outcomes: dict[str, int]


def look(
    bank: Bank, microscope: Microscope, looks: int = 2, seed: int = 0, which: Any = None
) -> View:
    """Return a bank as a microscope would have seen it.

    Each look draws what is unknown of the units, when in the run the film begins, and the noise.
    A run that ended before the film would have, or that rests in it, is counted and not seen: the
    cell that was filmed lived and moved.

    Raises
    ------
    InputError
        If no run gives such a film.
    """
    numbers = np.arange(len(bank)) if which is None else np.asarray(which)
    unknown = microscope.unknown
    names = (*bank.prior.cell_names, *unknown)
    ranges = (*(bank.prior.ranges[n] for n in bank.prior.cell_names), *unknown.values())
    found: list[tuple[np.ndarray, ...]] = []
    outcomes: dict[str, int] = {}
    told: list[Summary] = []
    for block in bank.blocks(numbers):
        for again in range(looks):
            seen, rows, part, unit, ended = _seen(bank, block, microscope, seed, again)
            for what, count in ended.items():
                outcomes[what] = outcomes.get(what, 0) + count
            if seen is None:
                continue
            told, values = summaries(seen)
            if isinstance(microscope.length_unit, (float, Range)) and microscope.outlines:
                told, values = _with_size(told, values, seen)
            cell = np.column_stack(
                [
                    bank.prior.ranges[n].part(bank.parameters[block.runs[rows], i])
                    for i, n in enumerate(bank.prior.cell_names)
                ]
            )
            found.append((block.runs[rows], np.column_stack([cell, part]), values, unit))
    if not found:
        raise InputError(
            f"no run of {bank.path} gives a film of {microscope.frames} frames of "
            f"{microscope.frame:g} s ({_counted(outcomes)}): give a shorter film, or a bank of "
            "longer runs"
        )
    run, part, values, unit = (np.concatenate(column) for column in zip(*found, strict=True))
    return View(names, ranges, run, part, told, values, unit, outcomes)


def _seen(
    bank: Bank, block: Block, microscope: Microscope, seed: int, again: int
) -> tuple[Films | None, np.ndarray, np.ndarray, np.ndarray, dict[str, int]]:
    count = block.runs.size
    random = np.random.default_rng((seed, again, int(block.runs[0])))
    draws = {name: r.value(random.random(count)) for name, r in microscope.unknown.items()}
    part = np.column_stack(
        [r.part(draws[name]) for name, r in microscope.unknown.items()] or [np.empty((count, 0))]
    )
    time = draws.get(TIME_UNIT, np.full(count, _middle(microscope.time_unit)))
    needed = (microscope.frames - 1) * microscope.frame / time
    outcome = bank.outcomes[block.runs]
    # A run that ended by itself has its last record between two times of the grid.
    early = ~np.isin(outcome, _WHOLE)
    last = np.maximum(block.records - 1 - early, 0)
    there = last * films.SAVE_EVERY
    failed = (outcome == "failed") | (outcome == "killed")
    short = (np.maximum(needed, _CUBIC * films.SAVE_EVERY) > there + 1e-9) & ~failed
    rows = np.flatnonzero(~short & ~failed)
    ended = {"seen": 0, "resting": 0, "failed": int(failed.sum())}
    for name in np.unique(outcome[short]):
        told = "longer than the run" if name in _WHOLE else f"ended before: {name}"
        ended[told] = ended.get(told, 0) + int((short & (outcome == name)).sum())
    if not rows.size:
        return None, rows, part[rows], np.empty(0), ended
    begin = random.random(count)[rows] * (there - needed)[rows]
    at = begin[:, None] + np.arange(microscope.frames) * (microscope.frame / time[rows])[:, None]
    path = _at(block.centroid[rows], at, last[rows])
    modes = _at(block.modes[rows], at, last[rows]) if microscope.outlines else None
    if modes is None:
        unit = draws[LENGTH_UNIT][rows] if LENGTH_UNIT in draws else None
    elif LENGTH_UNIT in draws:
        unit = draws[LENGTH_UNIT][rows]
    elif microscope.length_unit is None:
        area = np.pi * np.sum(films.WAVES * np.abs(modes) ** 2, axis=-1)
        radius = np.sqrt(np.maximum(np.median(area, axis=1), 1e-12) / np.pi)
        unit = microscope.radius / radius
    else:
        unit = None
    if unit is None:
        unit = np.full(rows.size, _middle(microscope.length_unit))
    path, modes = camera.least(path, modes, random)
    path, modes = camera.seen(path, modes, microscope.pixel / unit, microscope.error / unit, random)
    scale = unit / microscope.usual_length
    path = path * scale[:, None]
    moves = ~rests(path, microscope)
    ended |= {"seen": int(moves.sum()), "resting": int((~moves).sum())}
    if not moves.any():
        return None, rows[moves], part[rows[moves]], unit[moves], ended
    modes = None if modes is None else (modes * scale[:, None, None])[moves]
    step = microscope.frame / microscope.usual_time
    return Films(step, path[moves], modes), rows[moves], part[rows[moves]], unit[moves], ended


def rests(path: np.ndarray, microscope: Microscope) -> np.ndarray:
    """Whether films, in the microscope's usual length, show a cell that stays where it is.

    The same rule leaves out looks at a bank and refuses a cell: of a cell that rests nothing is
    seen but that it rests.
    """
    away = np.abs(path - path[:, :1]).max(axis=1)
    span = (microscope.frames - 1) * microscope.frame / microscope.usual_time
    least = _CREEPING * span + 3.0 * microscope.error / microscope.usual_length
    return np.asarray(away < min(_STAYING, least))


def _at(values: np.ndarray, at: np.ndarray, last: np.ndarray) -> np.ndarray:
    """Interpolate films between records: of each row at its own times, shape (row, frame, ...).

    By cubics through the four records around, none after a row's ``last``. Straight lines would
    have a bend at each record, and a network would read the time unit off the bends.
    """
    place = at / films.SAVE_EVERY
    first = np.clip(np.floor(place).astype(int) - 1, 0, last[:, None] - _CUBIC)
    x = place - first
    weights = (
        -(x - 1.0) * (x - 2.0) * (x - 3.0) / 6.0,
        x * (x - 2.0) * (x - 3.0) / 2.0,
        -x * (x - 1.0) * (x - 3.0) / 2.0,
        x * (x - 1.0) * (x - 2.0) / 6.0,
    )
    row = np.arange(len(values))[:, None]
    wave = (np.newaxis,) * (values.ndim - 2)
    terms = (w[..., *wave] * values[row, first + i] for i, w in enumerate(weights))
    return np.asarray(sum(terms))


def _with_size(
    told: list[Summary], values: np.ndarray, seen: Films
) -> tuple[list[Summary], np.ndarray]:
    """Add the size of the cell, which summaries in its own radius do not have."""
    assert seen.modes is not None
    area = np.pi * np.sum(films.WAVES * np.abs(seen.modes) ** 2, axis=-1)
    size = 0.5 * np.log(np.maximum(np.median(area, axis=1), 1e-12) / np.pi)
    return [*told, Summary("log radius", "length", True)], np.column_stack([values, size])


def summaries_of(seen: Films, microscope: Microscope) -> tuple[list[Summary], np.ndarray]:
    """Return the same numbers of a film that somebody brings, in the units of `look`."""
    told, values = summaries(seen)
    if isinstance(microscope.length_unit, (float, Range)) and microscope.outlines:
        told, values = _with_size(told, values, seen)
    return told, values


def _middle(given: float | Range | None) -> float:
    if isinstance(given, Range):
        return float(given.value(np.array(0.5)))
    assert given is not None
    return float(given)


def _counted(outcomes: dict[str, int]) -> str:
    return ", ".join(f"{name} {count}" for name, count in outcomes.items() if count)


__all__ = ["Microscope", "Prior", "View", "look", "rests", "summaries_of"]
