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
EVEN = "ranks even, p (aim: above 0.01)"


def page(result: dict[str, Any]) -> str:
    """Return the tables as Markdown; what falls short is in bold."""
    bank, film = result["bank"], result["film"]
    ended = ", ".join(f"{name} {count}" for name, count in sorted(bank["outcomes"].items()))
    said = [
        f"A bank of {bank['runs']} runs (hash `{bank['digest']}`; {ended}). Films of "
        f"{film['length']:g}/k_off0, 149 frames without noise and 75 with, whose unit of time is "
        f"unknown within a factor of {film['time_unit'][1] / film['time_unit'][0]:.2g} and that "
        "begin anywhere in a run. What falls short of the aim is in bold.",
        "",
    ]
    if "note" in result:
        said += [result["note"], ""]
    for part, tables in (
        ("cameras", _cameras),
        ("methods", _methods),
        ("again", _again),
        ("alarms", _alarms),
        ("choice", _choice),
        ("drug", _drug),
    ):
        if part in result:
            said += [*tables(result[part]["found"]), ""]
            if result[part]["bank"] != bank["digest"]:
                said += [
                    "Measured with the same bank made anew, which differs in last bits (hash "
                    f"`{result[part]['bank']}`).",
                    "",
                ]
    if "microscope" in result:
        said += [
            "## What a microscope must deliver",
            "",
            "R² of each parameter, of runs of the bank set apart; one thing at a time is other "
            "than in the first row. Lengths in R_0, times in 1/k_off0.",
            "",
            *_table("", {n: list(v.values()) for n, v in result["microscope"]["found"].items()}),
            "",
        ]
    return "\n".join(said).rstrip()


def _head(title: str, columns: tuple[str, ...] = NAMES) -> list[str]:
    return [f"| {title} | " + " | ".join(columns) + " |", "|---" * (len(columns) + 1) + "|"]


def _row(name: str, cells: list[str]) -> str:
    return f"| {name} | " + " | ".join(cells) + " |"


def _table(title: str, rows: dict[str, list[float]]) -> list[str]:
    return [*_head(title), *(_row(n, [f"{v:.2f}" for v in values]) for n, values in rows.items())]


def _cameras(found: dict[str, Any]) -> list[str]:
    said = _head("R²")
    said += [_row(f"aim: {n}", [f"{v:.2f}" for v in values]) for n, values in ASKED.items()]
    said += [_recovered(n, one["fresh"], ASKED.get(n)) for n, one in found.items()]
    low, high = COVERAGE
    said += ["", *_head(f"90 % intervals that hold the truth (aim {low:.1%} to {high:.1%})")]
    said += [_held(n, one["fresh"]) for n, one in found.items()]
    said += ["", *_head(EVEN, (*NAMES, "false alarms (aim: 5 %)"))]
    for name, camera in found.items():
        alarms = camera["false alarms"]
        told = [*_ranked(camera["fresh"]), _bold(f"{alarms:.1%}", alarms > 0.05)]
        said.append(_row(name, told))
    counts = sorted({one["cells"] for one in found.values()})
    unsure = 100.0 * (0.9 * 0.1 / counts[0]) ** 0.5
    cells = " or ".join(f"{count:,}" for count in counts)
    return [
        *said,
        "",
        f"Each line is of {cells} fresh cells: a share of 90 % is known to {unsure:.1f} points, "
        "one standard deviation.",
    ]


def _recovered(name: str, fresh: dict[str, Any], aims: tuple[float, ...] | None) -> str:
    values = [fresh[one]["R2"] for one in NAMES]
    least = aims or (float("-inf"),) * len(NAMES)
    return _row(name, [_bold(f"{v:.3f}", v < a) for v, a in zip(values, least, strict=True)])


def _held(name: str, fresh: dict[str, Any]) -> str:
    low, high = COVERAGE
    values = [fresh[one]["coverage"]["0.9"] for one in NAMES]
    return _row(name, [_bold(f"{v:.1%}", not low <= v <= high) for v in values])


def _ranked(fresh: dict[str, Any]) -> list[str]:
    p = [fresh[one]["rank p"] for one in NAMES]
    return [_bold(f"{v:.3f}", v <= 0.01) for v in p]


def _methods(found: dict[str, Any]) -> list[str]:
    said = _head("ABC and NPE within one standard deviation (aim: 90 %)", (*NAMES, "all five"))
    for name, one in found.items():
        values = [*(one["within one standard deviation"][n] for n in NAMES), one["all of them"]]
        said.append(_row(name, [_bold(f"{v:.0%}", v < 0.9) for v in values]))
    said += ["", *_head("NPE: R²")]
    said += [_recovered(name, one["fresh"], ASKED.get(name)) for name, one in found.items()]
    said += ["", *_head("NPE: 90 % intervals that hold the truth")]
    said += [_held(name, one["fresh"]) for name, one in found.items()]
    said += ["", *_head(f"NPE: {EVEN}")]
    return said + [_row(name, _ranked(one["fresh"])) for name, one in found.items()]


def _again(found: dict[str, Any]) -> list[str]:
    said = _head("ABC trained twice, within one standard deviation")
    return said + [_row(n, [f"{one[m]:.0%}" for m in NAMES]) for n, one in found.items()]


def _alarms(found: dict[str, Any]) -> list[str]:
    cameras = tuple(name for name in next(iter(found.values())) if name != "cells")
    said = _head("cells of another kind: alarms (aim: at least 90 %)", cameras)
    for name, one in found.items():
        told = [
            _bold(f"{one[camera]:.0%}", one[camera] < 0.9) if camera in one else ""
            for camera in cameras
        ]
        said.append(_row(f"{name} ({one['cells']})", told))
    return said


def _choice(found: dict[str, Any]) -> list[str]:
    said = _head("choice of the law between two banks: films whose law is mistaken", ("error",))
    return said + [_row(name, [f"{one['error rate']:.0%}"]) for name, one in found.items()]


def _drug(found: dict[str, Any]) -> list[str]:
    said = _head(
        f"a drug moves one parameter by a fifth, {found['cells a side']} cells a side, "
        f"{found['trials']} trials at {found['points']} points",
        (*NAMES, "all"),
    )
    right = [*(found["right"][name] for name in NAMES), found["overall"]]
    said.append(_row("named right (aim: 90 %)", [_bold(f"{v:.0%}", v < 0.9) for v in right]))
    held = found["90 % intervals of the factor that hold it"]
    return [*said, _row("90 % intervals of the factor", [f"{held[n]:.0%}" for n in NAMES] + [""])]


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
