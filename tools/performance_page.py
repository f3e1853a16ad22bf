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
of the centroid over the cell radius, against the adaptive solver at `rtol` 1e-9; over a run to
t = 100 the largest at t = 50, 55, ..., 100, for at a single time a run can be lucky.

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


def long_runs() -> str:
    """Return the targets of long runs, and what becomes of area, length and period."""
    if not recorded("long"):
        return ""
    rows = [
        [t["what"], t["asked"], t["measured"], "yes" if t["met"] else "**no**"]
        for t in load("long")["targets"]
    ]
    text = (
        "## Long runs\n\n`cellcrawl bench long`. Errors are against "
        "`benchmarks/results/references.json`, which has beside each cell what CVODE makes of it; "
        "states and periods against an independent continuation code.\n\n"
        + table(["what", "asked", "measured", "met"], rows)
    )
    if recorded("invariants"):
        shutil.copy(RESULTS / "invariants.png", PICTURES)
        solvers = load("invariants")["solvers"]
        ended = ", ".join(
            f"`{name}` to t = {run['reached']:g} ({run['status']}, {run['seconds']:.0f} s)"
            for name, run in solvers.items()
        )
        text += (
            f"\nA zigzagging cell, (26, 600), for long (`benchmarks/invariants.py`): {ended}. "
            "None of them drifts. `paper` and `spline` on coarse grids, or they would take hours: "
            "their periods are those of their grids and steps; dashed, the exact one.\n\n"
            "![Area against the tension law, mean length and period of the tension over a long run]"
            "(images/performance/invariants.png)\n"
        )
    return text + "\n"


def two_versions() -> str:
    """Return times and errors of an older version beside this one."""
    if not recorded("old-and-new"):
        return ""
    content = load("old-and-new")
    times = [
        [row["what"], f"{row['old_ms']:.0f}", f"{row['new_ms']:.0f}"]
        + [f"{row[ratio]:.2f}" for ratio in ("ratio_of_medians", "ratio_of_minima")]
        for row in content["times"]
    ]
    missed = [
        [row["what"], f"{row['rtol']:g}", *(_missed(row[which]) for which in ("old", "new"))]
        for row in content["errors"]
    ]
    law = [
        [row["what"], *(f"{row[k]['off_law']:.1e}, {row[k]['status']}" for k in ("old", "new"))]
        for row in content["law"]
    ]
    diagram = ""
    if "diagram" in content:
        old, new = (
            min(pair) for pair in zip(*content["diagram"]["old_and_new_seconds"], strict=True)
        )
        diagram = (
            f"\nThe whole of `{content['diagram']['grid']}`, from a cold shell to the picture, on "
            f"all cores: {old:.0f} s before, {new:.0f} s now.\n"
        )
    return (
        f"## Before and now\n\n`benchmarks/old_and_new.py`: version {content['old']} beside "
        f"{content['new']}, in turns in one run, t = 0 to 100 at rtol 1e-4.\n\n"
        + table(["cell", "before (ms)", "now (ms)", "ratio of medians", "of minima"], times)
        + diagram
        + "\nLargest errors at t = 50, 55, ..., 100, of length / of the centroid.\n\n"
        + table(["cell", "rtol", "before", "now"], missed)
        + f"\nArea of the shape off the tension law by t = {content['law_until']:g} at rtol 1e-4, "
        "and how the run ended.\n\n" + table(["cell", "before", "now"], law) + "\n"
    )


def _missed(run: dict[str, Any]) -> str:
    found = run["errors"]
    return "ended before" if found is None else f"{found['length']:.1e} / {found['centroid']:.1e}"


def recorded(name: str) -> bool:
    """Whether a benchmark has been recorded."""
    return (RESULTS / f"{name}.json").exists()


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
        f"diffusivities, both tension laws, t = {_ends('work-precision')}. How many times longer "
        "than the adaptive solver another takes for the same error: least to most over the cases, "
        "and in how many cases it gets there. Each solver has ten seconds for a case; what would "
        "take longer, as nearly all of the paper's runs to t = 100, is left out. The general "
        "solvers have a compiled right-hand side of tenth order on fixed, equally spaced nodes; of "
        "several grids the best counts.\n\n"
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


def _ends(name: str) -> str:
    """Return the times to which the recorded runs went, in words."""
    *early, last = sorted({ratio["t_end"] for ratio in load(name)["ratios"]})
    return f"{', '.join(f'{t:g}' for t in early)} and {last:g}"


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


def storage() -> str:
    """Return what a stored run costs."""
    if not recorded("storage"):
        return ""
    rows = [
        [f"`{s['file']}`", s["how"], f"{s['megabytes']:.1f}"]
        + [f"{s[name]:.2f}" for name in ("write_s", "read_s", "compute_s")]
        for s in load("storage")["stored"]
    ]
    return (
        "## Stored runs\n\n`cellcrawl bench storage`: the run of (26, 600) to t = 100, 256 nodes "
        "every 0.1 time units, best of five.\n\n"
        + table(["file", "how", "MB", "write (s)", "read (s)", "compute (s)"], rows)
        + "\n"
    )


def startup() -> str:
    """Return the start-up times."""
    rows = [[s["what"], f"{s['seconds']:.2f}"] for s in load("startup")["starts"]]
    return (
        "## Start-up\n\n`cellcrawl bench startup`, whole processes. Numba compiles on first use "
        "and keeps the result on disk.\n\n" + table(["what", "time (s)"], rows)
    )


def laws() -> str:
    """Return what other laws and surroundings cost, and how long a new law compiles."""
    content = load("laws")
    rows = [
        [c["case"], f"{c['milliseconds']:.0f}", f"{c['ratio']:.2f}", f"{c['steps']:,}"]
        for c in content["cases"]
    ]
    starts = [[what, f"{seconds:.1f}"] for what, seconds in content["compile"].items()]
    return (
        "\n## Laws and surroundings\n\n`python benchmarks/laws.py --compile`: the cell (26, 600) "
        f"to t = {content['t_end']:g}, saved every 0.1, in turns. What takes more steps is another "
        "motion: swept myosin drives the cell faster, and on stripes it lies stretched between "
        "two, with sharp ends.\n\n"
        + table(["law or surroundings", "time (ms)", "over the paper's law", "steps"], rows)
        + "\nA whole start to t = 1, of a law that is new to the machine:\n\n"
        + table(["what", "time (s)"], starts)
    )


def _range(values: list[float]) -> str:
    if not values:
        return "never"
    low, high = min(values), max(values)
    return f"{low:.1f}–{high:.1f} ({len(values)})" if len(values) > 1 else f"{low:.1f} (1)"


def main() -> None:
    """Write the page."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    parts = (
        HEAD,
        targets(),
        long_runs(),
        two_versions(),
        work_precision(),
        scaling(),
        storage(),
        startup(),
        laws(),
    )
    (ROOT / "docs" / "performance.md").write_text("".join(parts), "utf-8")


if __name__ == "__main__":
    main()
