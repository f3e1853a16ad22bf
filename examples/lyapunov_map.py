"""How fast small changes grow or fade over the paper's plane, and what each cell does for good.

python examples/lyapunov_map.py [FOLDER] [WORKERS]

Goes on where it was stopped.
"""

import sys
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

import cellcrawl as cc

if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "lyapunov-map")
    workers = int(sys.argv[2]) if len(sys.argv) > 2 else 2
    folder.mkdir(parents=True, exist_ok=True)
    began = time.monotonic()
    with ProcessPoolExecutor(workers) as pool:
        found = cc.branches.lyapunov_map(
            cc.Parameters(), r_on=np.arange(10.0, 61.0, 2.0), zeta_1=np.arange(400.0, 601.0, 20.0),
            t_end=600, output=folder / "lyapunov-map.nc", executor=pool,
        )  # fmt: skip
    print(f"{time.monotonic() - began:.0f} s")
    for label in np.unique(found["label"]):
        print(f"{label:22} {int((found['label'] == label).sum())}")
    cc.plot.lyapunov_map(found).figure.savefig(folder / "lyapunov-map.png", dpi=200)
