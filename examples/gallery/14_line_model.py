"""The model on a line.

Two edges under one tension, the smallest cell that can crawl. A start with hardly any difference
ends as a crawling cell, whose speed theory gives as the root of an equation.
"""

import numpy as np

import cellcrawl as cc

od = cc.one_dimensional
cell = cc.Parameters(r_on=25, zeta_1=600)
run = od.simulate_two_edges(cell, 10.0)
cc.plot.two_edges(run).savefig("14_line_model.png", dpi=150)

found = od.regime(run)
(crawling,) = [state for state in od.crawling_states(cell) if state.stable]
print(found, crawling)
assert found.name == "crawling"

# One edge advances as fast as the other retracts, so the cell keeps its length ...
speeds = run["position"].isel(time=slice(-50, None)).differentiate("time").mean("time")
assert np.allclose(abs(speeds), crawling.speed, rtol=1e-3)
# ... and its retrograde flows differ from the speed of polymerisation by as much both ways.
flow = (run["off_rate"] * np.log(run["off_rate"])).isel(time=-1)
assert np.isclose(float(flow.mean()), cell.r_p * np.log(cell.r_p), rtol=1e-6)
assert np.isclose(cell.epsilon * float(flow.max() - flow.min()) / 2, crawling.speed, rtol=1e-4)
