"""A small diagram of modes.

Which mode at which binding rate and adhesion strength: fifteen cells on all cores, one row each
in a table. Where linear theory lets no wave grow, the cell rests.
"""

import tempfile

import cellcrawl as cc

grid = {"r_on": [12, 20, 26, 40, 56], "zeta_1": [420, 500, 580], "seed": [1]}
with tempfile.TemporaryDirectory() as folder:
    sweep = cc.sweep(grid, folder, t_end=60)
    table = sweep.to_pandas()
    cc.plot.diagram(sweep).figure.savefig("08_small_diagram.png", dpi=130)
print(table[["r_on", "zeta_1", "mode", "confidence", "speed"]])

for row in table.itertuples():
    theory = cc.linear.growth_rates(cc.Parameters(r_on=row.r_on, zeta_1=row.zeta_1), 1)
    at_rest = theory.real.max() <= 1e-9
    assert (row.mode == "stationary") == at_rest, (row.r_on, row.zeta_1)
