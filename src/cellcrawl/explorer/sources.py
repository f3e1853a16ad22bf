"""Whether the shipped module is that of the kernels as they are: a hash of their code."""

from __future__ import annotations

import hashlib
import io
import tokenize
from pathlib import Path
from typing import Final

FILE: Final = "solver.sha256"
_PLACES: Final = (
    "numerics/elementary.py",
    "curve/crossing.py",
    "numerics/fourier.py",
    "curve/orientation.py",
    "curve/sines.py",
    "explorer/emit.py",
    "explorer/entries.py",
    "explorer/libm.py",
    "explorer/module.py",
    "explorer/object_file.py",
    "explorer/runtime.py",
    "starts/small_waves.py",
    "laws/addresses.py",
    "laws/balanced_edge.py",
    "laws/catch_slip.py",
    "laws/compiled.py",
    "laws/expressions.py",
    "laws/functions.py",
    "laws/law.py",
    "laws/load.py",
    "laws/myosin.py",
    "laws/stiffness.py",
    "numerics/exponential.py",
    "laws/force_balance.py",
    "numerics/cyclic.py",
    "surroundings/base.py",
    "surroundings/discs.py",
    "surroundings/lookup.py",
    "surroundings/motion.py",
    "surroundings/place.py",
)
_ADAPTIVE: Final = "solvers/adaptive"
_NOT_KERNELS: Final = {
    *("__init__.py", "ahead.py", "follow.py", "linked.py", "solver.py", "state.py"),
}
_SKIPPED: Final = {
    *("COMMENT", "NL", "NEWLINE", "INDENT", "DEDENT", "ENCODING", "ENDMARKER", "STRING"),
    *("FSTRING_START", "FSTRING_END"),
}


def digest() -> str:
    """Return a hash of the code that the module is built from, comments and texts left out."""
    root = Path(__file__).parent.parent
    found = [root / place for place in _PLACES]
    found += [
        file for file in sorted((root / _ADAPTIVE).glob("*.py")) if file.name not in _NOT_KERNELS
    ]
    whole = hashlib.sha256()
    for file in found:
        whole.update(file.name.encode())
        tokens = tokenize.generate_tokens(io.StringIO(file.read_text("utf-8")).readline)
        within = 0  # formatted texts, which Python 3.11 takes for one token
        for token in tokens:
            kind = tokenize.tok_name[token.type]
            within += (kind == "FSTRING_START") - (kind == "FSTRING_END")
            if within == 0 and kind not in _SKIPPED:
                whole.update(token.string.encode() + b" ")
    return whole.hexdigest()
