"""The machine and the versions a benchmark ran on, and its results as a file."""

from __future__ import annotations

import datetime
import json
import math
import os
import platform
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, Final

_PACKAGES: Final = ("cellcrawl", "numpy", "numba", "scipy", "scikit-sundae", "xarray")


def record() -> dict[str, Any]:
    """Return what a figure must be read with: processor, system, versions, day."""
    return {
        "date": datetime.date.today().isoformat(),
        "processor": _processor(),
        "cores": os.cpu_count(),
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        **{name: _version(name) for name in _PACKAGES},
    }


def describe(machine: dict[str, Any]) -> str:
    """Return the record as one line."""
    return ", ".join(f"{name} {value}" for name, value in machine.items() if value is not None)


def write(path: Path, results: dict[str, Any]) -> None:
    """Write results with the machine's record as JSON."""
    path.parent.mkdir(parents=True, exist_ok=True)
    content = without_nan({"machine": record(), **results})
    path.write_text(json.dumps(content, indent=1, allow_nan=False) + "\n", "utf-8")


def without_nan(value: Any) -> Any:
    """Return ``value`` with null for what JSON has no word for."""
    if isinstance(value, dict):
        return {str(name): without_nan(item) for name, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [without_nan(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _version(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text("utf-8").splitlines()
    except OSError:
        return platform.processor() or "unknown"
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else "unknown"
