"""A sharp diagram for part of the cost.

From a coarse grid, cells are split only where the mode changes. The border between rest and
motion falls where the growth rate of the first wave is zero.
"""

import tempfile

import numpy as np

import cellcrawl as cc
from cellcrawl import sweeps

axes = {"r_on": [40, 50, 60, 70], "zeta_1": [440, 500, 560, 620], "seed": [1]}
grid = cc.Grid(axes=axes, t_end=30)
with tempfile.TemporaryDirectory() as folder:
    sweep = sweeps.refine(grid, folder, levels=2)
    table, full = sweep.to_pandas(), sweep.full_grid_runs()
    ax = cc.plot.diagram(sweep)
    r_on, zeta_1 = np.meshgrid(np.linspace(40, 70, 61), np.linspace(440, 620, 61))
    first = cc.linear.growth_rates(cc.Parameters(), 1, r_on=r_on, zeta_1=zeta_1)[..., 0].real
    ax.contour(r_on, zeta_1, first, [0.0], colors="black", linestyles="dashed")
    ax.figure.savefig("09_refined_diagram.png", dpi=130)

print(f"{len(table)} of {full} runs")
assert len(table) < full
for row in table.itertuples():
    cell = cc.Parameters(r_on=row.r_on, zeta_1=row.zeta_1)
    rate = float(cc.linear.growth_rates(cell, 1)[0].real)  # of the first wave; the other root is 0
    grown = 1e-4 * np.exp(30 * rate)  # by the end of the run
    assert (row.mode == "stationary") == (grown < 1) or 1e-4 < grown < 1e4, (row.r_on, row.zeta_1)
