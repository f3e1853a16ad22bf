"""Linear theory.

How fast each wave around a round cell grows or decays, and whether it oscillates, for three
adhesion strengths: k = 1 is the first front, k = 0 the breathing of the cell.
"""

import numpy as np

import cellcrawl as cc

cell = cc.Parameters(r_on=25, zeta_1=600)
figure = cc.plot.dispersion(cell, zeta_1=[400, 500, 600])
figure.savefig("24_linear_theory.png", dpi=130)

# The first wave by hand, from the force balance of a round cell.
log_r, q = np.log(cell.r_p), cell.r_on + cell.r_p + cell.D
slip = cell.zeta_1 * cell.n_bar
by_hand = slip * log_r / (1 + log_r + slip / cell.r_p) - q
rates = cc.linear.growth_rates(cell, np.arange(1, 61))
growing = np.flatnonzero(rates.real.max(axis=1) > 0) + 1
print("k = 1 grows with", rates[0].real.max(), "by hand", by_hand, "; growing:", growing)
assert np.isclose(rates[0].real.max(), by_hand)
assert np.isclose(by_hand, 12.74, atol=0.005)
assert growing.max() == 15
