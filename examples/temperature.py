"""Heat a cell through its motility modes, at fixed temperatures and while it crawls.

Makes the pictures of the documentation:

    python examples/temperature.py docs/images/temperature
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

import cellcrawl as cc
from cellcrawl.plot.colouring import shared_bar
from cellcrawl.plot.style import paper_figure

CELSIUS = (5, 10, 15, 20, 25, 30, 35)
# at 25 degrees Celsius (33, 560); heat raises r_on, as binding has the higher activation energy
CELL = cc.PhysicalParameters(on_rate=3.3, adhesive_friction=560 * 200.0)
LIMITS = (0.1, 0.8)  # of the colours of the bound fraction, in all panels
ENERGIES = cc.ActivationEnergies(on_rate=75e3, off_rate=50e3)


def kelvin(celsius: float) -> float:
    return celsius + 273.15


def at(celsius: float) -> cc.Parameters:
    """The cell's dimensionless parameters at a temperature."""
    return CELL.at_temperature(kelvin(celsius), ENERGIES).dimensionless()


def walk(seed: int = 1, t_end: float = 100.0) -> dict[int, xr.Dataset]:
    """Let the cell crawl at each temperature, each time from a round start."""
    start = cc.RandomPerturbation(seed=seed)
    return {celsius: cc.simulate(at(celsius), t_end, start=start) for celsius in CELSIUS}


def heating(minutes: float = 40.0, hold: float = 5.0) -> tuple[cc.Schedule, float, np.ndarray]:
    """Warm the cell evenly from the lowest to the highest temperature, with a pause at both ends.

    Returns the schedule, the time at its end, and the temperatures (time, celsius) on the way. The
    unit of time, 1/k_off0, shrinks on the way: dimensionless time is the integral of k_off0.
    """
    seconds = 60.0 * np.concatenate([[0.0], hold + np.linspace(0.0, minutes, 61)])
    celsius = np.interp(seconds, [60.0 * hold, 60.0 * (hold + minutes)], [CELSIUS[0], CELSIUS[-1]])
    rates = np.array([CELL.at_temperature(kelvin(c), ENERGIES).off_rate for c in celsius])
    steps = 0.5 * (rates[1:] + rates[:-1]) * np.diff(seconds)
    times = np.concatenate([[0.0], np.cumsum(steps)])
    cells = [at(c) for c in celsius]
    changing = ("r_on", "zeta_1", "D", "epsilon", "sigma_c", "k_sigma", "r_p")
    points = {
        name: [(t, getattr(cell, name)) for t, cell in zip(times, cells, strict=True)]
        for name in changing
    }
    end = float(times[-1]) + 60.0 * hold * float(rates[-1])
    return cc.Schedule(points), end, np.column_stack([times, celsius])


def draw_walk(runs: dict[int, xr.Dataset]) -> Figure:
    """Draw the path at each temperature, and r_on against temperature."""
    with paper_figure(7.2, 4.2) as figure:
        _draw_panels(figure, runs)
    return figure


def _draw_panels(figure: Figure, runs: dict[int, xr.Dataset]) -> None:
    axes = figure.subplots(2, 4).ravel()
    for (celsius, run), ax in zip(runs.items(), axes, strict=False):
        cc.plot.path(run, every=10, ax=ax, limits=LIMITS, colorbar=False)
        mode = cc.classify(run).mode
        ax.set_title(
            f"{celsius} °C, $r_\\mathrm{{on}}$ = {at(celsius).r_on:.1f}\n{mode}", loc="left"
        )
    shared_bar(axes[:4].tolist(), run, "bound_fraction", LIMITS)
    fine = np.linspace(CELSIUS[0], CELSIUS[-1], 61)
    axes[-1].plot(fine, [at(c).r_on for c in fine], color="#222222", lw=1)
    axes[-1].plot(CELSIUS, [at(c).r_on for c in CELSIUS], "o", color="#0072b2", ms=4)
    axes[-1].set_xlabel("temperature (°C)")
    axes[-1].set_ylabel("$r_\\mathrm{on}$")
    axes[-1].spines[["top", "right"]].set_visible(False)


def draw_heating(run: xr.Dataset, temperatures: np.ndarray) -> Figure:
    """Draw the path of the cell that is heated, with its temperature and its heading over time."""
    with paper_figure(7.2, 3.2) as figure:
        _draw_both(figure, run, temperatures)
    return figure


def _draw_both(figure: Figure, run: xr.Dataset, temperatures: np.ndarray) -> None:
    left, right = figure.subplots(1, 2)
    cc.plot.path(run, every=10, ax=left, limits=LIMITS)
    heading = cc.observables.heading(run).sel(time=slice(5, None))
    right.plot(heading.time, heading, color="#b5338a", lw=1)
    right.set_xlabel("time $t$ ($1/k_\\mathrm{off}^0$ of the moment)")
    right.set_ylabel("heading (rad)", color="#b5338a")
    warm = right.twinx()
    times = [*temperatures[:, 0], float(run.time[-1])]
    warm.plot(times, [*temperatures[:, 1], temperatures[-1, 1]], color="#d55e00", lw=1)
    warm.set_ylabel("temperature (°C)", color="#d55e00")
    for ax in (right, warm):
        ax.spines["top"].set_visible(False)


def main(folder: Path) -> None:
    """Draw both, and say what the cell does at each temperature."""
    folder.mkdir(parents=True, exist_ok=True)
    runs = walk()
    for celsius, run in runs.items():
        found = cc.classify(run)
        warm = CELL.at_temperature(kelvin(celsius), ENERGIES)
        late = run.sel(time=slice(20, None))
        speed = warm.scales.to_physical(float(cc.observables.speed(late).mean()), "velocity")
        print(
            f"{celsius:2d} °C: r_on = {at(celsius).r_on:4.1f}, r_p = {at(celsius).r_p:.1f}, "
            f"{found.mode} ({found.summary()}), {1e6 * speed:.3f} um/s"
        )
    draw_walk(runs).savefig(folder / "walk.png", dpi=200)
    schedule, t_end, temperatures = heating()
    run = cc.simulate(at(CELSIUS[0]), t_end, schedule=schedule)
    draw_heating(run, temperatures).savefig(folder / "heating.png", dpi=200)
    print(f"heated while it crawls: {run.attrs['status_message']}")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "temperature"))
