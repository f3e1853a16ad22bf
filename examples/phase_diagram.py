"""Which mode a cell takes up at each binding rate and adhesion strength: a sharp diagram, cheaply.

Run it: python examples/phase_diagram.py [folder]     (minutes on a laptop; a second time, seconds)
"""

from __future__ import annotations

import sys
from pathlib import Path

import cellcrawl as cc
from cellcrawl import sweeps

GRID = cc.Grid(
    axes={
        "r_on": {"from": 10, "to": 60, "step": 10},
        "zeta_1": {"from": 400, "to": 600, "step": 50},
        "seed": [1],
    },
    t_end=100.0,
)


def main(folder: Path, grid: cc.Grid = GRID, levels: int = 3) -> cc.Sweep:
    """Refine the diagram and draw it, with maps of two measures."""
    diagram = sweeps.refine(grid, folder, levels=levels, progress=True)
    cc.plot.diagram(diagram).figure.savefig(folder / "diagram.png", dpi=160)
    for measure in ("speed", "circularity"):
        cc.plot.measure_map(diagram, measure).figure.savefig(folder / f"{measure}.png", dpi=200)
    print(f"{len(diagram.table())} of {diagram.full_grid_runs()} runs of the full grid")
    return diagram


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "refined-diagram"))
