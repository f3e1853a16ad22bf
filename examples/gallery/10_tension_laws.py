"""The two readings of the tension law.

The law as printed lets the cell breathe as it sets off; the one that the scales of the paper give
does not. Later the cell moves alike under both, at the same mean tension.
"""

import numpy as np

import cellcrawl as cc

start = cc.RandomPerturbation(seed=1)
laws = ("printed", "consistent")
cells = {law: cc.Parameters(r_on=25, zeta_1=600, elasticity=law) for law in laws}
runs = {law: cc.simulate(cell, t_end=40, start=start) for law, cell in cells.items()}
figure = cc.plot.time_series(runs, quantities=("tension", "area", "speed"))
figure.axes[0].legend(
    frameon=False, fontsize=7, loc="upper right", bbox_to_anchor=(1, 1.45), ncols=2
)
figure.savefig("10_tension_laws.png", dpi=110)

# The breathing mode k = 0 in linear theory: it grows under the printed law alone.
printed, consistent = (cc.linear.growth_rates(cell, 0) for cell in cells.values())
print("printed", printed, "consistent", consistent)
assert np.isclose(printed[0].real, 4.65, atol=0.01)
assert np.isclose(abs(printed[0].imag), 15.5, atol=0.05)
assert np.allclose(np.sort(consistent.real), [-3408, -77], atol=1)

late = [run.sel(time=slice(15, None)) for run in runs.values()]
tensions = [float(run["tension"].mean()) for run in late]
print("mean tension", tensions)
assert abs(tensions[0] / tensions[1] - 1) < 0.01
