"""Build the wheel and the source archive, and use both as somebody else would.

    python tools/check_release.py [--python PYTHON ...] [--lowest]

Each step says what it found; the first that does not hold ends it with exit code 1. Needs what the
README needs, with the package index. A user without a writable home is tried where this runs as
root and another user may run the interpreter.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import tomllib
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
NOT_INSTALLED = {
    "zarr": "import cellcrawl as cc; cc.simulate(t_end=0.01, output='a.zarr')",
    "units": "import cellcrawl as cc; cc.PhysicalParameters().quantity('radius')",
    "microscopy": "import cellcrawl as cc; open('a.tif', 'wb').write(b'II*\\0' + bytes(60)); "
    "cc.read_outlines('a.tif')",
    "infer": "from cellcrawl.infer.neural import _torch; _torch()",
    "dask": "import cellcrawl as cc; "
    "cc.sweep({'seed': [1]}, 'swept', t_end=0.01, executor='tcp://a:1')",
}
FIRST_RUN = ("simulate", "--t-end", "1", "--no-movie", "--output")


class Wrong(Exception):
    """Something that must hold before a release and does not."""


def main() -> None:
    """Run all checks."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--python", nargs="+", default=[sys.executable], help="interpreters")
    parser.add_argument("--lowest", action="store_true", help="with the lowest packages too")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="a release ") as folder:
        place = Path(folder)
        place.chmod(0o755)
        try:
            check_versions()
            wheel, archive = build_twice(place)
            check_contents(wheel, archive)
            for python in asked.python:
                for packages in ("newest", "lowest") if asked.lowest else ("newest",):
                    use(place, python, packages, wheel, archive)
        except Wrong as wrong:
            raise SystemExit(f"not ready: {wrong}") from None
    print("ready")


def check_versions() -> None:
    """The version is told alike in the project, the changelog and the citation."""
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
    newest = re.search(r"^## (\S+)", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)
    cited = re.search(r"^version: (\S+)", (ROOT / "CITATION.cff").read_text(), re.MULTILINE)
    told = {"CHANGELOG.md": newest and newest[1], "CITATION.cff": cited and cited[1]}
    if ".dev" in version:
        print(f"version {version}: not a release; CHANGELOG and CITATION are not held to it")
        return
    for name, found in told.items():
        if found != version:
            raise Wrong(f"{name} tells version {found}, the project {version}")
    print(f"version {version} in the project, CHANGELOG and CITATION")


def build_twice(place: Path) -> tuple[Path, Path]:
    """Two builds of a clean clone have the same bytes."""
    run("git", "clone", "--quiet", ROOT, place / "clone")
    run(sys.executable, "-m", "venv", place / "builder")
    builder = scripts(place / "builder") / "python"
    run(builder, "-m", "pip", "install", "--quiet", "build")
    made: list[dict[str, str]] = []
    for number in ("1", "2"):
        run(builder, "-m", "build", "-o", place / number, place / "clone", quiet=True)
        files = sorted((place / number).iterdir())
        made.append({f.name: hashlib.sha256(f.read_bytes()).hexdigest() for f in files})
    if made[0] != made[1]:
        raise Wrong(f"two builds differ: {made}")
    for name, digest in made[0].items():
        print(f"{digest}  {name}, {(place / '1' / name).stat().st_size / 1e6:.1f} MB, twice")
    archive, wheel = sorted((place / "1").iterdir(), key=lambda file: file.suffix == ".whl")
    return wheel, archive


def check_contents(wheel: Path, archive: Path) -> None:
    """The wheel holds every file of the package; the archive what its tests need, too."""
    listed = subprocess.run(
        ["git", "ls-files", "src/cellcrawl"], cwd=ROOT, check=True, capture_output=True, text=True
    ).stdout.splitlines()
    with zipfile.ZipFile(wheel) as opened:
        inside = set(opened.namelist())
    missing = [name for name in listed if name.removeprefix("src/") not in inside]
    strange = [
        name for name in inside if not name.startswith("cellcrawl-") and f"src/{name}" not in listed
    ]
    if missing or strange:
        raise Wrong(f"the wheel lacks {missing[:5]} and has {strange[:5]}")
    if not any(name.endswith("licenses/LICENSE") for name in inside):
        raise Wrong("the wheel has no licence")
    with tarfile.open(archive) as tar:
        names = {name.partition("/")[2] for name in tar.getnames()}
    for name in ("tests/conftest.py", "README.md", "CHANGELOG.md", "LICENSE", "pyproject.toml"):
        if name not in names:
            raise Wrong(f"the source archive lacks {name}")
    print(f"wheel: {len(listed)} files of the package and its licence; archive: with its tests")


