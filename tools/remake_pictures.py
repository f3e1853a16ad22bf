"""Make every picture of the documentation and of the recorded benchmarks anew.

    python tools/remake_pictures.py                    all that is not done, step by step
    python tools/remake_pictures.py --only figures sweeps
    python tools/remake_pictures.py --list

A step that is done is not made again as long as code and recorded results are the same; a stopped
one goes on where it was, if what it runs does. Benchmarks are drawn from their recorded results:
measure those anew with `cellcrawl bench KIND --output benchmarks/results`.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

from cellcrawl.sweeps.identity import code_version

ROOT = Path(__file__).resolve().parent.parent
IMAGES = ROOT / "docs" / "images"
RESULTS = ROOT / "benchmarks" / "results"
_DOTS = "150"


class Step(NamedTuple):
    """Pictures that are made together."""

    name: str
    makes: tuple[str, ...]
    """Patterns of the pictures, from the root of the repository."""
    run: Callable[[Path], None]
    """Makes them; given the folder for runs and sweeps, one for each version of the solvers."""


def command(*words: str | Path) -> None:
    """Run Python with these arguments at the root of the repository."""
    subprocess.run([sys.executable, *map(str, words)], cwd=ROOT, check=True)


def cells(work: Path) -> None:
    """The nine named cells, and three of them at one scale."""
    command("examples/nine_cells.py", IMAGES)


def linear(work: Path) -> None:
    """Dispersion curves and the stability map."""
    command("examples/linear_theory.py", IMAGES / "linear")


def one_dimensional(work: Path) -> None:
    """The cell on a line."""
    command("examples/one_dimensional.py", IMAGES / "one_dimensional")


def temperature(work: Path) -> None:
    """A cell at seven temperatures, and warmed while it crawls."""
    command("examples/temperature.py", IMAGES / "temperature")


def laws(work: Path) -> None:
    """Cells under other laws and in other surroundings."""
    command("examples/laws.py", IMAGES / "laws")
    command("examples/laws_at_nine_cells.py", IMAGES / "laws", "docs/laws_nine_cells.md")


def branches(work: Path) -> None:
    """Gliding and turning cells, and their boundaries."""
    from cellcrawl import branches, plot

    pictures, chart, kept = IMAGES / "branches", work / "diagram", work / "branches"
    command("examples/branches.py", pictures)
    command("examples/boundaries_of_laws.py", pictures)
    copy(pictures / "boundaries-of-laws.json", RESULTS / "boundaries-of-laws.json")
    (pictures / "boundaries-of-laws.json").unlink()
    command("examples/diagram_with_curves.py", chart)
    copy(chart / "diagram.png", pictures / "diagram.png")
    copy(chart / "diagram.json", RESULTS / "diagram.json")
    for zeta_1 in ("560", "600"):
        asked = ("--turning", "--orbits", "24,34", "--zeta-1", zeta_1, "--overwrite")
        command("-m", "cellcrawl", "branches", *asked, "--output", kept / zeta_1)
        copy(kept / zeta_1 / "branches.png", pictures / f"one-parameter-{zeta_1}.png")
    exponents = branches.open_lyapunov_map(RESULTS / "lyapunov-map.nc")
    plot.lyapunov_map(exponents).figure.savefig(pictures / "lyapunov-map.png", dpi=200)


def model(work: Path) -> None:
    """What explains the model: forces, stick and slip, the loop, a front that forms."""
    command("tools/model_pictures.py")


def gallery(work: Path) -> None:
    """The scripts of the gallery, and the page that shows them."""
    command("tools/gallery_page.py")


def figures(work: Path) -> None:
    """The paper's figures."""
    folder = work / "reproduction"
    asked = ("figures", "--output", folder, "--dpi", _DOTS, "--again")  # runs are reused
    command("-m", "cellcrawl", "reproduce", *asked)
    for name in ("fig2", "fig3", "fig4", "fig5", "fig6", "fig7", "short-time"):
        copy(folder / name / f"{name}.png", IMAGES / "reproduce" / f"{name}.png")


def sweeps(work: Path) -> None:
    """The diagram of the paper's plane, and a refined one."""
    plane, refined = work / "phase_diagram", work / "refined"
    command("-m", "cellcrawl", "sweep", "examples/phase_diagram.toml", "--output", plane)
    command("examples/phase_diagram.py", refined)
    copy(plane / "diagram.png", IMAGES / "sweeps" / "diagram.png")
    copy(refined / "diagram.png", IMAGES / "sweeps" / "refined.png")


def modes(work: Path) -> None:
    """Tracks and headings of the named cells, and how often answers are right."""
    from cellcrawl.bench import confidence
    from cellcrawl.bench.modes import plot

    rows = [confidence.Reliability(**row) for row in recorded("confidence")["confidence"]]
    together = [row for row in rows if row.records == "all"]
    apart = [row for row in rows if row.records != "all"]
    drawn = {"modes": plot(), "confidence": confidence.plot(together, apart)}
    for name, figure in drawn.items():
        figure.savefig(RESULTS / f"{name}.png", dpi=160)
        copy(RESULTS / f"{name}.png", IMAGES / f"{name}.png")


