"""Your own parameters.

Any of the eight numbers of the model may be changed. Here contraction: linear theory says that it
leaves the growth of the first front alone and lowers the tension by as much as it pulls.
"""

import numpy as np

import cellcrawl as cc

cell = cc.Parameters(r_on=16, zeta_1=560, D=0.05)
start = cc.RandomPerturbation(seed=4)
runs = {
    f"contraction {value}": cc.simulate(cell.replace(sigma_c=value), t_end=60, start=start)
    for value in (0, 100, 300)
}
cc.plot.paths(runs, every=10).savefig("02_own_parameters.png", dpi=110)

# The resting circle: pull of contraction and membrane = friction of flow and linkers, with log r_p.
for value, run in zip((0, 100, 300), runs.values(), strict=True):
    own = cell.replace(sigma_c=value)
    bound = own.r_on / (own.r_on + own.r_p)
    friction = np.log(own.r_p) * (own.r_p + own.zeta_1 * bound)
    resting_tension = (friction - value) / (1 + own.h)
    print(value, float(run["tension"][0]), resting_tension)
    assert np.isclose(run["tension"][0], resting_tension, rtol=1e-9)
    assert np.isclose(cc.linear.growth_rates(own, 1)[0], cc.linear.growth_rates(cell, 1)[0])
    assert run.attrs["status"] == "completed"
