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


def dispersion_relations() -> Figure:
    """Draw growth rate and frequency for four families (Fig. 2 A-D)."""
    figure = Figure(figsize=(7.4, 7.6), layout="constrained")
    axes = figure.subplots(4, 2, sharex=True)
    for letter, row, (name, values) in zip("ABCD", axes, FAMILIES.items(), strict=True):
        cc.plot.dispersion(FIG_2, k_max=40, axes=row, **{name: values})
        row[0].set_title(letter, loc="left", fontweight="bold")
        for ax in row:
            ax.set_xlabel("wavenumber $k$" if letter == "D" else "")
    return figure


def stability_diagram() -> tuple[Figure, Figure]:
    """Draw where modes grow, with the nine named cells on top (Fig. 4A), and how many do."""
    plane = {"r_on": np.linspace(4, 66, 249), "zeta_1": np.linspace(440, 640, 201)}
    stability = cc.linear.stability_map(cc.Parameters(), **plane)
    shaded = cc.plot.stability(stability)
    for mode, (marker, points) in CELLS.items():
        shaded.plot(
            *np.transpose(points), marker, color="white", markeredgecolor="black", label=mode
        )
    keys = shaded.get_legend()
    shaded.legend(loc="lower left", fontsize=6.5, handletextpad=0.2, framealpha=1.0)
    shaded.add_artist(keys)
    counted = Figure(figsize=(3.6, 2.9), layout="constrained")
    ax = counted.subplots()
    number = stability.unstable_modes.where(stability.unstable_modes > 0)
    image = ax.pcolormesh(stability.r_on, stability.zeta_1, number.T, rasterized=True)
    counted.colorbar(image, label="unstable modes")
    ax.set(xlabel=r"on-rate $r_\mathrm{on}$", ylabel=r"adhesion strength $\zeta_1$")
    return shaded.figure, counted


def main(folder: Path) -> None:
    """Draw all, and say the numbers of one cell."""
    folder.mkdir(parents=True, exist_ok=True)
    dispersion_relations().savefig(folder / "dispersion.png", dpi=160)
    cell = cc.Parameters(r_on=25, zeta_1=600)
    cc.plot.dispersion(cell).savefig(folder / "one-cell.png", dpi=160)
    shaded, counted = stability_diagram()
    shaded.savefig(folder / "stability.png", dpi=160)
    counted.savefig(folder / "unstable-modes.png", dpi=160)
    onset = cc.linear.oscillation_onset(cell, k=(1, 30))[0]
    hopf = cc.linear.hopf_points(cell, k=(1, 30))[0]
    print(f"fastest: {cc.linear.fastest_mode(cell)}")
    print(f"unstable: {cc.linear.unstable_modes(cell)}")
    print(f"oscillation begins at k = {onset.value:.4f}, a Hopf point is at k = {hopf.value:.4f}")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "linear-theory"))
