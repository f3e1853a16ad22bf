"""A channel.

Walls push back where the edge enters them. A wide triangular glider goes down a channel narrower
than itself, from wall to wall.
"""

import numpy as np

import cellcrawl as cc

cell = cc.Parameters(r_on=16, zeta_1=600)
stiffness, width, angle = 2e3, 3.0, 0.4
channel = cc.surroundings.Channel(width=width, angle=angle, stiffness=stiffness)
run = cc.simulate(cell, t_end=60, surroundings=channel)
cc.plot.path(run, every=6).figure.savefig("20_channel.png", dpi=130)

# The distance of the edge from the middle of the channel: it enters the wall by a pressure over
# the stiffness, which cannot exceed all that the cell pulls with.
across = -np.sin(angle) * run["x"] + np.cos(angle) * run["y"]
deep = float(np.abs(across).max()) - width / 2
most = float((cell.sigma_c + run["tension"] * (1 + cell.h * run["curvature"])).max()) / stiffness
print("into the wall by", deep, "at most", most)
assert 0.0 < deep < most
gone = run.isel(time=-1)
along = np.cos(angle) * gone["centroid_x"] + np.sin(angle) * gone["centroid_y"]
print("down the channel by", float(along))
assert abs(along) > 3
