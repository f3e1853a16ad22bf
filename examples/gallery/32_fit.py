"""What a film says of a cell.

A bank of 150 short runs of many binding rates and adhesion lengths, and the film of one more cell,
in pixels of a tenth of its radius. The fit finds both parameters; dashed lines are the truth.
"""

import cellcrawl as cc

prior = cc.infer.Prior({"r_on": (20, 32), "epsilon": (5e-4, 2e-3, "log")})
bank = cc.infer.bank(prior, runs=150, output="bank.h5", t_end=30)

truth = {"r_on": 26.0, "epsilon": 1.2e-3}
start = cc.RandomPerturbation(seed=7)
run = cc.simulate(cc.Parameters(**truth), t_end=30, save_every=0.5, start=start)
film = cc.observe(run.sel(time=slice(10, None)), pixel=0.1, frame=0.5)
fit = cc.infer.fit(film, bank)
print(fit.summary())
cc.infer.corner(fit, truth).savefig("32_fit.png", dpi=160)

# A third of what was thought possible, or less, and right.
for name, value in truth.items():
    found = fit.interval(name, 0.99)
    print(name, value, "found", found)
    assert found.low < value < found.high
    assert fit.narrowed[fit.names.index(name)] < 1 / 3
