"""Put what is recorded of long runs into docs/solvers.md, between its marks.

python tools/solvers_page.py
"""

from __future__ import annotations

import re

from performance_page import ROOT, load, recorded, table

PAGE = ROOT / "docs" / "solvers.md"


def errors() -> str:
    """Return the largest errors of every cell at every tolerance, in units of it."""
    rows = load("long")["errors"]
    tolerances = sorted({row["rtol"] for row in rows}, reverse=True)
    lines = []
    for case in dict.fromkeys(row["case"] for row in rows):
        mine = {row["rtol"]: row for row in rows if row["case"] == case}
        cells = (
            f"{mine[r]['length']:.2g} / {mine[r]['centroid']:.2g} / {mine[r]['nodes']} / "
            f"{1e3 * mine[r]['seconds']:.0f}"
            for r in tolerances
        )
        lines.append([case.partition(", D")[0], *cells])
    return table(["cell", *(f"rtol {r:g}" for r in tolerances)], lines)


def exact_states() -> str:
    """Return how far states and periods are from the exact ones."""
    rows = [
        [row["what"], row["measured"]]
        for row in load("long")["targets"]
        if row["what"].startswith(("speed of", "length of", "period of"))
    ]
    return table(["what", "error"], rows)


def amplified() -> str:
    """Return how far a change of the start carries the centroid."""
    lines = [
        [
            row["case"].partition(" printed")[0],
            str(row["wave"]),
            f"{row['early']:.2g}",
            f"{row['late']:.2g}",
        ]
        for row in load("long")["amplified"]
    ]
    return table(["cell", "wave changed", "at t = 5", "t = 50 to 100, at most"], lines)


def sides() -> str:
    """Return how often cells turn left, and tear, over many seeds."""
    lines = []
    for name, told in (("turns", "turn left"), ("tears", "tear")):
        if recorded(name):
            row = load(name)
            low, high = row["interval"]
            counts = ", ".join(f"{count} {what}" for what, count in row["counts"].items())
            cell = "({:g}, {:g})".format(*row["cell"])
            share = f"{row['share']:.3f} ({low:.3f} to {high:.3f})"
            lines.append([cell, str(row["seeds"]), counts, told, share])
    return table(["cell", "seeds", "found", "how many", "share, 95 %"], lines) if lines else ""


def endings() -> str:
    """Return how runs that leave the model end in several solvers."""
    content = load("endings")
    names = list(dict.fromkeys(run["run"] for run in content["runs"]))
    lines = []
    for cell, seed in dict.fromkeys((tuple(r["cell"]), r["seed"]) for r in content["runs"]):
        mine = {
            run["run"]: run
            for run in content["runs"]
            if (tuple(run["cell"]), run["seed"]) == (cell, seed)
        }
        cells = (
            f"{mine[name]['status'].replace('completed', 'whole at')} {mine[name]['end']:.2f}"
            for name in names
        )
        bent = (mine[name]["bends"][1] for name in names)
        told = ", ".join("never" if time is None else f"{time:.2f}" for time in bent)
        lines.append(["({:g}, {:g})".format(*cell), str(seed), *cells, told])
    return table(["cell", "seed", *names, f"curvature -{content['bends'][1]:g} at"], lines)


PARTS = {
    "errors": errors,
    "states": exact_states,
    "amplified": amplified,
    "sides": sides,
    "endings": endings,
}


def main() -> None:
    """Fill in the page."""
    page = PAGE.read_text("utf-8")
    for name, made in PARTS.items():
        if name not in ("sides", "endings") and not recorded("long"):
            continue
        mark, end = f"<!-- {name} -->", f"<!-- end of {name} -->"
        content = made().strip()
        page, found = re.subn(
            f"{re.escape(mark)}.*?{re.escape(end)}",
            lambda _, text=f"{mark}\n\n{content}\n\n{end}": text,  # type: ignore[misc]
            page,
            flags=re.DOTALL,
        )
        if found != 1:
            raise SystemExit(f"{PAGE} has {found} marks {mark} ... {end} instead of one")
    PAGE.write_text(page, "utf-8")


if __name__ == "__main__":
    main()
