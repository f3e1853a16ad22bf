"""Adhesive stripes.

Beside the stripe two fifths of the linkers are there. The zigzagging cell spreads along it and
stays; on bare ground it leaves.
"""

import numpy as np

import cellcrawl as cc

cell = cc.Parameters(r_on=26, zeta_1=600)
stripes = cc.surroundings.Stripes(period=3.0, width=0.5, between=0.4, edge=0.2)
runs = {
    "bare ground": cc.simulate(cell, t_end=40),
    "stripes": cc.simulate(cell, t_end=40, surroundings=stripes),
}
cc.plot.paths(runs, every=8).savefig("19_stripes.png", dpi=130)

for run in runs.values():
    gained = (run["tension"] - run["tension"][0]) / cell.tension_rate
    assert np.abs(run["area"] - run["area"][0] - gained).max() < 1e-6
# The stripe lies along x: how far the cell gets from its middle.
sideways = {name: float(abs(run["centroid_y"]).max()) for name, run in runs.items()}
print("sideways", sideways)
assert sideways["stripes"] < 1.5  # half of the distance from stripe to stripe