def explorer(work: Path) -> None:
    """The page of the live cell at three widths."""
    command("tools/explorer_pictures.py")


def tracks(work: Path) -> None:
    """The sheet of the tutorial."""
    sheet = IMAGES / "trackmate-sheet.png"
    asked = ("--output", sheet, "--dpi", _DOTS)
    command("-m", "cellcrawl", "tracks", "examples/cells.xml", *asked)


def benchmarks(work: Path) -> None:
    """Work against precision, cost against size and very long runs, from the recorded results."""
    from cellcrawl.bench import scaling, work_precision

    try:
        rows = [work_precision.Row(**row) for row in recorded("work-precision")["rows"]]
    except TypeError:
        raise SystemExit(
            "the recorded work-precision is of an older form: measure it anew"
        ) from None
    drawn = {"work-precision": work_precision.plot(rows)}
    found = recorded("scaling")
    drawn["scaling"] = scaling.plot(
        [scaling.NodeCost(**row) for row in found["nodes"]],
        [scaling.Stream(**row) for row in found["streams"]],
    )
    for name, figure in drawn.items():
        figure.savefig(RESULTS / f"{name}.png", dpi=160)
        copy(RESULTS / f"{name}.png", IMAGES / "performance" / f"{name}.png")
    if (RESULTS / "invariants.json").exists():
        command("benchmarks/invariants.py", "--draw")
        copy(RESULTS / "invariants.png", IMAGES / "performance" / "invariants.png")


STEPS = (
    Step("explorer", ("docs/images/explore/*.png",), explorer),
    Step("linear", ("docs/images/linear/*.png",), linear),
    Step(
        "benchmarks", ("benchmarks/results/[isw]*.png", "docs/images/performance/*.png"), benchmarks
    ),
    Step("modes", ("benchmarks/results/[mc]*.png", "docs/images/[mc]*.png"), modes),
    Step("tracks", ("docs/images/trackmate*.png",), tracks),
    Step("cells", ("docs/images/three-cells.png", "docs/images/gallery/*.png"), cells),
    Step("model", ("docs/images/model/*.png",), model),
    Step("gallery", ("docs/images/scripts/*.png",), gallery),
    Step("temperature", ("docs/images/temperature/*.png",), temperature),
    Step("laws", ("docs/images/laws/*.png",), laws),
    Step("branches", ("docs/images/branches/*.png",), branches),
    Step("one-dimensional", ("docs/images/one_dimensional/*.png",), one_dimensional),
    Step("figures", ("docs/images/reproduce/*.png",), figures),
    Step("sweeps", ("docs/images/sweeps/*.png",), sweeps),
)


def copy(source: Path, target: Path) -> None:
    """Copy a picture to where the documentation has it."""
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source, target)


def recorded(name: str) -> dict[str, list[dict[str, Any]]]:
    """Return the recorded results of a benchmark."""
    content: dict[str, list[dict[str, Any]]] = json.loads(
        (RESULTS / f"{name}.json").read_text("utf-8")
    )
    return content


def pictures() -> set[Path]:
    """Return every picture of the documentation and the benchmarks."""
    return {*IMAGES.rglob("*.png"), *RESULTS.glob("*.png")}


def made_by(step: Step) -> set[Path]:
    """Return the pictures there are that a step makes."""
    return {path for pattern in step.makes for path in ROOT.glob(pattern)}


def state() -> str:
    """Return a hash of all that pictures depend on: code, examples, recorded results."""
    digest = hashlib.sha256()
    for folder, pattern in (("src", "*.py"), ("examples", "*"), ("benchmarks/results", "*.json")):
        for path in sorted((ROOT / folder).rglob(pattern)):
            if path.is_file() and "__pycache__" not in path.parts:
                digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def main() -> int:
    """Make what is asked for; return the exit code."""
    known = [step.name for step in STEPS]
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", nargs="+", choices=known, metavar="STEP", help=", ".join(known))
    parser.add_argument("--again", action="store_true", help="Make steps that are done, too.")
    parser.add_argument("--list", action="store_true", help="Say what the steps make, and stop.")
    parser.add_argument("--work", type=Path, default=ROOT / "build" / "pictures")
    asked = parser.parse_args()
    if asked.list:
        for step in STEPS:
            print(f"{step.name:16} {', '.join(step.makes)}")
        return 0
    asked.work.mkdir(parents=True, exist_ok=True)
    record = asked.work / "done.json"
    done = json.loads(record.read_text("utf-8")) if record.exists() else {}
    now, kept = state(), asked.work / code_version().replace("+", "-")
    for step in STEPS:
        if asked.only and step.name not in asked.only:
            continue
        if done.get(step.name) == now and not asked.again:
            print(f"{step.name}: done before")
            continue
        began = time.monotonic()
        step.run(kept)
        done[step.name] = now
        record.write_text(json.dumps(done, indent=2) + "\n", "utf-8")
        print(f"{step.name}: {len(made_by(step))} pictures, {time.monotonic() - began:.0f} s")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
