"""What tells one run from another: a hash of all that decides its result."""

from __future__ import annotations

import functools
import hashlib
import json
from pathlib import Path
from typing import Any, Final

import numpy as np

from cellcrawl.simulation.dataset import package_version
from cellcrawl.simulation.description import RunDescription
from cellcrawl.simulation.from_run import FromRun
from cellcrawl.starts import Start

ROW_SCHEMA: Final = 1
_DECIDING: Final = (
    "data",
    "laws",
    "parameters",
    "physics",
    "curve",
    "linear",
    "starts",
    "solvers",
    "surroundings",
    "simulation",
    "observables",
    "modes",
    "sweeps/measures.py",
)


@functools.cache
def code_version() -> str:
    """Return the package's version and a hash of the code that decides a run's result."""
    package = Path(__file__).parents[1]
    digest = hashlib.sha256()
    for name in _DECIDING:
        path = package / name
        files = sorted(path.rglob("*")) if path.is_dir() else [path]
        for file in files:
            if file.suffix in (".py", ".txt"):
                digest.update(file.relative_to(package).as_posix().encode())
                digest.update(file.read_bytes().replace(b"\r\n", b"\n"))
    return f"{package_version()}+{digest.hexdigest()[:12]}"


def run_key(run: RunDescription, keep: str) -> str:
    """Return the hash that names a run: the same for the same result, by the same code."""
    described = run.describe()
    described["start"] = start_identity(run.start)
    content = [ROW_SCHEMA, code_version(), keep, described]
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()[:32]


def start_identity(start: Start) -> dict[str, Any]:
    """Return a start as plain values; one from a saved run with a hash of the state it takes."""
    described = start.describe()
    if isinstance(start, FromRun):
        described["state"] = _state_hash(start)
    return described


@functools.lru_cache(maxsize=1024)
def _state_hash(start: FromRun) -> str:
    frame = start.saved_record()
    digest = hashlib.sha256()
    for name in ("x", "y", "theta", "length", "bound_fraction", "tension"):
        digest.update(np.ascontiguousarray(frame[name].values, dtype=float).tobytes())
    return digest.hexdigest()[:32]
