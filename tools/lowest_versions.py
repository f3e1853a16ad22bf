"""Print the lowest versions that pyproject.toml allows, as constraints for pip.

``python tools/lowest_versions.py > lowest.txt && pip install -e ".[test]" -c lowest.txt``
"""

from __future__ import annotations

import re
import sys
import tomllib
from pathlib import Path
from typing import Any

_REQUIREMENT = re.compile(
    r"(?P<name>[\w-]+)(?:\[(?P<extras>.*)\])?\s*(?P<bounds>[^;]*)(?:;(?P<when>.*))?"
)
_PYTHON = re.compile(r"python_version\s*(?P<side>>=|<)\s*'(?P<version>[\d.]+)'")


def lowest_versions(
    project: dict[str, Any], python: tuple[int, int], extra: str = "test"
) -> dict[str, str]:
    """Return the lower bound of every dependency, and of those of an extra, on one Python.

    Raises
    ------
    SystemExit
        For a dependency without a lower bound: nothing would say what was tested.
    """
    lowest: dict[str, str] = {}
    waiting, extras = list(project["dependencies"]), [extra]
    while waiting or extras:
        if not waiting:
            waiting += project["optional-dependencies"][extras.pop()]
        requirement = waiting.pop()
        found = _REQUIREMENT.fullmatch(requirement.replace('"', "'"))
        if found is None:
            raise SystemExit(f"cannot read the requirement {requirement!r}")
        if found["name"] == project["name"]:
            extras += [name.strip() for name in found["extras"].split(",")]
            continue
        if not _holds(found["when"], python):
            continue
        bound = re.search(r">=\s*([\w.]+)", found["bounds"])
        if bound is None:
            raise SystemExit(f"{requirement!r} has no lower bound: give one that was tested")
        if lowest.setdefault(found["name"], bound[1]) != bound[1]:
            raise SystemExit(f"{found['name']} has two lower bounds on Python {python}")
    return lowest


def _holds(when: str | None, python: tuple[int, int]) -> bool:
    if when is None:
        return True
    found = _PYTHON.fullmatch(when.strip())
    if found is None:
        raise SystemExit(f"cannot read the marker {when!r}")
    version = tuple(int(part) for part in found["version"].split("."))
    return python >= version if found["side"] == ">=" else python < version


def main() -> None:
    """Print one constraint a line."""
    file = Path(__file__).parents[1] / "pyproject.toml"
    project = tomllib.loads(file.read_text("utf-8"))["project"]
    for name, version in lowest_versions(project, sys.version_info[:2]).items():
        print(f"{name}=={version}")


if __name__ == "__main__":
    main()
