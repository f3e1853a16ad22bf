"""Run the package over the plane of the map and keep the mode of every point.

``python -m cellcrawl.explorer.diagram`` writes the file the page is made with; it takes about a
minute on one core.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Final

import numpy as np

import cellcrawl
from cellcrawl.explorer.content import DIAGRAM

R_ON: Final = np.arange(12.0, 62.0, 4.0)
ZETA_1: Final = np.arange(510.0, 620.0, 20.0)
T_END: Final = 100.0
SEED: Final = 2


def main() -> None:
    """Write the diagram."""
    rows = []
    for zeta_1 in ZETA_1:
        for r_on in R_ON:
            parameters = cellcrawl.Parameters(r_on=float(r_on), zeta_1=float(zeta_1))
            start = cellcrawl.RandomPerturbation(seed=SEED)
            run = cellcrawl.simulate(parameters, t_end=T_END, start=start)
            rows.append([float(r_on), float(zeta_1), cellcrawl.classify(run).mode])
    about = {"t_end": T_END, "seed": SEED, "modes": rows}
    Path(__file__).with_name(DIAGRAM).write_text(json.dumps(about) + "\n", "utf-8")


if __name__ == "__main__":
    main()
