"""The file of a bank: HDF5, arrays by run with a checksum each, and one header of JSON.

``/parameters`` (run, name), ``/records``, ``/outcome`` (run), ``/centroid`` (run, record, axis) in
R_0, ``/modes`` (run, record, wave, part) in steps of ``films.QUANTUM``. The attribute ``header`` is
JSON, ``seal`` its hash. Nothing in it is ever executed; a law is named by its class.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import h5py
import numpy as np

from cellcrawl.errors import InputError, StorageError, what_would_help
from cellcrawl.infer import films
from cellcrawl.infer.prior import Prior
from cellcrawl.laws.law import Law
from cellcrawl.parameters import Parameters
from cellcrawl.simulation.lazy import readable
from cellcrawl.sweeps.identity import code_version
from cellcrawl.sweeps.parts import NOT_RUN
from cellcrawl.sweeps.store import SweepStore

SCHEMA: Final = 2
KIND: Final = "cellcrawl bank"
ASKED: Final = {
    "prior": "prior of the cell",
    "law": "law",
    "parameters": "set of fixed parameters",
    "t_end": "length of runs",
    "seed": "seed",
    "code": "version of cellcrawl, whose runs may differ",
}
"""What must be the same for a bank to be gone on with."""
RESTING: Final = "resting"
_OUTCOME: Final = "S16"
_TOGETHER: Final = 8  # runs a chunk of the file holds


def header_of(
    prior: Prior, law: Law, parameters: Parameters, t_end: float, seed: int
) -> dict[str, Any]:
    """Return what a bank's file says of itself, but for what is known when it is made."""
    return {
        "kind": KIND,
        "schema": SCHEMA,
        "code": code_version(),
        "prior": prior.describe(),
        "law": law.describe(),
        "parameters": parameters.to_dict(),
        "t_end": float(t_end),
        "seed": seed,
        "transient": films.TRANSIENT,
        "save_every": films.SAVE_EVERY,
        "quantum": films.QUANTUM,
        "waves": films.WAVES.tolist(),
    }


def read_table(path: Path) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """Return the header of a bank and its arrays by run, all but the films.

    Raises
    ------
    InputError
        If there is no bank in the file, or one of another version.
    StorageError
        If it is damaged.
    """
    if not path.is_file():
        raise InputError(f"there is no bank {path}: make one, as by cellcrawl bank --output {path}")
    with contextlib.suppress(OSError), path.open("rb") as file:
        if not file.read(8).startswith(b"\x89HDF"):
            raise InputError(f"{path} is no bank: it is not a file of `cellcrawl bank`")
    with readable(path), h5py.File(path, "r") as file:
        text, seal = file.attrs.get("header"), file.attrs.get("seal")
        if not isinstance(text, str) or not isinstance(seal, str):
            raise InputError(f"{path} is no bank: it is not a file of `cellcrawl bank`")
        if _hash(text) != seal:
            raise StorageError(f"{path} is damaged: its header is not what its checksum says")
        header = json.loads(text)
        if header.get("kind") != KIND or header.get("schema") != SCHEMA:
            raise InputError(
                f"{path} is a bank of another version (schema {header.get('schema')}, this "
                f"cellcrawl reads {SCHEMA}): make it anew by `cellcrawl bank`"
            )
        table = {name: file[name][()] for name in ("parameters", "records", "outcome")}
    table["outcome"] = table["outcome"].astype(str)
    return header, table


def pack(
    path: Path,
    header: dict[str, Any],
    parameters: np.ndarray,
    done: int,
    work: Path | None = None,
    keys: Sequence[str] = (),
) -> None:
    """Write a bank of the runs it had and of those in a sweep's folder; all or nothing.

    Runs that are missing, after Ctrl-C, end the bank before them, so that it holds the first runs
    of what was asked.
    """
    rows = {} if work is None else _rows(work)
    count = done + next((i for i, key in enumerate(keys) if key not in rows), len(keys))
    if not count:
        raise InputError("no run was finished: the same call goes on")
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        with h5py.File(temporary, "w", libver=("v110", "v110")) as file:
            _write(file, header, parameters[:count], done, path, rows, keys[: count - done], work)
        temporary.replace(path)
    except OSError as error:
        if isinstance(error, StorageError):
            raise
        reason = error.strerror or " ".join(str(error).split())[:120]
        raise StorageError(
            f"cannot write {path}: {reason}; the runs stay where they are, and the same call "
            f"goes on {what_would_help(error, reason)}"
        ) from None
    finally:
        with contextlib.suppress(OSError):
            temporary.unlink(missing_ok=True)


def _write(
    file: Any,
    header: dict[str, Any],
    parameters: np.ndarray,
    done: int,
    path: Path,
    rows: dict[str, dict[str, Any]],
    keys: Sequence[str],
    work: Path | None,
) -> None:
    count, length = len(parameters), films.records_of(header["t_end"])
    waves = len(films.WAVES)
    shape = {"centroid": (length, 2), "modes": (length, waves, 2)}
    kinds = {"centroid": np.float32, "modes": np.int16}
    squeezed = {"compression": "gzip", "compression_opts": 1, "shuffle": True, "fletcher32": True}
    data = {
        name: file.create_dataset(
            name,
            (count, *shape[name]),
            kinds[name],
            chunks=(min(_TOGETHER, count), *shape[name]),
            **squeezed,
        )
        for name in shape
    }
    records = np.zeros(count, np.int32)
    outcome = np.zeros(count, _OUTCOME)
    content = hashlib.sha256()
    if done:
        with readable(path), h5py.File(path, "r") as old:
            records[:done], outcome[:done] = old["records"][()], old["outcome"][()]
            for first in range(0, done, _TOGETHER):
                part = slice(first, min(first + _TOGETHER, done))
                for name, target in data.items():
                    target[part] = old[name][part]
    parts: dict[str, list[tuple[int, str]]] = {}
    for number, key in enumerate(keys, start=done):
        row = rows[key]
        outcome[number] = _outcome(row).encode()
        if row["part"] is not None:
            parts.setdefault(row["part"], []).append((number, key))
    for name, members in parts.items():
        assert work is not None
        layout = SweepStore(work).layout
        with readable(layout.kept(name)), h5py.File(layout.kept(name), "r") as kept:
            for number, key in members:
                path_of_run = kept[key]["centroid"][()][:length]
                records[number] = len(path_of_run)
                data["centroid"][number, : len(path_of_run)] = path_of_run
                data["modes"][number, : len(path_of_run)] = kept[key]["modes"][()][:length]
    for name, values in (("parameters", parameters), ("records", records), ("outcome", outcome)):
        content.update(np.ascontiguousarray(values).tobytes())
        file.create_dataset(name, data=values, chunks=values.shape, fletcher32=True)
    told = json.dumps(header)
    content.update(told.encode())
    digest = content.hexdigest()[:16]
    text = json.dumps({**header, "runs": count, "digest": digest})
    file.attrs["header"], file.attrs["seal"] = text, _hash(text)


def _rows(work: Path) -> dict[str, dict[str, Any]]:
    columns = ("key", "status", "mode", "part")
    store = SweepStore(work)
    return {row["key"]: row for table in store.tables(columns) for row in table.to_pylist()}


def _outcome(row: dict[str, Any]) -> str:
    status = str(row["status"])
    if status in NOT_RUN:
        return status
    return RESTING if row["mode"] == "stationary" else status


def _hash(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()
