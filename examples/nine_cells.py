"""Simulate the paper's nine named cells and draw each along its path.

Makes the pictures of the documentation's gallery:

    python examples/nine_cells.py docs/images
"""

from __future__ import annotations

import sys
from pathlib import Path

import xarray as xr

import cellcrawl as cc
from cellcrawl.plot.style import paper_figure

# (r_on, zeta_1) -> time between the contours drawn, as in Fig. 4 of the paper
CELLS = {
    (16, 600): 10,
    (56, 560): 10,
    (24, 540): 10,
    (26, 600): 10,
    (36, 560): 15,
    (38, 580): 20,
    (40, 540): 20,
    (40, 600): 20,
    (44, 560): 20,
}
THREE = {(56, 560): "glides", (26, 600): "zigzags", (24, 540): "turns"}


def crawl(r_on: float, zeta_1: float, t_end: float = 100.0) -> xr.Dataset:
    """Simulate one of the nine from the paper's start."""
    cell = cc.Parameters(r_on=r_on, zeta_1=zeta_1)
    return cc.simulate(cell, t_end, start=cc.RandomPerturbation(seed=1))


def main(folder: Path) -> None:
    """Draw all nine, and three of them side by side."""
    (folder / "gallery").mkdir(parents=True, exist_ok=True)
    three = {}
    for (r_on, zeta_1), every in CELLS.items():
        run = crawl(r_on, zeta_1)
        with paper_figure(3.6, 3.2) as figure:
            cc.plot.path(run, every=every, ax=figure.subplots())
        figure.savefig(folder / "gallery" / f"{r_on}-{zeta_1}.png", dpi=160)
        if (r_on, zeta_1) in THREE:
            three[THREE[r_on, zeta_1]] = run
        heading = cc.observables.heading(run).sel(time=slice(20, None))
        late = run.sel(time=slice(20, None))
        print(
            f"({r_on}, {zeta_1}) {run.attrs['status']}: "
            f"speed {float(cc.observables.speed(late).mean()):.3f}, "
            f"tension {float(late.tension.min()):.1f} to {float(late.tension.max()):.1f}, "
            f"circularity {float(cc.observables.circularity(late).min()):.4f} to "
            f"{float(cc.observables.circularity(late).max()):.4f}, "
            f"turned {float(heading[-1] - heading[0]):+.2f} rad, swings "
            f"{float(heading.max() - heading.min()):.2f} rad"
        )
    cc.plot.paths({name: three[name] for name in THREE.values()}, every=10).savefig(
        folder / "three-cells.png", dpi=200
    )


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "nine-cells"))
