"""Write the entry points' unoptimised, host-neutral LLVM text; run in a process of its own.

Numba reads its settings when it is imported, so `module` starts this file with the environment that
leaves the text free of the machine it was made on.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numba
from numba.core import types

from cellcrawl.explorer import libm
from cellcrawl.explorer.entries import Entry, entries

_OPTIONS: Any = {"error_model": "numpy", "no_cpython_wrapper": True, "no_cfunc_wrapper": True}


def text_of(entry: Entry) -> tuple[str, str]:
    """Return the name Numba gave an entry point and its LLVM text, callees included."""
    compiled: Any = numba.njit(**_OPTIONS)(entry.function)
    compiled.compile(entry.signature)
    found = compiled.overloads[entry.signature.args]
    return found.fndesc.llvm_func_name, compiled.inspect_llvm(entry.signature.args)


def functions_of_the_c_library() -> list[Entry]:
    """Return `libm` as entry points."""
    number = types.float64
    return [
        Entry(f"libm_{name}", function, number(*[number] * count))
        for name, (function, count) in libm.FUNCTIONS.items()
    ]


def main(folder: Path) -> None:
    """Write a file for each entry point and the list of their names."""
    lines = []
    for entry in [*entries(), *functions_of_the_c_library()]:
        name, text = text_of(entry)
        (folder / f"{entry.name}.ll").write_text(text)
        lines.append(f"{entry.name} {name}")
    (folder / "names.txt").write_text("\n".join(lines))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
