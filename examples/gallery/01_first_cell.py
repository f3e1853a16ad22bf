"""A first cell.

The zigzagging cell of the paper from a round start with tiny irregularities: its path, its
tension, and a map of the bound linkers along the edge. The tension belongs to the area at every
instant.
"""

import numpy as np

import cellcrawl as cc

cell = cc.Parameters(r_on=26, zeta_1=600)
run = cc.simulate(cell, t_end=60, start=cc.RandomPerturbation(seed=1))
cc.plot.summary(run).savefig("01_first_cell.png", dpi=110)

found = cc.classify(run)
print(found.mode, found.summary())

# The model's invariant: tension and area rise and fall together, whatever the cell does.
tension = run["tension"] - run["tension"][0]
area = run["area"] - run["area"][0]
assert run.attrs["status"] == "completed"
assert found.mode == "zigzag"
assert np.abs(area - tension / cell.tension_rate).max() < 1e-6
