"""Write the tables of docs/fit.md from benchmarks/results/infer.json, between its two marks.

``python tools/infer_page.py``
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "fit.md"
RESULTS = ROOT / "benchmarks" / "results" / "infer.json"
BEGIN, END = "<!-- measured: begin -->", "<!-- measured: end -->"
NAMES = ("r_on", "zeta_1", "D", "epsilon", "time_unit")
ASKED = {
    "outlines, noise-free": (0.97, 0.95, 0.92, 0.95, 0.95),
    "track, noise-free": (0.90, 0.55, 0.55, 0.85, 0.95),
}
COVERAGE = (0.865, 0.935)


def page(result: dict[str, Any]) -> str:
    """Return the tables as Markdown; what falls short is in bold."""
    bank, film = result["bank"], result["film"]
    said = [
        f"A bank of {bank['runs']} runs (hash `{bank['digest']}`), {result['cells']} fresh cells; "
        f"films of {film['frames']} frames every {film['frame']:g}/k_off0, whose unit of time is "
        f"unknown within a factor of {film['time_unit'][1] / film['time_unit'][0]:.2g}. What falls "
        "short of the aim is in bold.",
        "",
        *([f"**Not of the present code.** {result['note']}", ""] if "note" in result else []),
        *_table("R²", "R2", result, ASKED),
        *_coverage(result),
        "",
        "| | ranks even, p of each parameter (aim: above 0.01) | false alarms (aim: at most 5 %) |",
        "|---|---|---|",
    ]
    for name, camera in result["cameras"].items():
        p = [camera["fresh"][one]["rank p"] for one in NAMES]
        told = ", ".join(_bold(f"{v:.3f}", v <= 0.01) for v in p)
        alarms = camera["false alarms"]
        said.append(f"| {name} | {told} | {_bold(f'{alarms:.1%}', alarms > 0.05)} |")
    said += ["", *_others(result)]
    return "\n".join(said)


def _table(
    title: str, key: str, result: dict[str, Any], asked: dict[str, tuple[float, ...]]
) -> list[str]:
    rows = [f"| {title} | " + " | ".join(NAMES) + " |", "|---" * (len(NAMES) + 1) + "|"]
    for camera, values in asked.items():
        rows.append(f"| aim: {camera} | " + " | ".join(f"{v:.2f}" for v in values) + " |")
    for camera, found in result["cameras"].items():
        values = [found["fresh"][name][key] for name in NAMES]
        aims = asked.get(camera, (float("-inf"),) * len(NAMES))
        cells = [_bold(f"{v:.2f}", v < a) for v, a in zip(values, aims, strict=True)]
        rows.append(f"| {camera} | " + " | ".join(cells) + " |")
    return [*rows, ""]


def _coverage(result: dict[str, Any]) -> list[str]:
    low, high = COVERAGE
    rows = [
        f"| 90 % intervals that hold the truth (aim {low:.1%} to {high:.1%}) | "
        + " | ".join(NAMES)
        + " |",
        "|---" * (len(NAMES) + 1) + "|",
    ]
    for camera, found in result["cameras"].items():
        values = [found["fresh"][name]["coverage"]["0.9"] for name in NAMES]
        cells = [_bold(f"{v:.1%}", not low <= v <= high) for v in values]
        rows.append(f"| {camera} | " + " | ".join(cells) + " |")
    return rows


def _others(result: dict[str, Any]) -> list[str]:
    rows = ["| cells of another kind | alarms (aim: at least 90 %) |", "|---|---|"]
    for name, value in result.get("alarms", {}).items():
        told = value if isinstance(value, str) else _bold(f"{value:.0%}", value < 0.9)
        rows.append(f"| {name} | {told} |")
    drug = result.get("drug")
    if drug:
        rows += [
            "",
            "| a drug moves one parameter by a fifth, 20 cells a side | named right (aim: 90 %) |",
            "|---|---|",
        ]
        for name, value in drug["right"].items():
            rows.append(f"| {name} | {_bold(f'{value:.0%}', value < 0.9)} |")
    return rows


def _bold(text: str, short: bool) -> str:
    return f"**{text}**" if short else text


def main() -> None:
    """Write the page."""
    text = PAGE.read_text("utf-8")
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    tables = page(json.loads(RESULTS.read_text("utf-8")))
    PAGE.write_text(f"{before}{BEGIN}\n{tables}\n{END}{after}", "utf-8")


if __name__ == "__main__":
    main()
