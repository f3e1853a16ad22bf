"""Temperature.

Each rate follows Arrhenius' law with its own energy. Binding has the higher one here, so that
warmth raises the relative on-rate, and one cell glides in the cold, zigzags at 25 °C, and spins
in the heat.
"""

import numpy as np

import cellcrawl as cc

cell = cc.PhysicalParameters(on_rate=3.3, adhesive_friction=112e3)  # (33, 560) at 25 °C
runs, on_rates = {}, {}
for celsius in (5, 25, 35):
    there = cell.at_temperature(celsius + 273.15)
    on_rates[celsius] = there.dimensionless().r_on
    start = cc.RandomPerturbation(seed=1)
    run = cc.simulate(there.dimensionless(), t_end=80, start=start)
    runs[f"{celsius} °C"] = there.scales.dataset(run)
cc.plot.paths(runs).savefig("13_temperature.png", dpi=130)

for name, run in runs.items():
    speed = float(cc.observables.speed(run).isel(time=slice(300, None)).mean())
    print(f"{name}: {cc.classify(run).mode}, {speed * 1e6:.2f} µm/s")
for celsius, on_rate in on_rates.items():
    inverse = 1 / (celsius + 273.15) - 1 / 298.15
    expected = 33 * np.exp(-(75e3 - 50e3) / 8.314462618 * inverse)  # J/mol over J/(mol K)
    assert np.isclose(on_rate, expected, rtol=1e-6), (celsius, on_rate, expected)
assert [cc.classify(run).mode for run in runs.values()] == ["gliding", "zigzag", "other"]
