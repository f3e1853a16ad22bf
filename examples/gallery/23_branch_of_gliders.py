"""A branch of gliders.

Gliding cells computed as such, stable (solid) or not (dotted), and followed in the on-rate: where
they are born from the round cell, and where they begin to turn.
"""

import cellcrawl as cc

cell = cc.Parameters(r_on=56, zeta_1=560)
state = cc.branches.gliding(cell)
up, down = state.continue_in("r_on", 58), state.continue_in("r_on", 50)
turning = down.points("pitchfork")[0].branch_off().continue_in("r_on", 50)
ax = cc.plot.branch([up, down, turning])
ax.annotate("turns", (52, 0.12), fontsize=7)
ax.annotate("glides", (56.1, 0.06), fontsize=7)
ax.figure.savefig("23_branch_of_gliders.png", dpi=150)
for point in (*up.special_points, *down.special_points):
    print(point)

# By a continuation code of its own, and the closed form for the circle.
assert abs(state.speed - 0.05453426996) < 1e-9
assert abs(down.points("pitchfork")[0].value - 54.817202) < 1e-5
assert abs(up.points("circle")[0].value - 57.379211156) < 1e-5
