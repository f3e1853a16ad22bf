"""Draw the pictures that explain the model: forces on the edge, stick and slip, the loop, a front.

python tools/model_pictures.py
"""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

import cellcrawl as cc

FOLDER = Path(__file__).resolve().parent.parent / "docs" / "images" / "model"
STICK, SLIP, INK = "#3a8f3f", "#4b3b8f", "#333333"

# What happens, in order; each step makes the next.
LOOP = (
    "Here the edge advances a little",
    "The cell gets larger",
    "Tension rises, everywhere alike",
    "Elsewhere bonds are pulled harder",
    "They let go: the edge slips back",
    "Here bonds hold: the edge stays",
)


def forces() -> Figure:
    """Draw a crawling cell with the velocities at its edge, and the two ways an edge can be."""
    cell = cc.Parameters(r_on=26, zeta_1=600)
    run = cc.simulate(cell, t_end=30, start=cc.RandomPerturbation(seed=1))
    now = run.isel(time=-1)
    figure = Figure(figsize=(6.8, 2.9), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.25))
    cc.plot.cell(run, time=30.0, ax=left, velocity=False, colorbar=False)
    picked = now.isel(node=slice(None, None, 8))
    normal = np.sin(picked["theta"]), -np.cos(picked["theta"])
    arrows = [part * picked["normal_velocity"] for part in normal]
    left.quiver(
        picked["x"], picked["y"], *arrows, color="#d55e00", angles="xy", scale_units="xy",
        scale=0.6, width=0.006,
    )  # fmt: skip
    left.set(title="velocity of the edge", xticks=[], yticks=[], xlabel="", ylabel="")
    left.margins(0.15)
    left.autoscale()
    left.spines[:].set_visible(False)

    rate = np.geomspace(1.001, 150, 400)
    held = cell.r_on / (cell.r_on + rate)  # bound, where binding and letting go balance
    friction = rate * np.log(rate) + cell.zeta_1 * held * np.log(rate)
    slip = np.gradient(friction, rate) < 0
    right.plot(rate * np.log(rate), friction, color=INK)
    for part, colour, word in (
        (rate < rate[slip][0], STICK, "sticks"),
        (rate > rate[slip][-1], SLIP, "slips"),
    ):
        right.plot((rate * np.log(rate))[part], friction[part], color=colour, linewidth=3)
        where = np.flatnonzero(part)[part.sum() // 2]
        right.annotate(
            word, (rate[where] * np.log(rate[where]), friction[where]), xytext=(8, -12),
            textcoords="offset points", color=colour, weight="bold",
        )  # fmt: skip
    pull = float(now["friction"].mean())
    right.axhline(pull, color="grey", linewidth=0.8, linestyle="--")
    right.annotate(
        "dashed: the pull of contraction and tension", (640, 1210), ha="right", color="grey"
    )
    right.axvline(cell.v_p, color="#d55e00", linewidth=0.8)
    growth = "growth: left of it the edge\nadvances, right of it it retracts"
    right.annotate(growth, (cell.v_p + 12, 300), color="#d55e00")
    right.set(xlabel="speed at which actin flows back", ylabel="friction", xlim=(0, 650))
    right.set(ylim=(0, float(friction.max()) * 1.1), title="one pull, two ways to bear it")
    right.spines[["top", "right"]].set_visible(False)
    return figure


def loop() -> str:
    """Return the feedback loop as an SVG, in which the steps light up one after another."""
    seconds, width, height, gap = 9.0, 190, 46, 34
    places = [(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1)]
    parts = []
    for step, (text, (column, row)) in enumerate(zip(LOOP, places, strict=True)):
        x, y = 10 + column * (width + gap), 10 + row * (height + 60)
        begin = step * seconds / len(LOOP)
        parts.append(
            f'<rect x="{x}" y="{y}" width="{width}" height="{height}" rx="9" class="box">'
            f'<animate attributeName="fill" values="#f2c14e;#f2c14e;#eef1f6;#eef1f6" '
            f'keyTimes="0;0.12;0.2;1" dur="{seconds}s" begin="{begin - seconds:.2f}s" '
            'repeatCount="indefinite"/></rect>'
        )
        words = text.split()
        half = next(
            i for i in range(1, len(words) + 1) if len(" ".join(words[:i])) * 2 >= len(text)
        )
        for line, part in enumerate((" ".join(words[:half]), " ".join(words[half:]))):
            parts.append(f'<text x="{x + width / 2}" y="{y + 20 + 16 * line}">{part}</text>')
    right, middle = 10 + 2 * (width + gap) + width / 2, 10 + height
    lower = middle + 60 + height / 2
    arrows = [
        (10 + width, 10 + height / 2, 10 + width + gap, 10 + height / 2),
        (10 + 2 * width + gap, 10 + height / 2, 10 + 2 * (width + gap), 10 + height / 2),
        (right, middle, right, middle + 60),
        (10 + 2 * (width + gap), lower, 10 + 2 * width + gap, lower),
        (10 + width + gap, lower, 10 + width, lower),
        (10 + width / 2, middle + 60, 10 + width / 2, middle),
    ]
    for x1, y1, x2, y2 in arrows:
        dx, dy = np.sign(x2 - x1) * 4, np.sign(y2 - y1) * 4
        parts.append(
            f'<line x1="{x1 + dx:g}" y1="{y1 + dy:g}" x2="{x2 - 2 * dx:g}" y2="{y2 - 2 * dy:g}" '
            'class="arrow" marker-end="url(#head)"/>'
        )
    return "\n".join(
        [
            '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 658 172" role="img">',
            "<title>The feedback loop of the model: six steps in a ring</title>",
            "<style>text{font:14px sans-serif;text-anchor:middle;fill:#222}"
            ".box{fill:#eef1f6;stroke:#56607a}.arrow{stroke:#d55e00;stroke-width:2.5}</style>",
            '<defs><marker id="head" viewBox="0 0 8 8" refX="4" refY="4" markerWidth="5" '
            'markerHeight="5" orient="auto">'
            '<path d="M0 0L8 4L0 8z" fill="#d55e00"/></marker></defs>',
            '<rect width="658" height="172" fill="#ffffff" rx="6"/>',
            *parts,
            "</svg>\n",
        ]
    )


def main() -> None:
    """Make them all."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    with mpl.rc_context(cc.plot.house_style()):
        forces().savefig(FOLDER / "forces.png", dpi=170)
    (FOLDER / "loop.svg").write_text(loop(), "utf-8")
    cell = cc.Parameters(r_on=26, zeta_1=600)
    setting_off = cc.simulate(cell, t_end=4, save_every=0.05, start=cc.RandomPerturbation(seed=1))
    cc.movie(setting_off, FOLDER / "front.gif", seconds=6, fps=10, size=(360, 360))


if __name__ == "__main__":
    main()
