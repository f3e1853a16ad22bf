"""An observable of your own over a sweep.

The runs of a sweep are kept and measured by a function of yours: here the sharpest corner of the
edge. Cells get blunter as linkers rebind faster.
"""

import tempfile

import matplotlib.pyplot as plt

import cellcrawl as cc

plt.rcParams.update(cc.plot.house_style())


def sharpest_corner(run):
    """Largest curvature along the edge, averaged over the last tenth of the run."""
    late = run["curvature"].isel(time=slice(-run.sizes["time"] // 10, None))
    return float(late.max("node").mean())


grid = {"r_on": [14, 16, 20, 26, 36, 46, 56], "zeta_1": [600], "seed": [3]}
with tempfile.TemporaryDirectory() as folder:
    sweep = cc.sweep(grid, folder, t_end=60, keep="fields")
    corners = {value: sharpest_corner(sweep.run(r_on=value)) for value in grid["r_on"]}
    statuses = set(sweep.to_pandas()["status"])
print(corners, statuses)

figure, ax = plt.subplots(figsize=(3.4, 2.4), layout="constrained")
ax.plot(list(corners), list(corners.values()), "o-")
ax.axhline(1, color="grey", linestyle="--", label="a circle")
ax.set(xlabel="on-rate $r_\\mathrm{on}$", ylabel="largest curvature ($1/R_0$)", yscale="log")
ax.legend(frameon=False)
figure.savefig("17_own_observable.png", dpi=160)

assert statuses == {"completed"}
assert abs(corners[16] - 15.9) < 0.4  # by an independent continuation code: 15.9034
assert corners[14] > corners[26] > corners[56]
