"""A sweep on a Dask cluster.

The same sweep on any executor: here a cluster of one process on this machine, elsewhere hundreds
of workers on a batch system. Rows are the same, to the last bit, wherever they are made.
"""

import tempfile

from distributed import Client, LocalCluster

import cellcrawl as cc

grid = {"r_on": [16, 26, 36, 46, 56], "zeta_1": [560], "seed": [1, 2, 3]}
if __name__ == "__main__":
    with (
        tempfile.TemporaryDirectory() as folder,
        LocalCluster(1, threads_per_worker=1, processes=False, dashboard_address=None) as cluster,
        Client(cluster) as client,
    ):
        sweep = cc.sweep(grid, f"{folder}/dask", client.get_executor(), t_end=50)
        here = cc.sweep(grid, f"{folder}/here", workers=1, t_end=50).to_pandas()
        there = sweep.to_pandas()
        cc.plot.measure_map(sweep, "speed").figure.savefig("16_dask.png", dpi=130)

    print(there.groupby("r_on")["speed"].mean())
    numbers = ["speed", "tension", "circularity", "turning_rate", "steps"]
    assert (there[numbers].values == here[numbers].values).all()
    # Near the upper end of motion gliders are slow: their exact speed at (56, 560) is 0.054534.
    last = there[(there["r_on"] == 56)]
    assert len(there) == 15
    assert (last["speed"] < 0.06).all()
