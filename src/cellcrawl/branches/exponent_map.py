"""Lyapunov exponents over a plane of parameters, kept in a file that goes on after a kill."""

from __future__ import annotations

import time
from collections.abc import Iterator
from concurrent.futures import Executor
from pathlib import Path
from typing import Any, Final

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.branches.lyapunov import LABELS, ZEROS, lyapunov_exponent
from cellcrawl.branches.storage import FileKeeper, read_arrays, write_arrays
from cellcrawl.errors import InputError
from cellcrawl.laws import as_law
from cellcrawl.laws.law import PAPER
from cellcrawl.parameters import Parameters
from cellcrawl.starts import RandomPerturbation
from cellcrawl.validation import real_number, whole_number

KIND: Final = "cellcrawl lyapunov map"
SCHEMA: Final = 1
_PAUSE = 2.0  # seconds between two writes
_NAMES: Final = tuple(LABELS)
_OPEN = -1  # label of a cell that was not measured yet


def _of_one(task: tuple[dict[str, Any], int, float, Any, bool]) -> tuple[float, float, float, int]:
    values, seed, t_end, laws, early = task
    found = lyapunov_exponent(
        Parameters.from_dict(values), start=RandomPerturbation(seed=seed), t_end=t_end, laws=laws,
        early=early,
    )  # fmt: skip
    return found.value, found.error, found.time, _NAMES.index(found.label)


@checked
def lyapunov_map(
    parameters: Parameters,
    *,
    r_on: Any,
    zeta_1: Any,
    seed: int = 1,
    t_end: float = 1000.0,
    laws: Any = None,
    early: bool = True,
    output: str | Path | None = None,
    executor: Executor | None = None,
) -> xr.Dataset:
    """Return exponents and labels over a grid of two parameters.

    Parameters
    ----------
    parameters : Parameters
        The other parameters.
    r_on, zeta_1 : sequences of float
        Values of the grid.
    seed : int
        Of each cell's random start.
    t_end, laws, early
        As in `lyapunov_exponent`; ``early`` unless told otherwise.
    output : str or Path, optional
        A file for the map, ``map.nc``, written as it grows. A map that was killed goes on when
        asked for again; `open_lyapunov_map` reads it.
    executor : Executor, optional
        Any of `concurrent.futures`, as for `sweep`; one cell after the other here unless given.

    Returns
    -------
    Dataset
        ``exponent``, ``error``, ``time`` and ``label`` over (zeta_1, r_on).

    Raises
    ------
    InputError
        For values out of range, or an output that holds another map.
    """
    across, up = (np.atleast_1d(np.asarray(v, dtype=float)) for v in (r_on, zeta_1))
    law = PAPER if laws is None else as_law(laws)
    header: dict[str, Any] = {
        "parameters": parameters.to_dict(),
        "laws": law.describe(),
        "seed": whole_number("seed", seed, 0, 2**32 - 1),
        "t_end": real_number("t_end", t_end, 40.0, 1e6),
        "early": early,
    }
    arrays: dict[str, np.ndarray] = {"r_on": across, "zeta_1": up}
    size = across.size * up.size
    arrays |= {name: np.full(size, np.nan) for name in ("exponent", "error", "time")}
    arrays["label"] = np.full(size, _OPEN, dtype=np.int64)
    path = None if output is None else Path(output)
    if path is not None and path.exists():
        kept, found = _read(path)
        same = all(np.array_equal(found[name], arrays[name]) for name in ("r_on", "zeta_1"))
        if kept != header or not same:
            raise InputError(f"{path} holds a map of other cells: give another output")
        arrays = found
    cells = [
        parameters.replace(r_on=float(a), zeta_1=float(b)).to_dict() for b in up for a in across
    ]
    left = np.flatnonzero(arrays["label"] == _OPEN)
    tasks = [(cells[k], seed, t_end, law, early) for k in left]
    written = time.monotonic()
    with FileKeeper(path, True, "a map is", "lyapunov_map"):
        try:
            for k, answer in zip(left, _answers(tasks, executor), strict=True):
                arrays["exponent"][k], arrays["error"][k], arrays["time"][k] = answer[:3]
                arrays["label"][k] = answer[3]
                if path is not None and time.monotonic() - written > _PAUSE:
                    write_arrays(path, KIND, SCHEMA, header, arrays)
                    written = time.monotonic()
        finally:
            if path is not None:
                write_arrays(path, KIND, SCHEMA, header, arrays)
    return _dataset(header, arrays)


def _answers(tasks: list[Any], executor: Executor | None) -> Iterator[Any]:
    return iter((executor.map if executor is not None else map)(_of_one, tasks))


@checked
def open_lyapunov_map(path: str | Path) -> xr.Dataset:
    """Return the map in a file, finished or not; what was not measured has an empty label.

    Raises
    ------
    InputError
        If there is none.
    StorageError
        If the file is damaged, or of a newer version.
    """
    return _dataset(*_read(Path(path)))


def _read(path: Path) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    missing, other = f"there is no map at {path}", f"{path} holds no map of Lyapunov exponents"
    header, arrays = read_arrays(path, KIND, SCHEMA, missing, other)
    return header, {name: array.copy() for name, array in arrays.items()}


def _dataset(header: dict[str, Any], arrays: dict[str, np.ndarray]) -> xr.Dataset:
    shape = arrays["zeta_1"].size, arrays["r_on"].size
    dims = ("zeta_1", "r_on")
    label = np.array([*_NAMES, ""])[arrays["label"]]
    return xr.Dataset(
        {
            "exponent": (dims, arrays["exponent"].reshape(shape)),
            "error": (dims, arrays["error"].reshape(shape)),
            "time": (dims, arrays["time"].reshape(shape)),
            "label": (dims, label.reshape(shape)),
        },
        coords={"r_on": arrays["r_on"], "zeta_1": arrays["zeta_1"]},
        attrs={
            "t_end": header["t_end"], "seed": header["seed"], "zeros": ", ".join(ZEROS),
            "elasticity": header["parameters"]["elasticity"],
        },
    )  # fmt: skip
