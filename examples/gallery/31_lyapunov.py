"""Regular or chaotic?

The rate at which a small change of shape grows or fades, with its error. A zigzag forgets it; an
irregular cell magnifies it, and where that cell will be in 300 time units nobody can say.
"""

import matplotlib.pyplot as plt
import numpy as np

import cellcrawl as cc

plt.rcParams.update(cc.plot.house_style())
points = {"zigzag": (26, 600), "irregular": (44, 560)}
found = {
    name: cc.branches.lyapunov_exponent(cc.Parameters(r_on=r_on, zeta_1=zeta_1), t_end=300)
    for name, (r_on, zeta_1) in points.items()
}
figure, ax = plt.subplots(figsize=(3.4, 2.4), layout="constrained")
for name, one in found.items():
    print(name, points[name], one)
    time = 0.5 * np.arange(1, len(one.course) + 1)
    ax.plot(time, np.cumsum(one.course) / np.arange(1, len(one.course) + 1), label=name)
ax.axhline(0, color="grey", linewidth=0.7)
ax.set(xlabel="time ($1/k_\\mathrm{off}^0$)", ylabel="mean rate of growth", ylim=(-0.1, 0.1))
ax.legend(frameon=False)
figure.savefig("31_lyapunov.png", dpi=160)

# The zigzag's leading multiplier over half a cycle is -0.867, by a continuation code of its own.
theory = np.log(0.867) / 8.78882
print("zigzag in theory", theory)
assert abs(found["zigzag"].value - theory) < 0.004
assert found["irregular"].value > found["zigzag"].value
