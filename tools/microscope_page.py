"""Put the recorded results of `cellcrawl bench microscope` below their marks in the pages.

python tools/microscope_page.py
"""

from __future__ import annotations

import re
from typing import Any

from performance_page import ROOT, load, table


def cells(rows: list[dict[str, Any]]) -> str:
    """Return what the nine cells are, and what is seen of them."""
    names = ["point", "mode", "seen", "speed", "seen (95 %)", "circularity", "seen", "period"]
    lines = [
        [
            row["point"],
            row["mode"],
            row["mode_seen"],
            f"{row['speed']:.3f}",
            f"{row['speed_seen']:.3f} ({row['speed_low']:.3f} to {row['speed_high']:.3f})",
            f"{row['circularity']:.3f}",
            f"{row['circularity_seen']:.3f}",
            _number(row["period"]),
            _number(row["period_seen"]),
        ]
        for row in rows
    ]
    return table([*names, "seen"], lines)


def shapes(rows: list[dict[str, Any]]) -> str:
    """Return the errors of shapes on a grid of pixels."""
    names = ["pixels across", "aspect ratio", "area", "area within 0.5", "length", "curvature"]
    lines = [
        [
            str(row["size"]),
            f"{row['aspect']:g}",
            f"{row['area']:.1f}",
            f"{row['near']:.0%}",
            f"{row['length']:.1f}",
            f"{row['curvature']:.0f}",
        ]
        for row in rows
    ]
    return table(names, lines)


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.3g}"


def main() -> None:
    """Write the tables."""
    results = load("microscope")
    for name, mark, text in (
        ("microscopy", "cells", cells(results["cells"])),
        ("measuring", "shapes", shapes(results["shapes"])),
    ):
        file = ROOT / "docs" / f"{name}.md"
        page = file.read_text("utf-8")
        if f"<!-- {mark} -->" not in page:
            raise SystemExit(f"{file} has no mark {mark}")
        page = re.sub(
            rf"<!-- {mark} -->\n(\n\|.*?\n\n)?", f"<!-- {mark} -->\n\n{text}\n", page, flags=re.S
        )
        file.write_text(re.sub(r"\n{3,}", "\n\n", page), "utf-8")


if __name__ == "__main__":
    main()
