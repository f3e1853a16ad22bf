"""Measure what a fit finds of fresh cells: recovery, coverage, calibration, alarms, a drug.

``python benchmarks/infer.py BANK [--cells 300] [--trials 100] [--workers 2]`` writes
``benchmarks/results/infer.json``. Fresh cells are new runs of the bank's prior, with other seeds;
pixels are those of `cellcrawl.observe`, not those that the bank is seen through.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

import cellcrawl as cc
from cellcrawl.bench import machine
from cellcrawl.infer import approximate, films
from cellcrawl.infer.cells import Cell, cells_of
from cellcrawl.infer.fitting import microscope_of
from cellcrawl.infer.microscope import summaries_of
from cellcrawl.infer.trained import Calibration, Trained, train

RESULTS = Path(__file__).parent / "results" / "infer.json"
TIME = (0.625, 1.6, "log")  # of 1/k_off0: as wide as the paper's prior, in its own unit
FRAME = 0.5
FRAMES = 75
CAMERAS = {
    "outlines, noise-free": (True, 0.0, 0.0),
    "track, noise-free": (False, 0.0, 0.0),
    "outlines, pixel 0.1, error 0.05": (True, 0.1, 0.05),
    "track, error 0.05": (False, 0.0, 0.05),
}


class Fresh:
    """A new run and the unit of time it is filmed in."""

    def __init__(self, run: Any, point: np.ndarray, unit: float, begin: float) -> None:
        self.run, self.point, self.unit, self.begin = run, point, unit, begin

    def cell(self, outlines: bool, pixel: float, error: float, seed: int) -> Cell:
        """Film it: FRAMES frames, FRAME apart in the unit of the film."""
        late = self.run.sel(time=slice(self.begin, None))
        late = late.assign_coords(time=(late["time"] - late["time"][0]) * self.unit + 1e3)
        until = late.sel(time=slice(None, 1e3 + FRAME * (FRAMES - 1) + 1e-9))
        if pixel > 0.0:
            (cell,) = cells_of(cc.observe(until, pixel=pixel, error=error, frame=FRAME, seed=seed))
            return cell
        at = until["time"].values[0] + FRAME * np.arange(FRAMES)
        even = until.interp(time=at, kwargs={"fill_value": "extrapolate"})
        (cell,) = cells_of(even)
        if error > 0.0:
            noise = np.random.default_rng(seed).standard_normal((2, len(cell.path))) * error
            cell = Cell(cell.name, cell.frame, cell.path + noise[0] + 1j * noise[1], cell.modes,
                        0.0, True)  # fmt: skip
        return cell if outlines else cell.track_alone()


def fresh(
    bank: Any, count: int, seed: int, change: dict[str, float] | None = None,
    fixed: np.ndarray | None = None, **world: Any,
) -> list[Fresh]:  # fmt: skip
    """Return new moving cells of the prior, or of one point, that live as long as the film."""
    found: list[Fresh] = []
    names = bank.prior.cell_names
    span = cc.infer.Range(*TIME)
    tried = 0
    while len(found) < count and tried < 20 * count:
        random = np.random.default_rng((seed, tried))
        tried += 1
        point = bank.prior.draw(range(tried, tried + 1), seed)[0] if fixed is None else fixed
        point = np.array(
            [p * (change or {}).get(n, 1.0) for n, p in zip(names, point, strict=True)]
        )
        unit = float(span.value(random.random())) if fixed is None else 1.0
        unit *= (change or {}).get("time_unit", 1.0)
        length = FRAME * (FRAMES - 1) / unit
        t_end = films.TRANSIENT + length + 2.0
        try:
            run = cc.simulate(
                cc.Parameters(**dict(zip(names, point, strict=True))), t_end,
                save_every=0.25, nodes=96,
                start=cc.RandomPerturbation(seed=int(random.integers(2**40))),
                **({} if "solver" in world else {"rtol": 1e-3}), **world,
            )  # fmt: skip
            one = Fresh(run, point, unit, films.TRANSIENT + 1.5 * random.random())
            if run.attrs["status"] == "completed":
                one.cell(True, 0.0, 0.0, 0)  # refuses a cell that rests
                found.append(one)
        except cc.InputError:
            continue
    return found


def posteriors(taught: Trained, cells: list[Cell]) -> tuple[np.ndarray, list[Any]]:
    """Return strangeness over the alarm's, and the posterior, of each cell."""
    away, found = [], []
    for cell in cells:
        film = cell.film(taught.microscope.usual_time, taught.microscope.usual_length)
        values = summaries_of(film, taught.microscope)[1]
        thought = taught.thought(values)
        away.append(taught.alarm.strangeness(thought, values)[0] / taught.alarm.threshold)
        found.append(approximate.posterior(taught.references, values[0], taught.width))
    return np.array(away), found


def calibration(taught: Trained, cells: list[Fresh], found: list[Any]) -> Calibration:
    """Return how posteriors of fresh cells stand to the truth."""
    ranges = taught.view.ranges
    truth = np.array(
        [[float(r.part(v)) for r, v in zip(ranges, (*c.point, c.unit), strict=True)] for c in cells]
    )
    mean = np.array([one.weight @ one.part for one in found])
    rank = np.array([one.weight @ (one.part < t) for one, t in zip(found, truth, strict=True)])
    return Calibration(taught.view.names, truth, mean, rank)


