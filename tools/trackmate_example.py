"""Make examples/cells.xml: four cells of the paper, filmed, as TrackMate would have saved them.

python tools/trackmate_example.py
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np

import cellcrawl as cc

ROOT = Path(__file__).resolve().parents[1]
TARGET = ROOT / "examples" / "cells.xml"
CELLS = {"glides": (16, 600), "turns": (24, 540), "zigzags": (26, 600), "wanders": (40, 600)}
RADIUS, TIME = 10.0, 10.0  # um and s: the paper's cell
PLACES = ((60.0, 60.0), (420.0, 60.0), (60.0, 420.0), (420.0, 420.0))  # um
FRAME, T_END = 1.0, 100.0  # of the model


def filmed(number: int) -> list[cc.microscopy.Outline]:
    """Return the outlines of one cell in micrometres and seconds."""
    r_on, zeta_1 = list(CELLS.values())[number]
    run = cc.simulate(
        cc.Parameters(r_on=r_on, zeta_1=zeta_1),
        t_end=T_END,
        save_every=0.5,
        nodes=96,
        start=cc.RandomPerturbation(seed=1),
    ).sel(time=slice(20.0, None))
    seen = cc.observe(run, pixel=0.1, error=0.02, frame=FRAME, seed=number)
    first = seen.outlines[0].centroid
    return [
        replace(
            outline,
            xy=RADIUS * (outline.xy - first) + np.array(PLACES[number]),
            track=str(number),
            t=TIME * FRAME * outline.frame,
            length_units="micron",
            time_units="sec",
        )
        for outline in seen.outlines
    ]


def main() -> None:
    """Write the file, with numbers as short as the pixels allow."""
    outlines = [one for number in range(len(CELLS)) for one in filmed(number)]
    cc.write_outlines(TARGET, outlines, form="trackmate")
    text = TARGET.read_text("utf-8")
    text = re.sub(r"-?\d+\.\d{3,}", lambda found: f"{float(found[0]):.2f}", text)
    TARGET.write_text(text, "utf-8")
    print(f"{TARGET.relative_to(ROOT)}: {TARGET.stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    main()
