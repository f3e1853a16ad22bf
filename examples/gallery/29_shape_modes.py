"""Shape modes.

Principal components of the outlines of four cells together: what a biologist's eye calls wide,
lopsided or pointed are the first few axes of the cloud of shapes.
"""

import matplotlib.pyplot as plt
import numpy as np

import cellcrawl as cc

plt.rcParams.update(cc.plot.house_style())
points = {"glider": (16, 600), "zigzag": (26, 600), "rotation": (24, 540), "round": (56, 560)}
runs = {
    name: cc.simulate(cc.Parameters(r_on=r_on, zeta_1=zeta_1), t_end=60, save_every=0.5)
    for name, (r_on, zeta_1) in points.items()
}
late = [run.sel(time=slice(30, None)) for run in runs.values()]
found = cc.observables.shape_modes(*late, modes=4)

figure, (cloud, shapes) = plt.subplots(1, 2, figsize=(6.5, 2.8), layout="constrained")
for name, scores in zip(runs, found.scores, strict=True):
    cloud.plot(scores[:, 0], scores[:, 1], ".", markersize=3, label=name)
cloud.set(xlabel="first mode", ylabel="second mode")
cloud.legend(frameon=False, markerscale=2)
for which in (0, 1):
    for size in (-2.0, 0.0, 2.0):
        scores = np.zeros(4)
        scores[which] = size * np.sqrt(found.variances[which])
        x, y = np.asarray(found.shape(scores)).T
        shapes.fill(x + 1.3 * size, y - 2.6 * which, facecolor="#dfe3ec", edgecolor="#56607a")
shapes.set(aspect="equal", title="-2, 0 and +2 standard deviations of both")
shapes.axis("off")
figure.savefig("29_shape_modes.png", dpi=150)

# Variances fall, and sum to less than all; the mean shape has the area of its series.
print("explained", found.explained)
assert np.all(np.diff(found.variances) <= 0)
assert found.explained.sum() <= 1 + 1e-12
assert found.explained[:2].sum() > 0.8
