"""Where round cells begin to glide, and gliding cells to wobble, as the model's laws change.

python examples/boundaries_of_laws.py [FOLDER]

One picture each for bonds that catch, for the stiffness of the ground, and for myosin swept along
by the flow, with the curves as numbers in boundaries-of-laws.json.
"""

import json
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import cellcrawl as cc

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "boundaries-of-laws")
folder.mkdir(parents=True, exist_ok=True)
cell = cc.Parameters(r_on=56, zeta_1=560)
LAWS = {  # the law's number, from the paper's to another, and what it is
    "catch": (cc.laws.CatchSlip(), 0.0, 100.0, "strength of the catch path"),
    "chi": (cc.laws.Stiffness(), 1.0, 0.6, "stiffness of ground and bond in series"),
    "sweep": (cc.laws.SweptMyosin(), 0.0, 1.5, "share of myosin swept along by the flow"),
}


def onset(law, name, first, last):
    """Return lower and upper on-rate of the onset and the law's number, shape (values, 3).

    Where no round cell glides any more the two meet, in a parabola: denser values near there.
    """

    def at(value):
        found = cc.branches.onsets(cell, "r_on", 2.0, 150.0, laws=law.replace(**{name: value}))
        return [found[0], found[-1], value] if len(found) > 1 else None

    rows, reached = [], None
    for value in np.linspace(first, last, 25):
        reached = at(float(value))
        if reached is None:
            break
        rows.append(reached)
    if reached is None:
        begins, ends = rows[-1][2], float(value)
        for _ in range(9):
            middle = 0.5 * (begins + ends)
            begins, ends = (middle, ends) if at(middle) else (begins, middle)
        gap = begins - rows[-1][2]
        rows += [at(begins - gap * part**2) for part in np.linspace(0.9, 0.0, 7)]
    return np.array(rows), reached is None


plt.rcParams.update(cc.plot.house_style())
kept = {}
for name, (law, first, last, meaning) in LAWS.items():
    span = min(first, last), max(first, last)
    rows, closed = onset(law, name, first, last)
    low, high, values = rows.T
    gap = [] if closed else [np.nan]  # between two curves that do not meet
    edge = np.array([[*low, *gap, *high[::-1]], [*values, *gap, *values[::-1]]])
    gliding = cc.branches.from_circle(cell, laws=law).continue_in("r_on", 17.0)
    wobble = gliding.points("Hopf")[-1].continue_in(
        name, within={"r_on": (2, 150), name: span}, most_points=40, largest_step=0.3
    )
    print(name, wobble, *wobble.messages, sep="\n  ", flush=True)
    figure, ax = plt.subplots(figsize=(3.4, 3.2), layout="constrained")
    (begins,) = ax.plot(*edge, "k-", linewidth=1.0)
    (wobbles,) = ax.plot(*wobble.values.T, color="#009e73", linewidth=1.4)
    ax.set(xlabel=r"on-rate $r_\mathrm{on}$", ylabel=meaning, xlim=(0, 1.1 * high.max()), ylim=span)
    figure.legend([begins, wobbles], ["the round cell begins to glide", "gliding begins to wobble"],
                  loc="outside upper center", frameon=False)  # fmt: skip
    figure.savefig(folder / f"law-{name}.png", dpi=200)
    kept[name] = {
        "onset": rows.round(8).tolist(),
        "wobble": wobble.values.round(8).tolist(),
        "ends": list(wobble.messages),
    }  # fmt: skip
    (folder / "boundaries-of-laws.json").write_text(json.dumps(kept), encoding="utf-8")
