"""Area, length and period of the tension over a very long run, solver by solver: data and picture.

    python benchmarks/invariants.py --output benchmarks/results

All to t = 10000 (--adaptive, --paper and --spline say how far; 0 keeps what is recorded), the
others on the coarsest grids and steps that a zigzag bears, or they would take hours. A settled
zigzag keeps all three for ever.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import cellcrawl as cc
from cellcrawl.bench import exact, machine
from cellcrawl.bench.cases import check_start
from cellcrawl.numerics import fourier
from cellcrawl.plot.style import GUIDE, PAGE, paper_figure

CELL = (26.0, 600.0)
WINDOW = 50.0  # over which length is averaged and a period taken
OPTIONS: dict[str, dict[str, Any]] = {
    "adaptive": {"nodes": 512},
    "paper": {"nodes": 400, "dt": 2e-3},
    "spline": {"nodes": 192, "dt": 8e-3},
}
COLOURS = {"adaptive": "#0072b2", "paper": "#e69f00", "spline": "#009e73"}


def measured(solver: str, t_end: float, path: Path) -> dict[str, Any]:
    """Return the run window by window, read from the file at ``path`` so that memory stays flat."""
    p = cc.Parameters(r_on=CELL[0], zeta_1=CELL[1])
    began = time.perf_counter()
    run = cc.simulate(
        p, t_end, start=check_start(p), solver=solver, save_every=0.1, output=path,
        overwrite=True, **OPTIONS[solver],
    )  # fmt: skip
    seconds = time.perf_counter() - began
    first = run.isel(time=0)
    area_0 = float(fourier.area(first["x"].values, first["y"].values))
    rows: dict[str, list[float]] = {"time": [], "off_law": [], "length": [], "period": []}
    reached = float(run["time"][-1])
    for begin in np.arange(0.0, reached - WINDOW + 1e-9, WINDOW):
        part = run.sel(time=slice(begin, begin + WINDOW))
        few = part.isel(time=slice(None, None, 50)).load()
        area = fourier.area(few["x"].values, few["y"].values)
        off = area - area_0 - (few["tension"] - float(first["tension"])).values / p.tension_rate
        rows["time"].append(float(begin + 0.5 * WINDOW))
        rows["off_law"].append(float(off[np.abs(off).argmax()]))
        rows["length"].append(float(part["length"].mean()))
        values = part["tension"].values
        rows["period"].append(exact.mean_period(part["time"].values, values))
    told = {"status": run.attrs["status"], "reached": reached, "seconds": seconds}
    run.close()
    return {**told, "options": OPTIONS[solver], **rows}


def drawn(content: dict[str, Any]) -> Figure:
    """Return the picture of what was recorded."""
    with paper_figure(PAGE, 4.6) as figure:
        axes = figure.subplots(3, 1, sharex=True)
        for solver, run in content["solvers"].items():
            label = f"{solver}, to $t$ = {run['reached']:g}"
            settled = np.array(run["time"]) > 100.0  # or the birth of the zigzag fills the panels
            when = np.array(run["time"])[settled]
            off = np.maximum(np.abs(np.array(run["off_law"])[settled]), 1e-16)
            axes[0].semilogy(when, off, color=COLOURS[solver], label=label)
            for ax, name in ((axes[1], "length"), (axes[2], "period")):
                values = np.array(run[name], dtype=float)[settled]
                ax.plot(when, values, color=COLOURS[solver])
        axes[2].axhline(exact.PERIODS[26, 600], color=GUIDE, linestyle="--", zorder=0)
        axes[0].set_ylabel("area off the\ntension law ($R_0^2$)")
        axes[1].set_ylabel("mean length\n($R_0$)")
        axes[2].set_ylabel("period of the\ntension ($1/k_\\mathrm{off}^0$)")
        axes[2].set_xlabel("time $t$ ($1/k_\\mathrm{off}^0$)")
        axes[0].legend(frameon=False, ncols=3, loc="lower center", bbox_to_anchor=(0.5, 1))
        for ax in axes:
            ax.spines[["top", "right"]].set_visible(False)
    return figure


def main() -> None:
    """Run, record and draw; or draw what is recorded."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    for solver in OPTIONS:
        parser.add_argument(f"--{solver}", type=float, default=10000.0, metavar="T_END")
    parser.add_argument("--output", type=Path, default=Path("benchmarks/results"))
    parser.add_argument("--draw", action="store_true", help="only draw what is recorded there")
    given = parser.parse_args()
    path = given.output / "invariants.json"
    if not given.draw:
        found = json.loads(path.read_text("utf-8"))["solvers"] if path.exists() else {}
        for solver in OPTIONS:
            until = getattr(given, solver)
            if not until:
                continue
            with tempfile.TemporaryDirectory() as folder:
                found[solver] = measured(solver, until, Path(folder) / "run.nc")
            told = {name: found[solver][name] for name in ("status", "reached", "seconds")}
            print(solver, told, max(map(abs, found[solver]["off_law"])), flush=True)
            machine.write(path, {"cell": list(CELL), "solvers": found})
    drawn(json.loads(path.read_text("utf-8"))).savefig(path.with_suffix(".png"), dpi=160)


if __name__ == "__main__":
    main()
