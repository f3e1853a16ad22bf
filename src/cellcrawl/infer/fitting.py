"""`fit`: from the film of a cell and a bank to what its adhesions may be."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Final

import numpy as np

from cellcrawl.arguments import checked, file_path
from cellcrawl.errors import InputError
from cellcrawl.infer import approximate
from cellcrawl.infer.bank import Bank
from cellcrawl.infer.cells import Cell, cells_of
from cellcrawl.infer.microscope import Microscope, rests, summaries_of
from cellcrawl.infer.prior import LENGTH_UNIT, TIME_UNIT, UNITS, Range, as_range
from cellcrawl.infer.result import Fit
from cellcrawl.infer.summaries import FEWEST_FRAMES
from cellcrawl.infer.trained import Trained, trained
from cellcrawl.validation import is_real, one_of, real_number, shown, whole_number

METHODS: Final = ("abc", "npe")
_SAME: Final = 0.01  # of the interval between frames


@checked
def fit(
    observed: Any,
    bank: Bank,
    *,
    method: str = "abc",
    outlines: Any = None,
    time_unit: Any = None,
    length_unit: Any = None,
    pixel: float | None = None,
    error: float | None = None,
    looks: int = 3,
    seed: int = 0,
    network: str | Path | None = None,
) -> Fit:
    """Return what the parameters of one filmed cell may be, given a bank of runs.

    Parameters
    ----------
    observed : run, Observation, Outlines, Track or Tracks
        One cell; see `fit_all` for several.
    bank : Bank
        What `bank` made.
    method : {"abc", "npe"}
        Regression ABC, or neural posterior estimation (needs ``cellcrawl[infer]``).
    outlines : Outlines, optional
        Where ``observed`` is a track.
    time_unit : float or Range, optional
        How many s 1/k_off0 lasts, or between which bounds; that of the bank's prior unless given.
    length_unit : float or Range, optional
        How many µm R_0 is; read off the outlines unless given. A track alone needs it.
    pixel, error : float, optional
        Size of a pixel, and standard deviation of the position along each axis, in µm (or in the
        units of the run). What pixels do to outlines, and to their centroid, is in without
        ``error``; unless given it is 0, and the pixel that which the outlines show.
    looks : int
        How often each run of the bank is looked at, at other times and with other noise.
    seed : int
        Of the looks and of the networks.
    network : str or Path, optional
        With ``method="npe"``, a file ``.npz``: a network kept there of the same bank and microscope
        is used; otherwise one is trained and kept there. Nothing is overwritten.

    Returns
    -------
    Fit
        Intervals, means, the alarm, and what the film does not tell; ``summary()`` says it all.

    Raises
    ------
    InputError
        For a film without units, too few frames, outlines in some frames only, a cell that rests,
        or a bank that has no such film.
    MissingExtraError
        For ``method="npe"`` without sbi.

    See Also
    --------
    cellcrawl.infer.bank, cellcrawl.infer.together, cellcrawl.infer.compare

    Notes
    -----
    What comes out is right for cells of the model. Whether a cell is one is asked by the alarm,
    and it does not notice everything; see ``Fit.strange``.
    """
    return _fits(
        observed, bank, method, outlines, time_unit, length_unit, pixel, error, looks, seed,
        network, True,
    )[0]  # fmt: skip


@checked
def fit_all(
    observed: Any,
    bank: Bank,
    *,
    method: str = "abc",
    outlines: Any = None,
    time_unit: Any = None,
    length_unit: Any = None,
    pixel: float | None = None,
    error: float | None = None,
    looks: int = 3,
    seed: int = 0,
    network: str | Path | None = None,
) -> list[Fit]:
    """Return a `Fit` of each of several cells of one assay, filmed alike.

    Parameters
    ----------
    observed : Outlines, Tracks, or a sequence of runs, Observations, Outlines and Tracks
    bank, method, outlines, time_unit, length_unit, pixel, error, looks, seed, network
        As in `fit`.

    Returns
    -------
    list of Fit
        All of as many frames as the shortest film has.

    Raises
    ------
    InputError
        As in `fit`; and for films of different frame intervals.
    """
    return _fits(
        observed, bank, method, outlines, time_unit, length_unit, pixel, error, looks, seed,
        network, False,
    )  # fmt: skip


def _fits(
    observed: Any,
    bank: Bank,
    method: str,
    outlines: Any,
    time_unit: Any,
    length_unit: Any,
    pixel: float | None,
    error: float | None,
    looks: int,
    seed: int,
    network: str | Path | None,
    one: bool,
) -> list[Fit]:
    one_of("method", method, METHODS)
    whole_number("looks", looks, 1, 20)
    whole_number("seed", seed, 0, 2**31)
    kept = None if network is None else file_path("network", network)
    if kept is not None and method != "npe":
        raise InputError("network goes with method='npe'")
    cells = cells_of(observed, outlines)
    if not cells:
        raise InputError("there is no cell to fit")
    if one and len(cells) > 1:
        raise InputError(f"there are {len(cells)} cells: choose one, or fit them by fit_all")
    cells, microscope = microscope_of(cells, bank, time_unit, length_unit, pixel, error)
    taught = trained(bank, microscope, looks, seed)
    estimate: Any = None
    if method == "npe":
        from cellcrawl.infer import neural

        estimate = neural.estimate_of(taught, seed, kept)
    return [_fit(cell, taught, method, estimate) for cell in cells]


def microscope_of(
    cells: list[Cell],
    bank: Bank,
    time_unit: Any = None,
    length_unit: Any = None,
    pixel: float | None = None,
    error: float | None = None,
) -> tuple[list[Cell], Microscope]:
    """Return how cells were filmed, and the cells cut to what the bank's runs can show.

    Raises
    ------
    InputError
        For films that do not go together, or units that nobody said.
    """
    frame = cells[0].frame
    for cell in cells:
        if abs(cell.frame - frame) > _SAME * frame or cell.model_units != cells[0].model_units:
            raise InputError(
                f"{cell.name} has a frame every {cell.frame:g} s and {cells[0].name} every "
                f"{frame:g} s: cells that are fitted together are filmed alike"
            )
    with_outlines = [cell.modes is not None for cell in cells]
    if any(with_outlines) and not all(with_outlines):
        raise InputError("some of the cells have outlines and some do not: fit them apart")
    time = _unit(TIME_UNIT, time_unit, bank, 1.0 if cells[0].model_units else None)
    length = _unit(LENGTH_UNIT, length_unit, bank, 1.0 if cells[0].model_units else None)
    if time is None:
        raise InputError(
            "how long 1/k_off0 is must be said, as time_unit=(5, 20, 'log') in s or one number: "
            "the bank's prior has no time_unit"
        )
    outlines = all(with_outlines)
    if length is None and not outlines:
        raise InputError(
            "a track alone does not tell the size of the cell: give length_unit, the radius of the "
            "cell in µm, or its bounds, or give outlines"
        )
    if length is not None and outlines and length_unit is None and not cells[0].model_units:
        length = None if LENGTH_UNIT not in bank.prior.ranges else length
    shortest = time.low if isinstance(time, Range) else time
    most = 1 + math.floor(bank.duration * shortest / frame + 1e-9)
    if most < FEWEST_FRAMES:
        raise InputError(
            f"a frame every {frame:g} s is too seldom for this bank, whose runs show "
            f"{bank.duration:g}/k_off0: {most} frames, and {FEWEST_FRAMES} are needed"
        )
    count = min(min(len(cell.path) for cell in cells), most)
    shown_pixel = max((cell.pixel for cell in cells), default=0.0) if pixel is None else pixel
    size = real_number("pixel", shown_pixel, 0.0, 1e9)
    shift = real_number("error", 0.0 if error is None else error, 0.0, 1e9)
    cut = [_cut(cell, count) for cell in cells]
    radius = float(np.median([cell.radius for cell in cut])) if outlines else 0.0
    if outlines and length is not None:
        radius = 1.0  # what the cell's size is does not change how it is seen
    microscope = Microscope(frame, count, size, shift, radius, time, length)
    for cell in cut:
        _must_move(cell, microscope)
    return cut, microscope


def _must_move(cell: Cell, microscope: Microscope) -> None:
    """Refuse a cell that rests: nothing but that it rests is seen of it."""
    own = cell.radius if microscope.length_unit is None else microscope.usual_length
    film = cell.film(microscope.usual_time, own)
    if rests(film.path, microscope)[0]:
        away = float(np.abs(film.path - film.path[0, 0]).max())
        raise InputError(
            f"{cell.name} rests: it stays within {away:.2f} of its radius, and a resting cell "
            "tells nothing of its adhesions but that they hold it"
        )


def _cut(cell: Cell, count: int) -> Cell:
    if len(cell.path) == count:
        return cell
    note = f"the first {count} of {len(cell.path)} frames are used: the bank's runs show no more"
    short = cell.first(count)
    return Cell(
        short.name, short.frame, short.path, short.modes, short.pixel, short.model_units,
        (*short.notes, note),
    )  # fmt: skip


def _unit(name: str, given: Any, bank: Bank, known: float | None) -> float | Range | None:
    """Return a unit: what was asked, else the model's own, else that of the bank's prior."""
    if given is None:
        return known if known is not None else bank.prior.ranges.get(name)
    if is_real(given):
        return real_number(name, given, 0.0, 1e12, open_low=True, unit=UNITS[name])
    found = as_range(name, given)
    if found.low <= 0.0:
        raise InputError(f"{name} must be above 0 {UNITS[name]}, not {shown(given)}")
    return found


def _fit(cell: Cell, taught: Trained, method: str, estimate: Any) -> Fit:
    microscope = taught.microscope
    film = cell.film(microscope.usual_time, microscope.usual_length)
    _, values = summaries_of(film, microscope)
    plain = approximate.posterior(taught.references, values[0], taught.width)
    samples = plain if estimate is None else estimate.posterior(values[0])
    return Fit.of(cell, taught, values[0], samples, method, plain, estimate)
