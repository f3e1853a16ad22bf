"""Walk the README and the three start pages as their readers would, and say how long each takes.

    python tools/first_steps.py [--python PYTHON] [PAGE ...]

README is a clean clone and its first command, until the first picture. A start page is walked in a
new environment with a wheel built from this checkout, in a folder with a space in its name: its
commands one after another, then its lines of Python in one session; what the page promises must be
there at the end. The clock counts what else the machine does: the processor's seconds are told too.
"""

from __future__ import annotations

import argparse
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from tests.test_pages import LEFT, blocks, commands  # noqa: E402

PAGES = ("start-modeller", "start-experimenter", "start-teacher")


def main() -> None:
    """Walk what was asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("pages", nargs="*", default=["README", *PAGES], metavar="PAGE")
    parser.add_argument("--python", default=sys.executable, help="the interpreter of the reader")
    asked = parser.parse_args()
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # readers keep what Python compiled
    with tempfile.TemporaryDirectory(prefix="a reader ") as folder:
        place = Path(folder)
        (place / "bin").mkdir()
        python = place / "bin" / "python3"  # a page says python3
        python.write_text(f'#!/bin/sh\nexec "{asked.python}" "$@"\n')
        python.chmod(0o755)
        run("git", "clone", "--quiet", ROOT, place / "clone")
        print(
            f"{'page':20}{'install':>16}{'the rest':>16}{'together':>10}   (seconds; processor's)"
        )
        for page in asked.pages:
            steps = readme(place) if page == "README" else walked(place, page)
            (wall, cpu), (wall_then, cpu_then) = steps
            print(
                f"{page:20}{wall:8.1f} ({cpu:4.0f}) {wall_then:8.1f} ({cpu_then:4.0f}) "
                f"{wall + wall_then:9.1f}",
                flush=True,
            )


def readme(place: Path) -> list[tuple[float, float]]:
    """Run the README's first command in the clone; the second part ends with the first picture."""
    command = re.findall(r"^python3 -m venv .*simulate$", (ROOT / "README.md").read_text(), re.M)[0]
    install, _, first_run = command.rpartition(" && ")
    here = place / "clone"
    began = time.time()
    steps = [timed(place, here, install), timed(place, here, first_run)]
    picture = (here / "cellcrawl-run" / "summary.png").stat().st_mtime
    print(f"{'':20}the first picture is there after {picture - began:.1f} s, then the movie")
    return steps


def walked(place: Path, page: str) -> list[tuple[float, float]]:
    """Walk a start page; return the times of installing and of the rest."""
    here = place / page
    here.mkdir()
    shutil.copy(ROOT / "examples" / "cells.xml", here)  # the page's download
    if not list(place.glob("*.whl")):
        pip = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "-w", place]
        run(*pip, place / "clone")
    (wheel,) = place.glob("*.whl")
    found = blocks(ROOT / "docs" / f"{page}.md")
    lines = [line for kind, text in found if kind == "console" for line, _ in commands(text)]
    install = [line for line in lines if not line.startswith("cellcrawl ")]
    rest = [line for line in lines if line.startswith("cellcrawl ")]
    (here / "page.py").write_text("\n".join(text for kind, text in found if kind == "python"))
    install = [re.sub(r'install "?\.(\[\w+\])?"?', rf'install -q "{wheel}\1"', i) for i in install]
    enter = next(line for line in install if "activate" in line)
    steps = [timed(place, here, "\n".join(install))]
    steps.append(timed(place, here, "\n".join([enter, *rest, "python page.py"])))
    for name in LEFT[page]:
        assert (here / name).stat().st_size > 0, f"{page}: {name} is not there"
    return steps


def timed(place: Path, folder: Path, lines: str) -> tuple[float, float]:
    """Run lines of the shell; return the seconds on the clock and of the processor."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    began = time.perf_counter()
    run("bash", "-euc", f'PATH="{place / "bin"}:$PATH"\n{lines}', folder=folder)
    wall = time.perf_counter() - began
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def run(*words: str | Path, folder: Path | None = None) -> None:
    """Run a command, and show what it said if it fails."""
    result = subprocess.run(
        [str(word) for word in words], cwd=folder, capture_output=True, text=True, check=False
    )
    if result.returncode != 0:
        raise SystemExit(f"{words} ends with {result.returncode}\n{result.stdout}{result.stderr}")


if __name__ == "__main__":
    main()
