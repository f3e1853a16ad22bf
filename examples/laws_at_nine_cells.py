"""What each law and some surroundings do to the paper's nine named cells: a picture and a row each.

python examples/laws_at_nine_cells.py [FOLDER [PAGE]]

Pictures go to FOLDER; with PAGE the table is written between the markers in that page.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import xarray as xr

import cellcrawl as cc
from cellcrawl.plot.style import paper_figure

CELLS = (
    *((16, 600), (56, 560), (24, 540), (26, 600), (36, 560)),
    *((38, 580), (40, 540), (40, 600), (44, 560)),
)
laws, around = cc.laws, cc.surroundings
KINDS: dict[str, dict[str, Any]] = {
    "paper": {},
    "catch-slip": {"laws": laws.CatchSlip(catch=40.0, slip=0.6)},
    "stiffness": {"laws": laws.Stiffness(chi=0.7)},
    "load": {"laws": laws.PolymerizationUnderLoad(stall=1500.0)},
    "swept-myosin": {"laws": laws.SweptMyosin(sweep=0.5)},
    "bond-noise": {"solver": "stochastic", "bonds": 3000.0, "noise_seed": 1},
    "tension-gradient": {"surroundings": around.TensionGradient(mu=100.0)},
    "electric-field": {"surroundings": around.ElectricField(x=5.0)},
}
START = cc.RandomPerturbation(seed=1)
BEGIN, END = "<!-- nine cells: begin -->\n", "<!-- nine cells: end -->\n"


def crawl(r_on: int, zeta_1: int, kind: dict[str, Any]) -> xr.Dataset | None:
    """Run a cell to t = 100; None where it has no rest to start from."""
    try:
        return cc.simulate(cc.Parameters(r_on=r_on, zeta_1=zeta_1), 100.0, start=START, **kind)
    except cc.InputError as refused:
        print(f"({r_on}, {zeta_1}): {refused}")
        return None


def does(run: xr.Dataset | None) -> str:
    """Say in a word or two what a cell does."""
    if run is None:
        return "no rest"
    if run.attrs["status"] != "completed":
        return str(run.attrs["status"]).replace("_", " ")
    speed = float(cc.observables.speed(run.sel(time=slice(50, None))).mean())
    mode = cc.classify(run).mode
    return mode if mode == "stationary" else f"{mode} {speed:.2f}"


def draw(folder: Path, name: str, base: dict[Any, xr.Dataset | None], runs: dict[Any, Any]) -> None:
    """Draw nine paths, each over that of the paper's law."""
    with paper_figure(7.2, 7.6) as figure:
        for ax, cell in zip(figure.subplots(3, 3).flat, CELLS, strict=True):
            run, usual = runs[cell], base[cell]
            if run is None:
                ax.set_axis_off()
            else:
                cc.plot.path(run, every=20.0, colorbar=False, ax=ax)
                if usual is not None and usual is not run:
                    line = {"color": "0.45", "lw": 0.8, "ls": (0, (4, 2)), "zorder": 0.5}
                    ax.plot(usual["centroid_x"], usual["centroid_y"], **line)
            ax.set_title(f"{cell}\n{does(run)}", fontsize=8)
    figure.savefig(folder / f"nine-{name}.png", dpi=110)


def main(folder: Path, page: Path | None) -> None:
    """Run, draw and write the table."""
    folder.mkdir(parents=True, exist_ok=True)
    found = {name: {cell: crawl(*cell, kind) for cell in CELLS} for name, kind in KINDS.items()}
    for name, runs in found.items():
        draw(folder, name, found["paper"], runs)
    rows = ["| cell | " + " | ".join(KINDS) + " |", "|---" * (len(KINDS) + 1) + "|"]
    for cell in CELLS:
        told = (does(runs[cell]) for runs in found.values())
        rows.append(f"| {cell} | " + " | ".join(told) + " |")
    table = "\n".join(rows) + "\n"
    print(table)
    if page is not None:
        before, rest = page.read_text().split(BEGIN)
        page.write_text(before + BEGIN + table + END + rest.split(END)[1])


if __name__ == "__main__":
    main(
        Path(sys.argv[1] if len(sys.argv) > 1 else "laws"),
        Path(sys.argv[2]) if len(sys.argv) > 2 else None,
    )
