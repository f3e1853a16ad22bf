"""Cells under other laws and in other surroundings, along their paths.

python examples/laws.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

import cellcrawl as cc

around = cc.surroundings
soft = cc.laws.Stiffness
load = cc.laws.PolymerizationUnderLoad
zigzag = cc.Parameters(r_on=26, zeta_1=600)
glider = cc.Parameters(r_on=16, zeta_1=600)
ring = cc.PerturbedCircle()

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "laws")
folder.mkdir(parents=True, exist_ok=True)

stripes = around.Stripes(period=3.0, width=0.5, between=0.4, edge=0.2)
island = around.Island(radius=1.8, outside=0.1, edge=0.2)
channel = around.Channel(width=3.0, angle=0.4, stiffness=2e3)
places = {
    "stripes": cc.simulate(zigzag, 60.0, surroundings=stripes),
    "island": cc.simulate(zigzag, 60.0, surroundings=island),
    "channel": cc.simulate(glider, 60.0, surroundings=channel),
}
for name, run in places.items():
    cc.plot.path(run).figure.savefig(folder / f"{name}.png", dpi=150)
    print(f"{name}: {run.attrs['status']}, {cc.classify(run).mode}")

slope = around.Gradient("chi", x=0.02, least=0.02)
climbing = {
    f"stiffness {chi:g} in the middle": cc.simulate(
        zigzag, 60.0, start=ring, laws=soft(chi=chi), surroundings=slope
    )
    for chi in (0.4, 0.15)
}
cc.plot.paths(climbing, 60.0).savefig(folder / "stiffness.png", dpi=150)
for name, run in climbing.items():
    print(f"{name}: moved by {float(run['centroid_x'][-1]):+.2f} towards the stiffer side")

stalls = {"no load": 1e300, "stall 1500": 1500.0, "stall 1000": 1000.0}
loaded = {
    name: cc.simulate(glider, 60.0, laws=load(stall=stall), start=cc.RandomPerturbation(seed=1))
    for name, stall in stalls.items()
}
cc.plot.paths(loaded).savefig(folder / "load.png", dpi=150)
for name, run in loaded.items():
    last = run.isel(time=-1)
    print(f"{name}: {run.attrs['status']}, sharpest corner {float(last['curvature'].max()):.1f}")

blunt = around.AlongEdge("v_p", bend=-1.0, sharp=10.0)
bent = {
    "the same all along": cc.simulate(glider, 60.0),
    "slower where bent outwards": cc.simulate(glider, 60.0, surroundings=blunt),
}
cc.plot.paths(bent).savefig(folder / "along-edge.png", dpi=150)
for name, run in bent.items():
    print(f"{name}: sharpest corner {float(run['curvature'][-1].max()):.1f}")

pulled = {
    f"mu = {mu:g}": cc.simulate(zigzag, 60.0, surroundings=around.TensionGradient(mu=mu))
    for mu in (0.0, 100.0, 300.0)
}
cc.plot.paths(pulled).savefig(folder / "tension-gradient.png", dpi=150)
for name, run in pulled.items():
    print(f"tension gradient {name}: {run.attrs['status']}, {cc.classify(run).mode}")

noisy = {
    name: cc.simulate(zigzag, 60.0, solver="stochastic", nodes=256, bonds=bonds)
    for name, bonds in {"no noise": 1e300, "30000 bonds": 3e4, "3000 bonds": 3e3}.items()
}
cc.plot.paths(noisy).savefig(folder / "noise.png", dpi=150)
for name, run in noisy.items():
    print(f"{name}: {run.attrs['status']}, {cc.classify(run).mode}")
