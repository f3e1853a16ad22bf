"""A bank: thousands of runs of cells drawn from a prior, in one file, made once and shared."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from typing import Any, Final, NamedTuple

import h5py
import numpy as np

from cellcrawl.arguments import checked, file_path
from cellcrawl.errors import StorageError
from cellcrawl.infer import bank_file, films
from cellcrawl.infer.bank_runs import MOST, Runs, runs_there
from cellcrawl.infer.prior import PAPER_PRIOR, Prior, law_named
from cellcrawl.laws.law import Law
from cellcrawl.locks import locked
from cellcrawl.parameters import Parameters
from cellcrawl.simulation.lazy import readable
from cellcrawl.sweeps.driver import Sweeping
from cellcrawl.sweeps.identity import run_key
from cellcrawl.validation import real_number, whole_number

SUFFIX: Final = ".h5"
_KEEP: Final = "tracks"  # what a sweep calls it when each run leaves a dataset
_BLOCK: Final = 256  # runs read at a time
SHORTEST: Final = films.TRANSIENT + 10.0


class Block(NamedTuple):
    """Some runs of a bank, in memory.

    Attributes
    ----------
    runs : ndarray of int, shape (run,)
        Their numbers.
    records : ndarray of int, shape (run,)
        How many records each film has; what comes after is nothing.
    centroid : ndarray of complex, shape (run, record)
    modes : ndarray of complex, shape (run, record, wave)
        See `films.modes_of_edge`.
    """

    runs: np.ndarray
    records: np.ndarray
    centroid: np.ndarray
    modes: np.ndarray


class Bank:
    """A bank as its file has it; films are read when they are asked for.

    Parameters
    ----------
    path : str or Path
        The file.

    Attributes
    ----------
    path : Path
    prior : Prior
    law : Law
    interrupted : bool
        Whether the call that returned this was stopped by Ctrl-C; see `bank`.

    Raises
    ------
    InputError
        If there is no bank, or one of another version.
    StorageError
        If it is damaged.
    """

    @checked
    def __init__(self, path: str | Path) -> None:
        self.path = file_path("bank", path)
        self._header, table = bank_file.read_table(self.path)
        self.prior = Prior(self._header["prior"])
        self.law: Law = law_named(self._header["law"])
        self.interrupted = False
        self._table = table

    def __len__(self) -> int:
        return int(self.parameters.shape[0])

    @property
    def parameters(self) -> np.ndarray:
        """Cell parameters of each run, in the order of ``prior.cell_names``, shape (run, name)."""
        return self._table["parameters"]

    @property
    def records(self) -> np.ndarray:
        """How many records each film has, shape (run,)."""
        return self._table["records"]

    @property
    def outcomes(self) -> np.ndarray:
        """How each run ended, by the status of a run, and "resting" for a cell that never moved."""
        return self._table["outcome"]

    @property
    def held(self) -> Parameters:
        """Values of the parameters that the prior leaves alone."""
        return Parameters.from_dict(self._header["parameters"])

    @property
    def duration(self) -> float:
        """Longest film that the runs give, in 1/k_off0."""
        return float(self._header["t_end"]) - films.TRANSIENT

    @property
    def digest(self) -> str:
        """Hash of all that decides the runs, with that of what they gave."""
        return str(self._header["digest"])

    @cached_property
    def header(self) -> dict[str, Any]:
        """What the file says of itself."""
        return dict(self._header)

    def blocks(self, which: np.ndarray | None = None) -> Iterator[Block]:
        """Yield films, some hundred runs at a time, so that memory stays flat.

        Parameters
        ----------
        which : ndarray of int, optional
            Numbers of the runs, rising; all unless given.
        """
        numbers = np.arange(len(self)) if which is None else np.asarray(which, int)
        with readable(self.path), h5py.File(self.path, "r") as file:
            for first in range(0, numbers.size, _BLOCK):
                chosen = numbers[first : first + _BLOCK]
                if not chosen.size:
                    return
                span = slice(int(chosen[0]), int(chosen[-1]) + 1)
                place = chosen - span.start
                path = file["centroid"][span][place]
                modes = file["modes"][span][place]
                yield Block(
                    chosen,
                    self.records[chosen],
                    path[..., 0] + 1j * path[..., 1],
                    films.QUANTUM * (modes[..., 0] + 1j * modes[..., 1].astype(float)),
                )

    def lines(self) -> list[str]:
        """Return what the bank holds, in a few lines."""
        names, counts = np.unique(self.outcomes, return_counts=True)
        ended = ", ".join(f"{n} {c}" for n, c in sorted(zip(names, counts, strict=True)))
        ranges = [f"prior    {name}: {found}" for name, found in self.prior.ranges.items()]
        return [
            f"bank     {self.path}: {len(self)} runs to t = {self._header['t_end']:g}, seed "
            f"{self._header['seed']}, law {type(self.law).__name__}",
            *ranges,
            f"ended    {ended}",
            f"made by  cellcrawl {self._header['code']}; hash {self.digest}",
            *(
                f"adopted  {one['runs']} runs of {one['code']}, {one['made again']} of them made "
                "again: the same"
                for one in self._header.get("adopted", [])
            ),
        ]

    def summary(self) -> str:
        """Return `lines` as one text."""
        return "\n".join(self.lines())

    def __repr__(self) -> str:
        return f"<Bank {self.path}: {len(self)} runs>"


@checked
def bank(
    prior: Prior | None = None,
    runs: int = 10_000,
    output: str | Path = "bank.h5",
    *,
    laws: Any = "paper",
    parameters: Parameters | None = None,
    t_end: float = 70.0,
    seed: int = 1,
    executor: Any = None,
    workers: int | None = None,
    progress: bool = False,
    adopt: bool = False,
) -> Bank:
    """Make runs of cells drawn from a prior and keep a film of each, in one file.

    A run is made once and can be seen through any microscope later: the file holds the path of the
    centroid and the outline over time, without noise and pixels.

    Parameters
    ----------
    prior : Prior, optional
        What is unknown; `PAPER_PRIOR` unless given.
    runs : int
        Number of runs. A file that is there with fewer runs of the same kind is gone on with.
    output : str or Path
        The file. What is under way lies in the folder of the same name with ``.work`` meanwhile.
    laws : law set
        As in `simulate`. Its own numbers may be in the prior, as ``laws.gain``.
    parameters : Parameters, optional
        Values of what the prior leaves alone.
    t_end : float
        Length of each run in 1/k_off0, at least 20; films leave out the first 10.
    seed : int
        Of the parameters drawn and of the random starts.
    executor, workers, progress
        As in `sweep`.
    adopt : bool
        Go on also with a file of another version of cellcrawl, if 24 of its runs, made again by
        this one, are the same to the last bit; the file says so afterwards.

    Returns
    -------
    Bank
        After Ctrl-C of the runs there are, with ``interrupted`` true; the same call goes on.

    Raises
    ------
    InputError
        For a prior that the law cannot take, or a file of another bank; it is not overwritten.
    StorageError
        If the file cannot be written.

    See Also
    --------
    cellcrawl.infer.fit, cellcrawl.sweep

    Notes
    -----
    Run number i has the same parameters and the same start whatever the number of runs, so that a
    larger bank begins with a smaller one. Cells that tear or leave the model's range are kept up
    to then; cells that rest are kept and named so.
    """
    prior = PAPER_PRIOR if prior is None else prior
    law = law_named(laws)
    prior.check_law(law)
    whole_number("runs", runs, 1, MOST)
    whole_number("seed", seed, 0, 2**31)
    real_number("t_end", t_end, SHORTEST, 1e6)
    path = file_path("output", output)
    all_runs = Runs(prior, law, parameters or Parameters(), float(t_end), seed)
    done, adopted = runs_there(path, all_runs, adopt)
    if done >= runs:
        return Bank(path)
    header = all_runs.header() | ({"adopted": adopted} if adopted else {})
    grid = all_runs.grid(range(done, runs))
    # A folder of a smaller number of runs, left by Ctrl-C, has the first of these runs already.
    work = path.with_name(f"{path.name}.work")
    with locked(path.with_name(f"{path.name}.lock"), path, remove=True):
        with Sweeping(
            work, grid, executor, workers, _KEEP, "bank", extend=True, execute=films.execute
        ) as at_work:
            at_work.make(grid, range(len(grid)), progress)
        keys = [run_key(run, _KEEP) for run in grid]
        bank_file.pack(path, header, all_runs.drawn(range(runs)), done, work, keys)
        if not at_work.interrupted:
            shutil.rmtree(work, ignore_errors=True)
    made = Bank(path)
    made.interrupted = at_work.interrupted
    return made


@checked
def open_bank(path: str | Path) -> Bank:
    """Return the bank in a file.

    Raises
    ------
    InputError
        If there is none, or it is of another version.
    StorageError
        If it is damaged.
    """
    return Bank(path)


__all__ = ["Bank", "Block", "StorageError", "bank", "open_bank"]
