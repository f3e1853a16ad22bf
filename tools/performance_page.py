"""Write docs/performance.md and its pictures from the recorded benchmarks.

python tools/performance_page.py
"""

from __future__ import annotations

import json
import shutil
from collections import defaultdict
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / "benchmarks" / "results"
PICTURES = ROOT / "docs" / "images" / "performance"

HEAD = """# Performance

Every figure here comes from `cellcrawl bench`, which runs on any machine; `benchmarks/results`
holds the runs quoted. Machines differ and share their cores: compare figures of one run, trust
ratios more than seconds. Errors are the larger of the relative error of the length and the distance
of the centroid over the cell radius, against the adaptive solver at `rtol` 1e-9.

"""


def load(name: str) -> dict[str, Any]:
    """Return the recorded results of a benchmark."""
    content: dict[str, Any] = json.loads((RESULTS / f"{name}.json").read_text("utf-8"))
    return content


def table(names: list[str], rows: list[list[str]]) -> str:
    """Return a Markdown table."""
    lines = [names, ["---"] * len(names), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def targets() -> str:
    """Return the table of what was asked and what was measured."""
    content = load("targets")
    rows = [
        [t["what"], t["asked"], t["measured"], "yes" if t["met"] else "**no**"]
        for t in content["targets"]
    ]
    machine = ", ".join(f"{k} {v}" for k, v in content["machine"].items() if v is not None)
    head = "## Targets\n\n`cellcrawl bench targets`\n\n"
    return head + table(["what", "asked", "measured", "met"], rows) + f"\nMachine: {machine}.\n\n"


def work_precision() -> str:
    """Return the range of speed-ups at equal error over all cases."""
    times: dict[tuple[str, str], dict[str, list[float]]] = defaultdict(lambda: defaultdict(list))
    for ratio in load("work-precision")["ratios"]:
        law = "consistent" if "consistent" in ratio["case"] else "printed"
        for at_error, value in ratio["times"].items():
            if value is not None:
                times[ratio["solver"], law][at_error].append(value)
    errors = ["0.01", "0.001", "0.0001", "1e-05", "1e-06"]
    rows = [
        [solver, law, *(_range(found.get(error, [])) for error in errors)]
        for (solver, law), found in sorted(times.items())
    ]
    text = (
        "## Work against precision\n\n`cellcrawl bench work-precision`: five cells and two more "
        "diffusivities, both tension laws, t = 5 and 20. How many times longer than the adaptive "
        "solver another takes for the same error: least to most over the cases, and in how many "
        "cases it gets there. The general solvers use the adaptive solver's own compiled "
        "right-hand side on a fixed grid as fine as it finds necessary.\n\n"
    )
    names = ["solver", "law", *(f"error {error}" for error in errors)]
    shutil.copy(RESULTS / "work-precision.png", PICTURES)
    short = (
        "CVODE uses the same family of formulas; the difference is a Newton matrix that knows what "
        "is fast in the model, in compiled steps on a grid that follows the shape. At D = 0.01 "
        "and for longer times the instability magnifies errors beyond the tolerance.\n\n"
    )
    picture = "![Error against time for every solver](images/performance/work-precision.png)\n\n"
    return text + table(names, rows) + "\n" + short + picture


def scaling() -> str:
    """Return cost against nodes and against the length of the run."""
    content = load("scaling")
    streams = [
        [
            f"{s['t_end']:g}",
            f"{s['seconds']:.2f}",
            f"{s['peak_megabytes']:.0f}",
            f"{s['file_megabytes']:.0f}",
        ]
        for s in content["streams"]
    ]
    shutil.copy(RESULTS / "scaling.png", PICTURES)
    return (
        "## Cost against size\n\n`cellcrawl bench scaling`: a run written to disk, 256 nodes every "
        "0.1 time units. Time grows with the length of the run, memory does not.\n\n"
        + table(["t_end", "time (s)", "peak memory (MB)", "file (MB)"], streams)
        + "\n![Cost against nodes and length](images/performance/scaling.png)\n\n"
    )


def startup() -> str:
    """Return the start-up times."""
    rows = [[s["what"], f"{s['seconds']:.2f}"] for s in load("startup")["starts"]]
    return (
        "## Start-up\n\n`cellcrawl bench startup`, whole processes. Numba compiles on first use "
        "and keeps the result on disk.\n\n" + table(["what", "time (s)"], rows)
    )


def _range(values: list[float]) -> str:
    if not values:
        return "never"
    low, high = min(values), max(values)
    return f"{low:.1f}–{high:.1f} ({len(values)})" if len(values) > 1 else f"{low:.1f} (1)"


def main() -> None:
    """Write the page."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    page = HEAD + targets() + work_precision() + scaling() + startup()
    (ROOT / "docs" / "performance.md").write_text(page, "utf-8")


if __name__ == "__main__":
    main()
