"""Which runs a bank has and is to have; a bank of another version is gone on with if they agree."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import h5py
import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.infer import bank_file, films
from cellcrawl.infer.prior import Prior, point_of
from cellcrawl.laws.law import Law
from cellcrawl.locks import locked
from cellcrawl.parameters import Parameters
from cellcrawl.simulation.description import RunDescription
from cellcrawl.simulation.lazy import readable
from cellcrawl.sweeps.grid import Grid

MOST: Final = 10_000_000
TRIED: Final = 24
"""Runs of a bank of another version that are made again."""


@dataclass(frozen=True)
class Runs:
    """The runs of a bank by number: the same run whatever the number of runs.

    Parameters
    ----------
    prior, law, parameters, t_end, seed
        As in `bank`.
    """

    prior: Prior
    law: Law
    parameters: Parameters
    t_end: float
    seed: int

    def header(self) -> dict[str, Any]:
        """Return what the file of such a bank says of itself."""
        return bank_file.header_of(self.prior, self.law, self.parameters, self.t_end, self.seed)

    def drawn(self, numbers: Iterable[int]) -> np.ndarray:
        """Return their parameters, shape (run, name)."""
        return np.concatenate([self.prior.draw(range(n, n + 1), self.seed) for n in numbers])

    def grid(self, numbers: Iterable[int]) -> Grid:
        """Return these runs, to be made; no two runs of banks of any seed share a start."""
        return Grid(
            points=[
                {
                    **point_of(self.prior.cell_names, self.drawn([number])[0], self.law),
                    "seed": self.seed * MOST + number,
                }
                for number in numbers
            ],
            parameters=self.parameters,
            laws=self.law,
            **films.settings(self.t_end),
        )


def runs_there(path: Path, runs: Runs, adopt: bool) -> tuple[int, list[Any]]:
    """Return how many runs a file has already, and those adopted, or refuse to overwrite it.

    Raises
    ------
    InputError
        For another bank; for one of another version unless ``adopt``, or whose runs differ.
    """
    if not path.exists():
        return 0, []
    wanted = runs.header()
    found, table = bank_file.read_table(path)
    for name, what in bank_file.ASKED.items():
        if found[name] != wanted[name] and not (name == "code" and adopt):
            raise InputError(
                f"{path} is a bank with another {what}: give another output"
                f"{', or adopt it' if name == 'code' else ''}; it is not overwritten"
            )
    adopted = list(found.get("adopted", []))
    done = len(table["records"])
    if found["code"] != wanted["code"]:
        _must_be_the_same(path, runs, done)
        adopted.append({"code": found["code"], "runs": done, "made again": min(TRIED, done)})
        with locked(path.with_name(f"{path.name}.lock"), path, remove=True):
            header = {**wanted, "adopted": adopted}
            bank_file.pack(path, header, runs.drawn(range(done)), done)
    return done, adopted


def _must_be_the_same(path: Path, runs: Runs, done: int) -> None:
    """Refuse a bank whose runs differ, in any bit of their films, from those of this version."""
    numbers = sorted({round(place) for place in np.linspace(0, done - 1, min(TRIED, done))})
    with readable(path), h5py.File(path, "r") as file:
        for number, run in zip(numbers, runs.grid(numbers), strict=True):
            if not _same(file, number, run):
                raise InputError(
                    f"run {number} of {path}, made again, is another than it was: make the bank "
                    "anew, to another output; it is not overwritten"
                )


def _same(file: Any, number: int, run: RunDescription) -> bool:
    made = films.execute(run, "tracks").dataset
    length = int(file["records"][number])
    if made is None or made.sizes["time"] < length:
        return False
    return all(
        np.array_equal(made[name].values[:length], file[name][number, :length])
        for name in ("centroid", "modes")
    )
