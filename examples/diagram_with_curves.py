"""The paper's phase diagram with the boundaries computed, under both tension laws.

python examples/diagram_with_curves.py [FOLDER]

The curves as numbers and the modes of the runs are kept in diagram.json.
"""

import json
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import cellcrawl as cc

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "diagram-with-curves")
folder.mkdir(parents=True, exist_ok=True)
GRID = {"r_on": np.arange(10.0, 61.0, 2.0), "zeta_1": np.arange(400.0, 601.0, 20.0)}
BOX = {"r_on": (7.0, 63.0), "zeta_1": (385.0, 615.0)}


def boundaries(cell: cc.Parameters) -> list[cc.branches.PointCurve]:
    """Where gliding begins to turn and to wobble, and where steady turning ends."""
    gliding = cc.branches.from_circle(cell).continue_in("r_on", 16.0)
    forks, wobbles = gliding.points("pitchfork"), gliding.points("Hopf")
    turning = forks[0].branch_off().continue_in("r_on", 0.75 * forks[0].value)
    points = [forks[0], wobbles[-1], *turning.points("Hopf")[:1]]
    options = {"within": BOX, "most_points": 60, "largest_step": 0.2}
    return [point.continue_in("zeta_1", **options) for point in points]


plt.rcParams.update(cc.plot.house_style())
figure, panels = plt.subplots(2, 1, figsize=(7.0, 7.6), layout="constrained", sharex=True)
kept = {}
for panel, law in zip(panels, ("printed", "consistent"), strict=True):
    cell = cc.Parameters(zeta_1=560, r_on=56, elasticity=law)
    grid = {**GRID, "elasticity": [law]}
    runs = cc.sweep(grid, output=folder / law, t_end=100.0, save_every=0.2)
    curves = boundaries(cell)
    cc.plot.diagram(runs, "r_on", "zeta_1", size=5.5, ax=panel)
    panel.get_legend().set_bbox_to_anchor((0.5, 1.0), panel.transAxes)
    panel.get_legend().set_loc("lower center")
    cc.plot.boundaries(curves, legend=False, ax=panel)
    panel.set_title(f"{law} tension law", loc="left", pad=22)
    panel.label_outer()
    table = runs.to_pandas()
    kept[law] = {
        "modes": table[["r_on", "zeta_1", "mode"]].values.tolist(),
        "curves": {f"{c.symmetry} {c.kind}".strip(): c.values.round(6).tolist() for c in curves},
        "ends": [list(c.messages) for c in curves],
    }
lines = {
    "gliding begins to turn": 0, "gliding begins to wobble": 1,
    "steady turning begins to wobble": 2, "the round cell begins to glide": 3,
}  # fmt: skip
drawn = [line for line in panels[0].lines if len(line.get_xdata()) > 2]
figure.legend([drawn[k] for k in lines.values()], list(lines), loc="outside lower center",
              ncols=4, frameon=False)  # fmt: skip
figure.savefig(folder / "diagram.png", dpi=200)
(folder / "diagram.json").write_text(json.dumps(kept), encoding="utf-8")
