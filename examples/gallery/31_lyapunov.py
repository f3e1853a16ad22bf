"""How fast a cell forgets.

The largest Lyapunov exponent: the rate at which a small change of shape grows or, here, fades. A
zigzag and a rotation both come back to their orbits, as fast as the orbits' multipliers say.
"""

import matplotlib.pyplot as plt
import numpy as np

import cellcrawl as cc

plt.rcParams.update(cc.plot.house_style())
# Leading multipliers and their times, by a continuation code of its own.
cells = {"zigzag": (26, 600, -0.867, 8.78882), "rotation": (24, 540, -0.506, 12.9350)}
figure, ax = plt.subplots(figsize=(3.4, 2.4), layout="constrained")
for name, (r_on, zeta_1, multiplier, time) in cells.items():
    cell = cc.Parameters(r_on=r_on, zeta_1=zeta_1)
    found = cc.branches.lyapunov_exponent(cell, t_end=300)
    theory = np.log(abs(multiplier)) / time
    print(name, found, "theory", theory)
    assert found.label == "periodic"
    assert abs(found.value - theory) < 0.004

    width = round(2 * time / 0.5)  # a measurement each half unit of time: over two cycles
    smooth = np.convolve(found.course, np.full(width, 1 / width), "valid")
    (line,) = ax.plot(0.5 * np.arange(width, len(found.course) + 1), smooth, label=name)
    ax.axhline(theory, color=line.get_color(), linestyle="--", linewidth=0.7)
ax.axhline(0, color="grey", linewidth=0.7)
ax.set(xlabel="time ($1/k_\\mathrm{off}^0$)", ylabel="rate of growth", ylim=(-0.12, 0.03))
ax.legend(frameon=False, loc="lower right")
figure.savefig("31_lyapunov.png", dpi=160)
