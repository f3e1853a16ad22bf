"""Mean squared displacement, and the error of positions.

An error s of each position adds 4 s² at every lag and looks like diffusion; the fit of a
persistent walk tells it apart from the cell's own motion.
"""

import matplotlib.pyplot as plt
import numpy as np

import cellcrawl as cc

plt.rcParams.update(cc.plot.house_style())
run = cc.simulate(cc.Parameters(r_on=38, zeta_1=580), t_end=300, save_every=0.2)
run = run.sel(time=slice(10, None))
error = 0.1
rng = np.random.default_rng(1)
t = run["time"].values
x, y = (run[name].values + rng.normal(0, error, t.size) for name in ("centroid_x", "centroid_y"))

true = cc.observables.mean_squared_displacement(run, longest=40)
seen = cc.observables.mean_squared_displacement(t, x, y, longest=40)
walk = cc.observables.persistent_walk(t, x, y)
figure, ax = plt.subplots(figsize=(3.4, 2.6), layout="constrained")
for values, label, marker in ((true, "the cell", "-"), (seen, f"with errors of {error}", ".")):
    ax.loglog(values["lag"][1:], values[1:], marker, label=label)
ax.axhline(4 * error**2, color="grey", linestyle="--", label="$4s^2$")
ax.set(xlabel="lag ($1/k_\\mathrm{off}^0$)", ylabel="mean squared displacement ($R_0^2$)")
ax.legend(frameon=False)
figure.savefig("05_displacement.png", dpi=160)

added = float((seen - true)[1:6].mean())
print("added", added, "4 s^2 =", 4 * error**2, "fitted s =", walk.localisation_error)
assert abs(added / (4 * error**2) - 1) < 0.1
assert walk.localisation_error.low < error < walk.localisation_error.high