def described(one: Calibration) -> dict[str, Any]:
    """Return a calibration as plain values by parameter."""
    return {
        name: {
            "R2": round(float(one.recovered[i]), 4),
            "coverage": {f"{level:g}": round(float(c[i]), 4) for level, c in one.levels.items()},
            "rank p": round(float(one.evenness[i]), 4),
        }
        for i, name in enumerate(one.names)
    }


def drug(taught: Trained, bank: Any, trials: int, pool: int, seed: int) -> dict[str, Any]:
    """Name the parameter that a drug moved by a fifth, 20 cells a side, drawn from a pool."""
    names = taught.view.names
    fixed = np.array([26.0, 600.0, 0.06, 1e-3])
    outlines = taught.microscope.outlines
    pixel, error = taught.microscope.pixel, taught.microscope.error

    def fits(change: dict[str, float], first: int) -> list[Any]:
        cells = [c.cell(outlines, pixel, error, i) for i, c in
                 enumerate(fresh(bank, pool, first, change, fixed))]  # fmt: skip
        away, found = posteriors(taught, cells)
        return [
            cc.infer.Fit(cell, taught, np.empty(0), one, "abc", one, float(far))
            for cell, one, far in zip(cells, found, away, strict=True)
        ]

    control = fits({}, seed)
    right = {}
    random = np.random.default_rng(seed)
    for number, name in enumerate(names):
        treated = fits({name: 1.2}, seed + 1 + number)
        named = 0
        for _ in range(trials // len(names)):
            one = random.choice(len(control), 20, replace=len(control) < 20)
            other = random.choice(len(treated), 20, replace=len(treated) < 20)
            found = cc.infer.compare([control[i] for i in one], [treated[i] for i in other])
            named += found.likeliest == name
        right[name] = named / (trials // len(names))
    return {"right": right, "overall": float(np.mean(list(right.values()))), "pool": pool}


def main() -> None:
    """Measure and write."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bank", type=Path)
    parser.add_argument("--cells", type=int, default=300)
    parser.add_argument("--trials", type=int, default=100)
    parser.add_argument("--pool", type=int, default=60)
    parser.add_argument("--others", type=int, default=60)
    parser.add_argument("--cameras", type=int, default=len(CAMERAS))
    asked = parser.parse_args()
    bank = cc.infer.open_bank(asked.bank)
    began = time.perf_counter()
    cells = fresh(bank, asked.cells, 1000)
    result: dict[str, Any] = {
        "machine": machine.record(),
        "bank": {**bank.header, "outcomes": {}},
        "film": {"frame": FRAME, "frames": FRAMES, "time_unit": TIME},
        "cells": len(cells),
        "cameras": {},
    }  # fmt: skip
    for outcome in bank.outcomes.tolist():
        counted = result["bank"]["outcomes"]
        counted[outcome] = counted.get(outcome, 0) + 1
    for name, (outlines, pixel, error) in list(CAMERAS.items())[: asked.cameras]:
        at = time.perf_counter()
        films_ = [one.cell(outlines, pixel, error, i) for i, one in enumerate(cells)]
        cut, microscope = microscope_of(films_, bank, TIME, 1.0, pixel, error)
        taught = train(bank, microscope)
        away, found = posteriors(taught, cut)
        result["cameras"][name] = {
            "fresh": described(calibration(taught, cells, found)),
            "set apart": described(taught.calibration),
            "false alarms": round(float((away > 1).mean()), 4),
            "seconds": round(time.perf_counter() - at, 1),
        }
        print(name, json.dumps(result["cameras"][name]["fresh"]), flush=True)
        if name == "outlines, noise-free":
            result["alarms"] = alarms(taught, bank, asked.others)
            print(json.dumps(result["alarms"]), flush=True)
            result["drug"] = drug(taught, bank, asked.trials, asked.pool, 5000)
            print(json.dumps(result["drug"]), flush=True)
        result["seconds"] = round(time.perf_counter() - began, 1)
        with tempfile.NamedTemporaryFile("w", dir=RESULTS.parent, delete=False) as file:
            json.dump(result, file, indent=1)
            file.write("\n")
        Path(file.name).replace(RESULTS)


def alarms(taught: Trained, bank: Any, count: int) -> dict[str, float]:
    """Return how often the alarm is raised by cells of other laws and surroundings."""
    worlds: dict[str, dict[str, Any]] = {
        "catch bond": {"laws": cc.laws.CatchSlip(catch=5.0)},
        "few bonds": {"solver": "stochastic", "bonds": 2000.0},
        "patterned substrate": {"surroundings": cc.surroundings.Stripes(period=1.5, between=0.5)},
    }
    found = {}
    for number, (name, world) in enumerate(worlds.items()):
        try:
            others = fresh(bank, count, 3000 + number, **world)
        except (TypeError, cc.CellcrawlError) as error:
            found[name] = f"not measured: {error}"
            continue
        if not others:
            found[name] = "not measured: no such cell moved"
            continue
        away, _ = posteriors(taught, [one.cell(True, 0.0, 0.0, 0) for one in others])
        found[name] = round(float((away > 1).mean()), 3)
    return found


if __name__ == "__main__":
    main()
