"""The paper's phase diagram with the boundaries computed, under both tension laws.

python examples/diagram_with_curves.py [FOLDER]
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import cellcrawl as cc

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "diagram-with-curves")
folder.mkdir(parents=True, exist_ok=True)
GRID = {"r_on": np.arange(11.0, 62.0, 2.0), "zeta_1": np.arange(500.0, 601.0, 10.0)}
BOX = {"r_on": (9.0, 63.0), "zeta_1": (495.0, 605.0)}


def boundaries(cell: cc.Parameters) -> list[cc.branches.PointCurve]:
    """Where gliding begins to turn and to wobble, and where steady turning ends."""
    gliding = cc.branches.from_circle(cell).continue_in("r_on", 16.0)
    forks, wobbles = gliding.points("pitchfork"), gliding.points("Hopf")
    turning = forks[0].branch_off().continue_in("r_on", 0.75 * forks[0].value)
    points = [forks[0], wobbles[-1], *turning.points("Hopf")[:1]]
    return [point.continue_in("zeta_1", within=BOX) for point in points]


with plt.rc_context({"figure.constrained_layout.use": True}):
    figure, panels = plt.subplots(2, 1, figsize=(7.1, 8.4))
for panel, law in zip(panels, ("printed", "consistent"), strict=True):
    cell = cc.Parameters(zeta_1=560, r_on=56, elasticity=law)
    grid = {**GRID, "elasticity": [law]}
    runs = cc.sweep(grid, output=folder / law, t_end=100.0, save_every=0.2)
    cc.plot.diagram(runs, "r_on", "zeta_1", legend=panel is panels[1], size=7, ax=panel)
    cc.plot.boundaries(boundaries(cell), legend=panel is panels[0], ax=panel)
    panel.set_title(f"{law} tension law", loc="left")
lines = panels[0].get_legend()
figure.legend(lines.legend_handles, [text.get_text() for text in lines.get_texts()],
              loc="outside lower center", ncols=2, fontsize="small")  # fmt: skip
lines.remove()
figure.savefig(folder / "diagram.png", dpi=150)
