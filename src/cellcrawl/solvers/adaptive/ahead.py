"""Compile the solver's longest kernels in a process beside the one that waits for them.

``python -m cellcrawl.solvers.adaptive.ahead`` leaves them where Numba keeps what it compiled; what
lies there already is only loaded. These kernels know no law, and most of a first start is theirs.
"""

from __future__ import annotations

from typing import Any, Final

from numba import boolean, float64, int64, none, typeof

from cellcrawl.numerics.kernels import KEPT
from cellcrawl.solvers.adaptive.follow import follow
from cellcrawl.solvers.adaptive.frame import fill_frame
from cellcrawl.solvers.adaptive.linked import Linked

_COUNTS: Final = int64[::1]
_LINE: Final = float64[::1]
_TABLE: Final = float64[:, ::1]
_LAWS: Final = (typeof(Linked(0, 0, 0, 0)), none)  # type: ignore[no-untyped-call]

LONGEST: Final[dict[Any, tuple[Any, ...]]] = {
    follow: (
        *_LAWS, _LINE, float64, float64, int64, float64, int64, int64, _LINE, _COUNTS, _TABLE,
        _LINE, _TABLE, _TABLE, boolean, _TABLE, _TABLE, _TABLE, _LINE, _TABLE, _TABLE, _LINE,
    ),
    fill_frame: (*_LAWS, float64, _LINE, _TABLE, _LINE, _TABLE, _TABLE, _TABLE),
}  # fmt: skip
"""Types of the arguments that they are called with."""


if __name__ == "__main__" and KEPT:
    for kernel, arguments in LONGEST.items():
        kernel.compile(arguments)
