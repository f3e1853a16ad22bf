"""Time to import, to run from the shell, and to compile everything, each as a whole process."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

_IMPORT = [sys.executable, "-c", "import cellcrawl"]
_RUN = [sys.executable, "-m", "cellcrawl", "simulate", "--no-movie", "--no-plot"]
_RUN_AND_DRAW = [sys.executable, "-m", "cellcrawl", "simulate", "--no-movie"]


class Start(NamedTuple):
    """Wall time of one command."""

    what: str
    seconds: float


def measure(quick: bool = False) -> Iterator[Start]:
    """Time each command, the best of a few runs; the cold one once, with an empty cache."""
    repeats = 2 if quick else 5
    with tempfile.TemporaryDirectory() as folder:
        empty = {"NUMBA_CACHE_DIR": str(Path(folder) / "numba")}
        yield Start("cold: compile and run to t = 1", _run([*_RUN, "--t-end", "1"], folder, empty))
        yield Start("import cellcrawl", min(_run(_IMPORT, folder, {}) for _ in range(repeats)))
        _run(_RUN_AND_DRAW, folder, {})
        for what, command in (
            ("simulate --no-movie --no-plot, t = 100", _RUN),
            ("simulate --no-movie, t = 100", _RUN_AND_DRAW),
        ):
            yield Start(what, min(_run(command, folder, {}) for _ in range(repeats)))


def _run(command: list[str], folder: str, environment: dict[str, str]) -> float:
    start = time.perf_counter()
    subprocess.run(
        command, check=True, capture_output=True, cwd=folder, env={**os.environ, **environment}
    )
    return time.perf_counter() - start
