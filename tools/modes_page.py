"""Put the recorded results of `cellcrawl bench modes` into docs/modes.md, below its marks.

python tools/modes_page.py
"""

from __future__ import annotations

import re
import shutil
from typing import Any

from performance_page import RESULTS, ROOT, load, table

PAGE = ROOT / "docs" / "modes.md"


def points(rows: list[dict[str, Any]]) -> str:
    """Return each point's majority as it is and by its form alone."""
    lines = []
    for point in dict.fromkeys(row["point"] for row in rows):
        whole, form = (_find(rows, point, name) for name in ("as it is", "track alone"))
        lines.append([point, whole["paper"], whole["found"], form["found"]])
    return table(["point", "the paper", "with the cell's size", "form alone"], lines)


def spin(rows: list[dict[str, Any]]) -> str:
    """Return what the solver and the time make of the point that needs a word."""
    lines = [
        [row["condition"], row["found"]]
        for row in rows
        if row["condition"].endswith(", track alone")
    ]
    return table(["(44, 560)", "named"], lines)


def conditions(rows: list[dict[str, Any]]) -> str:
    """Return how many runs agree with the paper, point by point and condition by condition."""
    names = [
        name
        for name in dict.fromkeys(row["condition"] for row in rows)
        if not name.endswith("track alone")
    ]
    lines = []
    for point in dict.fromkeys(row["point"] for row in rows):
        found = [_find(rows, point, name) for name in names]
        lines.append([point, found[0]["paper"], *(_agreeing(row) for row in found)])
    return table(["point", "the paper", *names], lines)


def kinds(rows: list[dict[str, Any]]) -> str:
    """Return the confusion table of synthetic tracks."""
    lines = [[row["kind"], row["mode"], row["found"], str(row["wrong_and_sure"])] for row in rows]
    tracks, right = (sum(row[name] for row in rows) for name in ("tracks", "right"))
    sure = sum(row["wrong_and_sure"] for row in rows)
    lines.append(["all", "", f"{right} of {tracks} right ({right / tracks:.1%})", str(sure)])
    return table(["kind", "is", "named", "wrong and sure"], lines)


def _find(rows: list[dict[str, Any]], point: str, condition: str) -> dict[str, Any]:
    return next(row for row in rows if (row["point"], row["condition"]) == (point, condition))


def _agreeing(row: dict[str, Any]) -> str:
    counts = {mode: int(n) for n, mode in (part.split() for part in row["found"].split(", "))}
    return f"{counts.get(row['paper'], 0)} of {sum(counts.values())}"


def main() -> None:
    """Write the tables and copy the picture."""
    results = load("modes")
    made = {
        "points": points(results["points"]),
        "spin": spin(results["points"]),
        "conditions": conditions(results["points"]),
        "kinds": kinds(results["kinds"]),
    }
    page = PAGE.read_text("utf-8")
    for mark, text in made.items():
        page = re.sub(
            rf"<!-- {mark} -->\n(\n\|.*?\n\n)?", f"<!-- {mark} -->\n\n{text}\n", page, flags=re.S
        )
    PAGE.write_text(re.sub(r"\n{3,}", "\n\n", page), "utf-8")
    shutil.copy(RESULTS / "modes.png", ROOT / "docs" / "images" / "modes.png")


if __name__ == "__main__":
    main()
