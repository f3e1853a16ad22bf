"""Noise of few bonds.

Bonds come and go one by one. With a finite number of sites the bound fraction of a stretch of
edge scatters by as much as coin tosses say, and the cell's path becomes irregular.
"""

import numpy as np

import cellcrawl as cc

zigzag = cc.Parameters(r_on=26, zeta_1=600)
runs = {
    name: cc.simulate(zigzag, t_end=40, solver="stochastic", nodes=256, bonds=bonds)
    for name, bonds in {"no noise": 1e300, "30,000 bonds": 3e4, "3,000 bonds": 3e3}.items()
}
cc.plot.paths(runs, every=8).savefig("22_noise.png", dpi=130)

# A cell at rest, whose velocity is noise alone. Its mean square by linear theory: noise in the wave
# k = 1 of the bound fraction, forgotten at the rate of that wave.
rest, bonds = cc.Parameters(r_on=60, zeta_1=500), 2e6
options = {"solver": "stochastic", "nodes": 64, "bonds": bonds, "dt": 2e-3}
run = cc.simulate(rest, t_end=100, start=cc.PerturbedCircle(), **options)
late = run.sel(time=slice(2, None))
velocity = [
    2 * (late["normal_velocity"] * side).mean("node")
    for side in (np.sin(late["theta"]), -np.cos(late["theta"]))
]
measured = float(sum((part**2).mean() for part in velocity)) / 2

log_r, n = np.log(rest.r_p), rest.n_bar
a, c = 1 + log_r + rest.zeta_1 * n / rest.r_p, 1 + log_r
rate = rest.zeta_1 * n * log_r / a - (rest.r_on + rest.r_p + rest.D)
gain = rest.epsilon * c * rest.zeta_1 * log_r / a
theory = gain**2 * rest.r_p * n / (np.pi * bonds * abs(rate))
print("mean square velocity", measured, "theory", theory)
assert abs(measured / theory - 1) < 0.2
