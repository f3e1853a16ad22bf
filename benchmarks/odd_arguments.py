"""Calls of every public function, one odd value in place of one argument: no raw error is left.

    python benchmarks/odd_arguments.py --calls 20000

Counts what was refused in one line, and prints what ended in an error that is none of ours; exit
code 1 if anything did. The functions and values are those of tests/odd_arguments.py.
"""

from __future__ import annotations

import argparse
import faulthandler
import os
import sys
import tempfile
from pathlib import Path

import matplotlib as mpl
from matplotlib import pyplot as plt

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from tests.odd_arguments import odd_calls, public_calls

_BATCH = 500


def main() -> int:
    """Make the calls; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--calls", type=int, default=20000)
    parser.add_argument("--seed", type=int, default=0, help="of the first 500 calls")
    given = parser.parse_args()
    mpl.use("agg")
    raw, refused, slowest = {}, 0, (0.0, "")
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)  # odd names of files are relative
        calls = public_calls(Path(folder))
        for batch in range(-(-given.calls // _BATCH)):
            faulthandler.dump_traceback_later(300, exit=True)  # says which call hangs
            count = min(_BATCH, given.calls - batch * _BATCH)
            found = odd_calls(calls, given.seed + batch, count)
            raw.update(found.raw)
            refused += found.refused
            slowest = max(slowest, found.slowest)
            for where, error in found.raw.items():
                print(given.seed + batch, *where, error, flush=True)
            plt.close("all")
        os.chdir("/")
    print(
        f"{given.calls} calls of {len(calls)} kinds: {refused} refused in one line, "
        f"{len(raw)} raw errors; the slowest took {slowest[0]:.1f} s ({slowest[1]})"
    )
    return 1 if raw else 0


if __name__ == "__main__":
    raise SystemExit(main())
