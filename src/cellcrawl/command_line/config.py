"""Config files of `cellcrawl simulate`."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

from cellcrawl.parameters import Schedule
from cellcrawl.parameters.named import read_toml
from cellcrawl.simulation.start_tables import start_from_table
from cellcrawl.starts import Start
from cellcrawl.validation import known_names, table

_TABLES = ("parameters", "schedule", "start", "run")
_RUN = ("t_end", "save_every", "solver", "nodes", "laws", "surroundings", "rtol", "dt")


class Configuration(NamedTuple):
    """What a config file says."""

    parameters: dict[str, Any]
    run: dict[str, Any]
    schedule: Schedule | None
    start: Start | None


def read_configuration(path: Path) -> Configuration:
    """Read a config file; raises `InputError` for anything it should not hold."""
    content = read_toml(path)
    known_names(str(path), content, _TABLES)
    tables = {name: dict(table(f"[{name}]", content.get(name, {}))) for name in _TABLES}
    known_names("[run]", tables["run"], _RUN)
    schedule = Schedule(tables["schedule"]) if "schedule" in content else None
    start = start_from_table(tables["start"]) if "start" in content else None
    return Configuration(tables["parameters"], tables["run"], schedule, start)
