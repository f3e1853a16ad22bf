"""The one place that says how numerical kernels are compiled."""

from __future__ import annotations

import getpass
import multiprocessing
import os
import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final, TypeVar, cast

import numba
from numba.extending import register_jitable

F = TypeVar("F", bound=Callable[..., object])


_compile: Any = numba.njit  # its types do not know every option


def _keeps_kernels() -> bool:
    """Whether compiled kernels can be kept on disk; say so once where they cannot stay.

    Numba keeps them beside the code or in the user's cache folder. Where neither can be written, as
    in containers and on clusters, they go to a folder of the user's among the temporary files.
    """
    if _has_a_place():
        return True
    folder = _temporary_folder()
    kept = folder is not None
    if kept:
        os.environ["NUMBA_CACHE_DIR"] = str(folder)  # for workers too
        setattr(numba.config, "CACHE_DIR", str(folder))  # noqa: B010, which its types lack
        kept = _has_a_place()
    if multiprocessing.parent_process() is not None:
        return kept  # who started this worker has been told
    where = (
        f"they are kept in {folder}, as long as that stays"
        if kept
        else "every start compiles anew, which takes a minute"
    )
    warnings.warn(
        f"no folder for compiled kernels can be written, neither {Path(__file__).parent} nor one "
        f"in your home: {where}; set NUMBA_CACHE_DIR to a folder that can be written",
        UserWarning,
        stacklevel=2,
    )
    return kept


def _has_a_place() -> bool:
    try:
        _compile(cache=True)(_probe)
    except RuntimeError:
        return False
    return True


def _probe() -> None:
    """Stand for any kernel of this package; never compiled."""


def _temporary_folder() -> Path | None:
    """Return a folder that only this user can write: what lies there is run as code."""
    try:
        user = getpass.getuser()
    except (OSError, KeyError, ImportError):
        user = "user"
    folder = Path(tempfile.gettempdir()) / f"cellcrawl-kernels-{user}"
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        found = folder.lstat()
    except OSError:
        return None
    if hasattr(os, "getuid") and (found.st_uid != os.getuid() or found.st_mode & 0o022):
        return None
    return folder if folder.is_dir() and not folder.is_symlink() else None


KEPT: Final = _keeps_kernels()
"""Whether what was compiled stays on the disk for other processes and the next start."""

_CACHED: Final[dict[str, Any]] = {
    "cache": KEPT,
    "error_model": "numpy",
    "no_cfunc_wrapper": True,  # nothing calls a kernel through a C function pointer
    "forceinline": False,  # said, or it is taken over from the inlined function that calls first
}


INLINED: Final[Any] = {
    "error_model": "numpy",
    "forceinline": True,
    "no_cpython_wrapper": True,
    "no_cfunc_wrapper": True,
}
"""How functions are compiled that belong to a caller."""


def kernel(function: F) -> F:
    """Compile a numerical kernel: cached on disk, divisions vectorise.

    Arithmetic is strict IEEE, and NaN and infinity keep their meaning. Were products and sums let
    fuse, whether they do would hang on what else a process compiled before, and a run's last bits
    with it; it would save three parts in a hundred of the time.
    """
    return cast(F, _compile(**_CACHED)(function))


def expanded_kernel(function: F) -> F:
    """Like `kernel`, but a caller compiles it as if it were written there.

    For long parts with one caller or two: a kernel is otherwise optimised once by itself and again
    within each of its callers. Called from Python it is compiled by itself.
    """
    return cast(F, _compile(**_CACHED, inline="always")(function))


def inlined_kernel(function: F) -> F:
    """Let kernels compile a few lines as `kernel` does, inlined wherever they are called.

    Python sees the function as it was written; it works on whole arrays if its lines do.
    """
    inlined: F = register_jitable(**INLINED)(function)
    return inlined
