"""Durotaxis, both ways.

Round cells at rest on ground that is stiffer to the right. A soft place sends them up the slope,
a stiffer one down it; the drift turns round at the stiffness of greatest traction, near 0.2.
"""

import matplotlib.pyplot as plt
import numpy as np

import cellcrawl as cc

plt.rcParams.update(cc.plot.house_style())
cell, slope = cc.Parameters(r_on=26, zeta_1=600), 0.001
ground = cc.surroundings.Gradient("chi", x=slope, least=0.02)
chi = np.array([0.1, 0.15, 0.2, 0.25, 0.3, 0.4])
runs = [
    cc.simulate(
        cell,
        t_end=6,
        start=cc.PerturbedCircle(),  # round, without any wave
        laws=cc.laws.Stiffness(chi=value),
        surroundings=ground,
        rtol=1e-6,
    )
    for value in chi
]
late = [run["centroid_x"].sel(time=slice(4, 6)) for run in runs]
drift = np.array([float(x[-1] - x[0]) / 2 for x in late])

figure, ax = plt.subplots(figsize=(3.4, 2.4), layout="constrained")
ax.axhline(0, color="grey", linewidth=0.7)
ax.plot(chi, 1e3 * drift, "o-")
ax.set(xlabel=r"stiffness $\chi$", ylabel="drift to the stiffer side ($10^{-3}$)")
figure.savefig("21_durotaxis.png", dpi=160)

theory = [7.993e-4, 3.303e-4, 4.98e-5, -1.703e-4, -3.825e-4, -9.514e-4]  # of first order, by hand
print(drift, "\n", theory)
assert np.allclose(drift, theory, rtol=0.02, atol=2e-6)
