"""Cells that tear, counted.

At (16, 600) some random starts grow two fronts, stretch, and cross themselves: the model ends
there, and the run says so. Such cells are counted with an interval, and left out of averages.
"""

import numpy as np

import cellcrawl as cc

cell = cc.Parameters(r_on=16, zeta_1=600)
seeds = range(40)
runs = [cc.simulate(cell, t_end=15, start=cc.RandomPerturbation(seed=seed)) for seed in seeds]
torn = [run for run in runs if run.attrs["status"] == "fragmented"]
cc.plot.path(torn[0], every=2).figure.savefig("11_torn_cells.png", dpi=130)

share, z = len(torn) / len(runs), 1.96  # Wilson's interval of 95 percent
centre = (share + z**2 / (2 * len(runs))) / (1 + z**2 / len(runs))
half = z / (1 + z**2 / len(runs))
half *= np.sqrt(share * (1 - share) / len(runs) + z**2 / (4 * len(runs) ** 2))
print(f"{len(torn)} of {len(runs)} tear: {share:.2f} ({centre - half:.2f} to {centre + half:.2f})")
print(torn[0].attrs["status_message"])

assert abs(0.375 - centre) < half  # 60 of 160 seeds by an independent program
assert max(float(run["length"][-1]) for run in torn) > 10  # a round cell has 6.3
whole = [run for run in runs if run.attrs["status"] == "completed"]
assert all(abs(float(cc.observables.circularity(run)[-1]) - 0.73) < 0.1 for run in whole)
