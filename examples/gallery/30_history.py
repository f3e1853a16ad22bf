"""Does the past count?

A nearly round glider whose parameters jump to where cells zigzag stops instead, and breathes for
ever. Changed slowly, or under the consistent tension law, it zigzags. Same numbers, two fates.
"""

import cellcrawl as cc

start = cc.RandomPerturbation(seed=1)
jump = {"r_on": [(25.0, 56.0), (25.0, 26.0)], "zeta_1": [(25.0, 560.0), (25.0, 600.0)]}
slow = {"r_on": [(25.0, 56.0), (27.0, 26.0)], "zeta_1": [(25.0, 560.0), (27.0, 600.0)]}
runs = {
    name: cc.simulate(
        cc.Parameters(r_on=56, zeta_1=560), t_end=80, start=start, schedule=cc.Schedule(change)
    )
    for name, change in {"within 2 time units": slow, "at once": jump}.items()
}
figure = cc.plot.time_series(runs, quantities=("tension", "speed", "circularity"))
figure.axes[0].legend(frameon=False, fontsize=7, loc="upper right")
figure.savefig("30_history.png", dpi=130)

late = {name: run.sel(time=slice(50, None)) for name, run in runs.items()}
for name, run in late.items():
    print(name, cc.classify(run).mode, float(cc.observables.speed(run).mean()))
assert cc.classify(late["within 2 time units"]).mode == "zigzag"
assert float(cc.observables.speed(late["at once"]).mean()) < 0.01
# The paper's Fig. 6, made anew: tension swings from 833 to 1053 in the cell that stopped.
tension = late["at once"]["tension"]
assert abs(float(tension.min()) - 833) < 5
assert abs(float(tension.max()) - 1053) < 5
