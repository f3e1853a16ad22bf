"""Measure what a fit finds of fresh cells: recovery, coverage, calibration, alarms, a drug.

``python benchmarks/infer.py BANK [PART ...]`` adds the parts named, or all, to
``benchmarks/results/infer.json``: ``cameras``, ``alarms``, ``drug``, ``methods`` (needs sbi),
``again`` (ABC trained twice), ``choice`` (with ``--other BANK``, of another law), ``microscope``
(how well each parameter is told by frame, pixel and length). Fresh cells are new runs of the
bank's prior; pixels are those of `cellcrawl.observe`.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path
from typing import Any

from cellcrawl.bench import machine

sys.path.insert(0, str(Path(__file__).parent))
from infer_cells import TIME, Camera
from infer_parts import PARTS, Measuring

RESULTS = Path(__file__).parent / "results" / "infer.json"


def main() -> None:
    """Measure and write."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bank", type=Path)
    parser.add_argument("parts", nargs="*", metavar="PART")
    parser.add_argument("--cells", type=int, default=300)
    parser.add_argument("--others", type=int, default=60)
    parser.add_argument("--points", type=int, default=10)
    parser.add_argument("--output", type=Path, default=RESULTS)
    parser.add_argument("--other", type=Path, action="append", default=[])
    asked = parser.parse_args()
    at = Measuring(asked)
    for part in asked.parts or PARTS:
        began = time.perf_counter()
        found = PARTS[part](at)
        told = {
            "date": machine.record()["date"],
            "bank": at.bank.digest,
            "runs": len(at.bank),
            "seconds": round(time.perf_counter() - began, 1),
        }
        write(asked.output, at.bank, part, {**told, "found": found})


def write(path: Path, bank: Any, part: str, found: dict[str, Any]) -> None:
    """Put a part into the record, and take out the parts if they are of another kind of bank.

    A bank made anew on another processor differs in the last bits of its runs, and in its hash:
    each part has that of its own.
    """
    old = json.loads(path.read_text("utf-8")) if path.exists() else {}
    told = {**bank.header, "outcomes": dict(Counter(bank.outcomes.tolist()))}
    same = _kind(old.get("bank", {})) == _kind(told)
    result = {
        "machine": machine.record(),
        "bank": old["bank"] if same else told,
        "film": {"length": Camera().length, "time_unit": TIME},
        **{name: value for name, value in old.items() if same and name in PARTS},
        part: found,
    }
    with tempfile.NamedTemporaryFile("w", dir=path.parent, delete=False) as file:
        json.dump(result, file, indent=1)
        file.write("\n")
    Path(file.name).replace(path)


def _kind(told: dict[str, Any]) -> dict[str, Any]:
    """Return what decides the runs of a bank, of what is told of it."""
    return {name: value for name, value in told.items() if name not in ("digest", "outcomes")}


if __name__ == "__main__":
    main()
