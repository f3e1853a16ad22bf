"""What a file is, told by its content and not by its name."""

from __future__ import annotations

import json
from pathlib import Path


def is_geff(path: Path) -> bool:
    """Whether a folder is a graph of tracks in the Graph Exchange File Format."""
    for name in ("zarr.json", ".zattrs"):
        try:
            content = json.loads((path / name).read_text("utf-8"))
        except (OSError, ValueError):
            continue
        attributes = content.get("attributes", content) if isinstance(content, dict) else {}
        if isinstance(attributes, dict) and "geff" in attributes:
            return True
    return False
