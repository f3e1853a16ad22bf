"""Kymographs.

What happens where on the edge, over time: bound linkers, their off-rate, the friction and the
curvature. The origin is the front; with `origin="material"` it is a point that never slides.
"""

import numpy as np

import cellcrawl as cc

cell = cc.Parameters(r_on=26, zeta_1=600)
run = cc.simulate(cell, t_end=45, start=cc.RandomPerturbation(seed=1))
late = run.sel(time=slice(15, None))
cc.plot.kymographs(late, origin="front").savefig("06_kymograph.png", dpi=110)

# Force balance at each of these points: contraction and membrane pull what linkers and flow hold.
pull = cell.sigma_c + run["tension"] * (1 + cell.h * run["curvature"])
r, n = run["off_rate"], run["bound_fraction"]
hold = r * np.log(r) + cell.zeta_1 * n * np.log(r)
print("largest residual", float(np.abs(pull - hold).max()), "of", float(pull.mean()))
assert np.abs(pull / hold - 1).max() < 1e-9
assert np.allclose(run["friction"], hold)

# The front sticks and the rear slips.
bound = cc.observables.kymograph(late, "bound_fraction", origin="front")
front = float(bound.sel(arclength=slice(-0.1, 0.1)).mean())
rear = float(bound.where(abs(bound["arclength"]) > 0.4).mean())
print("bound at the front", front, "and opposite", rear)
assert front > 2 * rear
