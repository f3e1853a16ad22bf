"""A figure for a paper, one column wide.

Path, tension and kymograph of one run in 3.4 inches, with letters, in vector form: text stays
text, and fits the page without scaling.
"""

import matplotlib.pyplot as plt

import cellcrawl as cc

plt.rcParams.update(cc.plot.house_style())
run = cc.simulate(cc.Parameters(r_on=26, zeta_1=600), t_end=60)
figure = plt.figure(figsize=(3.4, 4.2), layout="constrained")
top, middle, bottom = figure.subplots(3, 1, height_ratios=(1.5, 0.8, 1.0))
cc.plot.path(run, every=6, ax=top)
middle.plot(run["time"], run["tension"], color="#56607a")
middle.set(xlabel="time ($1/k_\\mathrm{off}^0$)", ylabel=r"tension $\sigma$", xlim=(20, 60))
middle.set_ylim(870, 940)
cc.plot.kymograph(run.sel(time=slice(20, None)), ax=bottom)
for ax, letter in zip((top, middle, bottom), "abc", strict=True):
    ax.set_title(letter, loc="left", fontweight="bold")
figure.savefig("26_figure_for_a_paper.pdf")
figure.savefig("26_figure_for_a_paper.png", dpi=200)

# One column of most journals, and what panel b shows: a period of 8.789 in theory.
width, _ = figure.get_size_inches()
period = cc.observables.tension_oscillation(run, after=20.0).period
print("width", width, "period", period)
assert width == 3.4
assert abs(period / 8.78882 - 1) < 0.01
