"""Stop and go on.

A run that is written to disk can be stopped at any time, also by a power cut, and goes on to the
same bits as if nothing had happened.
"""

import tempfile
from pathlib import Path

import numpy as np

import cellcrawl as cc

cell, start = cc.Parameters(r_on=24, zeta_1=540), cc.RandomPerturbation(seed=3)
whole = cc.simulate(cell, t_end=60, start=start)
with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "run.nc"
    cc.simulate(cell, t_end=30, start=start, output=path)
    resumed = cc.resume(path, t_end=60).load()
    resumed.close()

runs = {"in one piece": whole, "stopped at 30": resumed}
figure = cc.plot.time_series(runs, quantities=("tension", "speed"))
for ax in figure.axes:
    ax.axvline(30, color="grey", linewidth=0.7)
    ax.lines[0].set_linewidth(4)  # to be seen below the other
figure.axes[0].legend(
    frameon=False, fontsize=7, loc="upper right", bbox_to_anchor=(1, 1.45), ncols=2
)
figure.savefig("15_restart.png", dpi=130)

different = sum(int((whole[name].values != resumed[name].values).sum()) for name in whole.data_vars)
print(different, "values of", sum(whole[name].size for name in whole.data_vars), "differ")
assert different == 0
assert np.array_equal(whole["time"], resumed["time"])
