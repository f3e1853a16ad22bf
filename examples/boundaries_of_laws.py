"""Where cells begin to glide and gliding begins to wobble, against the numbers of other laws.

python examples/boundaries_of_laws.py [FOLDER]
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import cellcrawl as cc

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "boundaries-of-laws")
folder.mkdir(parents=True, exist_ok=True)
cell = cc.Parameters(r_on=56, zeta_1=560)
LAWS = {  # parameter, from the paper's value to another, and what it is
    "catch": (cc.laws.CatchSlip(), 0.0, 20.0, "strength of the catch path"),
    "chi": (cc.laws.Stiffness(), 1.0, 0.985, "stiffness of ground and bond in series"),
    "sweep": (cc.laws.SweptMyosin(), 0.0, 0.3, "share of myosin swept along"),
}

for name, (law, first, last, meaning) in LAWS.items():
    middle = law.replace(**{name: 0.5 * (first + last)})  # curves go both ways from there
    gliding = cc.branches.from_circle(cell, laws=middle).continue_in("r_on", 16.0)
    points = [gliding.points("pitchfork")[0], gliding.points("Hopf")[-1]]
    box = {"r_on": (5.0, 90.0), name: (min(first, last), max(first, last))}
    curves = [point.continue_in(name, within=box) for point in points]
    with plt.rc_context({"figure.constrained_layout.use": True}):
        figure, panel = plt.subplots(figsize=(3.5, 3.5))
    values = np.linspace(first, last, 25)
    onsets = [
        (onset, value)
        for value in values
        for onset in cc.branches.onsets(
            cell, "r_on", *box["r_on"], laws=law.replace(**{name: float(value)})
        )
    ]
    panel.plot(*np.array(onsets).T, "k.", markersize=3, label="the round cell begins to glide")
    cc.plot.boundaries(curves, onset=False, ax=panel)
    panel.set(xlabel="$r_\\mathrm{on}$", ylabel=meaning, xlim=box["r_on"], ylim=box[name])
    panel.legend(fontsize="small", loc="best")
    figure.savefig(folder / f"{name}.png", dpi=150)
    print(name, *curves)
