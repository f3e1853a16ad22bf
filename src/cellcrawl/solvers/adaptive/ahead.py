"""Compile the solver's longest kernel in a process beside the one that will call it.

`start` begins it, `wait` ends it. What it compiles lies then where Numba keeps it; what lies there
already is only loaded. `follow` knows no law, and half of a first start is its.
"""

from __future__ import annotations

import atexit
import subprocess
import sys
from pathlib import Path
from typing import Final

from numba import boolean, float64, int64, none, typeof

from cellcrawl.numerics.kernels import KEPT
from cellcrawl.solvers.adaptive.follow import follow
from cellcrawl.solvers.adaptive.frame import fill_frame
from cellcrawl.solvers.adaptive.linked import Linked
from cellcrawl.threads import usable_cores

_PATIENCE: Final = 300.0  # seconds until a process that does not end is no longer waited for
_COUNTS: Final = int64[::1]
_LINE: Final = float64[::1]
_TABLE: Final = float64[:, ::1]
_LAWS: Final = (typeof(Linked(0, 0, 0, 0)), none)  # type: ignore[no-untyped-call]

FOLLOW: Final = (
    *_LAWS, _LINE, float64, float64, int64, float64, int64, int64, _LINE, _COUNTS, _TABLE,
    _LINE, _TABLE, _TABLE, boolean, _TABLE, _TABLE, _TABLE, _LINE, _TABLE, _TABLE, _LINE,
)  # fmt: skip
"""Types of the arguments that `follow` is called with."""
FILL_FRAME: Final = (*_LAWS, float64, _LINE, _TABLE, _LINE, _TABLE, _TABLE, _TABLE)
"""Types of those of `fill_frame`, which is compiled while `follow` is waited for."""

_beside: subprocess.Popen[bytes] | None = None


def nothing_kept() -> bool:
    """Whether this Python has never kept the kernel, as before a first start."""
    folder = follow.stats.cache_path  # type: ignore[attr-defined]
    tag = f"py{sys.version_info.major}{sys.version_info.minor}"
    return folder is not None and not any(Path(folder).glob(f"follow.follow-*.{tag}*.nbi"))


def start() -> None:
    """Begin, once in a process, where there is a core to spare and the result can be kept."""
    global _beside
    if _beside is not None or not KEPT or usable_cores() < 2:
        return
    code = "from cellcrawl.solvers.adaptive import ahead; ahead.follow.compile(ahead.FOLLOW)"
    nothing = subprocess.DEVNULL
    try:
        _beside = subprocess.Popen(
            [sys.executable, "-c", code], stdin=nothing, stdout=nothing, stderr=nothing
        )
    except OSError:
        return  # this process compiles it then
    atexit.register(_beside.kill)  # it lives no longer than this process


def wait() -> None:
    """Let what was begun come to its end: it is nearer to it than a process that begins now."""
    if _beside is None or _beside.poll() is not None:
        return
    fill_frame.compile(FILL_FRAME)  # type: ignore[attr-defined]
    try:
        _beside.wait(_PATIENCE)
    except subprocess.TimeoutExpired:
        _beside.kill()