def use(place: Path, python: str, packages: str, wheel: Path, archive: Path) -> None:
    """Install the wheel alone, run it, and run the archive's tests against it."""
    told = subprocess.run([python, "--version"], check=True, capture_output=True, text=True)
    print(f"{told.stdout.strip()}, {packages} packages")
    home = place / f"{Path(python).name} {packages}"
    shutil.rmtree(home, ignore_errors=True)
    run(python, "-m", "venv", home)
    pip = (scripts(home) / "python", "-m", "pip", "install", "--quiet")
    limits = place / "constraints.txt"
    limits.write_text(
        run(python, ROOT / "tools" / "lowest_versions.py") if packages == "lowest" else ""
    )
    run(*pip, "-c", limits, wheel)
    for user in (None, *stranger(scripts(home) / "python")):
        work = Path(tempfile.mkdtemp(dir=place))
        work.chmod(0o777)
        out = run(scripts(home) / "cellcrawl", *FIRST_RUN, work / "run", folder=work, user=user)
        if not (work / "run" / "run.nc").exists():
            raise Wrong(f"`cellcrawl simulate` left no run: {out}")
        whom = "a user without a home" if user else "its owner"
        print(f"  the wheel alone runs for {whom}, from a path with a space")
    for extra, lines in NOT_INSTALLED.items():
        answer = subprocess.run(
            [scripts(home) / "python", "-c", lines],
            cwd=place, capture_output=True, text=True, check=False,
        )  # fmt: skip
        last = answer.stderr.strip().splitlines()[-1:]
        if answer.returncode == 0 or f"cellcrawl[{extra}]" not in "".join(last):
            raise Wrong(f"without the extra {extra} it says {last}")
    print(f"  without {', '.join(NOT_INSTALLED)} it says what to install")
    with tarfile.open(archive) as tar:
        tar.extractall(home, filter="data")
    (source,) = home.glob("cellcrawl-*/")
    run(*pip, "-c", limits, f"{wheel}[test]")
    shutil.rmtree(source / "src")  # the wheel is tried, not the source
    part = [source / "tests" / name for name in ("parameters", "data", "linear")]
    run(scripts(home) / "python", "-m", "pytest", "-q", *part, folder=source)
    print("  the archive's tests of parameters, data and theory pass with the wheel")


def stranger(python: Path) -> list[str]:
    """Return a user who has no home and may run this interpreter, if there is one."""
    try:
        subprocess.run([python, "-c", ""], user="nobody", check=True, capture_output=True)
    except (OSError, PermissionError, subprocess.CalledProcessError, ValueError):
        print("  not tried as a user without a home: there is none, or none may run this Python")
        return []
    return ["nobody"]


def scripts(environment: Path) -> Path:
    """Return the folder of a virtual environment's commands."""
    return environment / ("Scripts" if os.name == "nt" else "bin")


def run(
    *words: str | Path, folder: Path | None = None, user: str | None = None, quiet: bool = True
) -> str:
    """Run a command and return what it printed, or say how it failed."""
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
    environment.pop("PYTHONPATH", None)
    if user is not None:
        environment |= {"HOME": "/nonexistent", "USER": user}
    result = subprocess.run(
        [str(word) for word in words],
        cwd=folder, env=environment, user=user, capture_output=quiet, text=True, check=False,
    )  # fmt: skip
    if result.returncode != 0:
        last = "\n".join((result.stdout + result.stderr).strip().splitlines()[-15:])
        raise Wrong(
            f"{' '.join(str(word) for word in words)} ends with {result.returncode}\n{last}"
        )
    return result.stdout


if __name__ == "__main__":
    main()
