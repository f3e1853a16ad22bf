"""A run against linear theory.

A single wave of three lobes, made as a mode of the theory, grows in the full model as the theory
says for as long as it is small, and then no longer.
"""

import numpy as np

import cellcrawl as cc

cell = cc.Parameters(r_on=25, zeta_1=600, elasticity="consistent")
run = cc.simulate(
    cell, t_end=1.2, save_every=0.01, start=cc.Eigenmode(k=3, amplitude=1e-6), rtol=1e-6
)
cc.plot.growth(run, k=[3]).figure.savefig("25_growth_of_a_mode.png", dpi=160)

wave = cc.observables.fourier_amplitude(run, "bound_fraction", 3)
size = np.abs(wave.sel(time=slice(0.1, 0.5)).squeeze())
slope = np.polyfit(size["time"], np.log(size), 1)[0]
# Roots of a lambda^2 + (a q + S c - b) lambda + S c q, written out.
log_r, r, n = np.log(cell.r_p), cell.r_p, cell.n_bar
a, c, b = 1 + log_r + cell.zeta_1 * n / r, 1 + log_r, cell.zeta_1 * n * log_r
q, s = cell.r_on + r + 9 * cell.D, cell.epsilon * cell.h * cell.sigma_bar * 8
theory = max(np.roots([a, a * q + s * c - b, s * c * q]).real)
print("growth rate in the run", slope, "theory", theory)
assert abs(slope / theory - 1) < 1e-3
