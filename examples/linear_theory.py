"""Draw the linear theory of the resting circle: the paper's Fig. 2 and the map of its Fig. 4A.

Makes the pictures of the documentation:

    python examples/linear_theory.py docs/images/linear
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import cellcrawl as cc

FIG_2 = cc.Parameters(r_on=20, zeta_1=600, D=0.01, sigma_c=100)
FAMILIES = {
    "zeta_1": [300, 400, 500, 600, 700],
    "r_on": [10, 20, 30, 45, 60],
    "D": [0.01, 0.02, 0.05, 0.1, 0.2],
    "sigma_c": [0, 100, 200, 300],
}
# the nine named cells of Fig. 4, by what they do
CELLS = {
    "gliding": ("o", [(16, 600), (56, 560)]),
    "rotational": ("s", [(24, 540)]),
    "zigzag": ("^", [(26, 600), (36, 560)]),
    "other": ("X", [(38, 580), (40, 540), (40, 600), (44, 560)]),
}


def stability_diagram() -> Figure:
    """Draw where modes grow, with the nine named cells on top (Fig. 4A)."""
    plane = {"r_on": np.linspace(4, 66, 63), "zeta_1": np.linspace(440, 640, 51)}
    ax = cc.plot.stability(cc.linear.stability_map(cc.Parameters(), **plane))
    for mode, (marker, points) in CELLS.items():
        ax.plot(
            *np.transpose(points),
            marker,
            color="white",
            markeredgecolor="black",
            markeredgewidth=0.7,
            markersize=5,
            label=mode,
        )
    ax.legend(loc="lower right", fontsize=7, handletextpad=0.2, frameon=False)
    return ax.figure


def main(folder: Path) -> None:
    """Draw all, and say the numbers of one cell."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, values in FAMILIES.items():
        figure = cc.plot.dispersion(FIG_2, k_max=40, **{name: values})
        figure.savefig(folder / f"dispersion-{name}.png", dpi=200)
    stability_diagram().savefig(folder / "stability.png", dpi=200)
    cell = cc.Parameters(r_on=25, zeta_1=600)
    onset = cc.linear.oscillation_onset(cell, k=(1, 30))[0]
    hopf = cc.linear.hopf_points(cell, k=(1, 30))[0]
    print(f"fastest: {cc.linear.fastest_mode(cell)}")
    print(f"unstable: {cc.linear.unstable_modes(cell)}")
    print(f"oscillation begins at k = {onset.value:.4f}, a Hopf point is at k = {hopf.value:.4f}")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "linear-theory"))
