"""Where round cells begin to glide, and gliding cells to wobble, as the model's laws change.

python examples/boundaries_of_laws.py [FOLDER]

One picture each for bonds that catch, for the stiffness of the ground, and for myosin swept along
by the flow, with the curves as numbers in boundaries-of-laws.json.
"""

import json
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import cellcrawl as cc

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "boundaries-of-laws")
folder.mkdir(parents=True, exist_ok=True)
cell = cc.Parameters(r_on=56, zeta_1=560)
LAWS = {  # the law's number, from the paper's to another, and what it is
    "catch": (cc.laws.CatchSlip(), 0.0, 200.0, "strength of the catch path"),
    "chi": (cc.laws.Stiffness(), 1.0, 0.5, "stiffness of ground and bond in series"),
    "sweep": (cc.laws.SweptMyosin(), 0.0, 1.5, "share of myosin swept along by the flow"),
}
plt.rcParams.update(cc.plot.house_style())
kept = {}
for name, (law, first, last, meaning) in LAWS.items():
    span = min(first, last), max(first, last)
    onsets = np.array(
        [
            (onset, value)
            for value in np.linspace(*span, 101)
            for onset in cc.branches.onsets(
                cell, "r_on", 2.0, 120.0, laws=law.replace(**{name: float(value)})
            )
        ]
    )
    gliding = cc.branches.from_circle(cell, laws=law).continue_in("r_on", 16.0)
    wobble = gliding.points("Hopf")[-1].continue_in(name, within={"r_on": (2, 120), name: span})
    print(name, wobble, wobble.messages)
    figure, ax = plt.subplots(figsize=(3.4, 3.4), layout="constrained")
    for half in (onsets[:, 0] < 30.0, onsets[:, 0] >= 30.0):
        ax.plot(*onsets[half].T, "k-", linewidth=1.0)
    cc.plot.boundaries([wobble], onset=False, legend=False, ax=ax)
    ax.set(xlabel=r"on-rate $r_\mathrm{on}$", ylabel=meaning, xlim=(0, 75), ylim=span)
    keys = [ax.lines[0], ax.lines[-1]]
    figure.legend(keys, ["the round cell begins to glide", "gliding begins to wobble"],
                  loc="outside upper center", frameon=False)  # fmt: skip
    figure.savefig(folder / f"law-{name}.png", dpi=200)
    kept[name] = {"onset": onsets.round(8).tolist(), "wobble": wobble.values.round(8).tolist()}
(folder / "boundaries-of-laws.json").write_text(json.dumps(kept), encoding="utf-8")
