"""An outline as the start.

A closed polygon drawn around a cell becomes the first shape: here a fan of 40 clicks, in pixels.
It is scaled to the area of the model's round cell, smoothed where needed, and crawls off.
"""

import numpy as np

import cellcrawl as cc

angle = np.linspace(0.0, 2 * np.pi, 40, endpoint=False)
width = 60 + 18 * np.cos(2 * angle) - 8 * np.cos(3 * angle)  # pixels
clicks = np.column_stack([200 + width * np.cos(angle), 150 + width * np.sin(angle)])

start = cc.FromOutline(clicks, radius=1.0)
run = cc.simulate(cc.Parameters(r_on=26, zeta_1=600), t_end=20, start=start)
cc.plot.snapshots(run, [0, 0.5, 1, 2, 5, 20]).savefig("03_outline.png", dpi=110)

# The shape at t = 0 is the polygon: same area (pi), same slenderness, by moments of the polygon.
x, y = run["x"][0].values, run["y"][0].values
area = 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))
drawn = 0.5 * np.sum(
    clicks[:, 0] * np.roll(clicks[:, 1], -1) - clicks[:, 1] * np.roll(clicks[:, 0], -1)
)
scale = np.sqrt(np.pi / drawn)
print("area", area, "width", np.ptp(x), "drawn", np.ptp(clicks[:, 0]) * scale)
assert abs(area - np.pi) < 2e-3
assert abs(np.ptp(x) / (np.ptp(clicks[:, 0]) * scale) - 1) < 0.02
assert abs(np.ptp(y) / (np.ptp(clicks[:, 1]) * scale) - 1) < 0.02
assert run.attrs["status"] == "completed"
