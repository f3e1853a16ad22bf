"""From a run to its branch: what a gliding cell is, and where it loses its hold.

python examples/branches.py [FOLDER]
"""

import sys
from pathlib import Path

import cellcrawl as cc

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "branches")
folder.mkdir(parents=True, exist_ok=True)

cell = cc.Parameters(r_on=56, zeta_1=560)
run = cc.simulate(cell, t_end=60, start=cc.PerturbedCircle(bound_fraction={1: (0.01, 0.0)}))
state = cc.branches.from_run(run)  # the run's end, to rounding
print(state, "stable" if state.stable else "unstable")

gliding = state.continue_in("r_on", 12)
for point in gliding.special_points:
    print(point)
turning = gliding.points("pitchfork")[0].branch_off().continue_in("r_on", 43.5)
print(turning)

cc.plot.branch([gliding, turning]).figure.savefig(folder / "branches.png", dpi=150)
box = {"zeta_1": (440, 640), "r_on": (8, 70)}
fork = gliding.points("pitchfork")[0].continue_in("zeta_1", within=box)
wobble = gliding.points("Hopf")[-1].continue_in("zeta_1", within=box)
spin = turning.points("Hopf")[0].continue_in("zeta_1", within=box)
cc.plot.boundaries([fork, wobble, spin]).figure.savefig(folder / "boundaries.png", dpi=150)
print(fork, wobble, spin, sep="\n")
