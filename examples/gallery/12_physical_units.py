"""Physical units.

Lengths in metres, rates per second: parameters are given in SI, and the run is read, measured and
drawn in micrometres, seconds and piconewtons per micrometre.
"""

import cellcrawl as cc

cell = cc.PhysicalParameters(radius=10e-6, off_rate=0.1, on_rate=2.6)  # m, 1/s, 1/s
run = cc.simulate(cell.dimensionless(), t_end=90, start=cc.RandomPerturbation(seed=1))
si = cell.scales.dataset(run)
cc.plot.summary(si).savefig("12_physical_units.png", dpi=110)

speed = cc.observables.speed(si).sel(time=slice(200, None))
swing = cc.observables.tension_oscillation(si, after=400.0)
print(f"speed {float(speed.mean()) * 1e6:.3f} µm/s, left and right in {2 * swing.period:.0f} s")

# One unit of time is 10 s, one of length 10 µm: the exact period of the model is 8.78882.
assert speed.attrs["units"] == "m/s"
assert abs(float(speed.mean()) * 1e6 - 0.216) < 0.005
assert abs(swing.period / 87.8882 - 1) < 0.01
assert cc.classify(si).mode == cc.classify(run).mode == "zigzag"
