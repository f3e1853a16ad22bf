"""The parts of `infer.py`: what each measures of fresh cells, as plain values for its record."""

from __future__ import annotations

import functools
import json
import time
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from infer_cells import (
    CAMERAS,
    MICROSCOPES,
    TIME,
    Camera,
    Fresh,
    at_points,
    described,
    filmed,
    fresh,
)

import cellcrawl as cc
from cellcrawl.infer import fitting
from cellcrawl.infer.cells import Cell
from cellcrawl.infer.trained import Calibration, Trained, train

CHANGES = (1.2, 1.0 / 1.2)
TREATED = 20


class Asked(Protocol):
    """What the command line of `infer.py` was asked for."""

    bank: Path
    cells: int
    others: int
    points: int
    other: list[Path]


class Measuring:
    """A bank, and what is made once for several parts."""

    def __init__(self, asked: Asked) -> None:
        self.asked = asked
        self.bank = cc.infer.open_bank(asked.bank)

    @functools.cached_property
    def cells(self) -> list[Fresh]:
        """Fresh cells of the prior."""
        return fresh(self.bank, self.asked.cells, 1000, Camera())

    @functools.cache  # noqa: B019
    def taught(self, camera: Camera) -> Trained:
        """Return the bank seen through a camera."""
        cell = self.cells[0].cell(camera)
        assert cell is not None
        return taught_for(self.bank, [cell], camera)

    def found(self, taught: Trained, cells: list[Cell]) -> tuple[np.ndarray, list[Any]]:
        """Return strangeness over the alarm's, and the fit, of each cell."""
        fits = [fitting._fit(cell, taught, "abc", None) for cell in cells]
        return np.array([one.strangeness for one in fits]), fits


def taught_for(
    bank: Any, cells: list[Cell], camera: Camera, looks: int = 3, seed: int = 0
) -> Trained:
    """Return what a bank teaches of such cells."""
    _, microscope = fitting.microscope_of(cells, bank, TIME, 1.0, camera.pixel, camera.error)
    return train(bank, microscope, looks, seed)


def calibration(taught: Trained, cells: list[Fresh], found: list[Any]) -> Calibration:
    """Return how posteriors of fresh cells stand to the truth."""
    ranges = taught.view.ranges
    truth = np.array(
        [[float(r.part(v)) for r, v in zip(ranges, (*c.point, c.unit), strict=True)] for c in cells]
    )
    posterior = [one.samples for one in found]
    mean = np.array([one.weight @ one.part for one in posterior])
    rank = np.array([one.weight @ (one.part < t) for one, t in zip(posterior, truth, strict=True)])
    return Calibration(taught.view.names, truth, mean, rank)


def cameras(at: Measuring) -> dict[str, Any]:
    """Recovery, coverage, ranks and false alarms through each camera."""
    result = {}
    for name, camera in CAMERAS.items():
        began = time.perf_counter()
        taught = at.taught(camera)
        seconds = time.perf_counter() - began
        away, found = at.found(taught, filmed(at.cells, camera))
        result[name] = {
            "fresh": described(calibration(taught, at.cells, found)),
            "set apart": described(taught.calibration),
            "cells": len(found),
            "false alarms": round(float((away > 1).mean()), 4),
            "seconds of training": round(seconds, 1),
        }
        print(name, json.dumps(result[name]), flush=True)
    return result


def alarms(at: Measuring) -> dict[str, Any]:
    """How often the alarm is raised by cells of other laws and surroundings."""
    worlds: dict[str, dict[str, Any]] = {
        **{
            f"catch bond, catch = {catch:g}": {"laws": cc.laws.CatchSlip(catch=catch)}
            for catch in (5.0, 20.0, 40.0)
        },
        "few bonds, 2000 a length": {"solver": "stochastic", "bonds": 2000.0},
        "patterned substrate": {"surroundings": cc.surroundings.Stripes(period=1.5, between=0.5)},
    }
    result: dict[str, Any] = {}
    for number, (name, world) in enumerate(worlds.items()):
        others = fresh(at.bank, at.asked.others, 3000 + number, Camera(), **world)
        told: dict[str, Any] = {"cells": len(others)}
        for which in list(CAMERAS)[:3]:
            if others:
                camera = CAMERAS[which]
                away, _ = at.found(at.taught(camera), filmed(others, camera))
                told[which] = round(float((away > 1).mean()), 3)
        result[name] = told
        print(name, json.dumps(told), flush=True)
    return result


def drug(at: Measuring) -> dict[str, Any]:
    """Name the parameter that a drug moved by a fifth, 20 cells a side, from points drawn anew."""
    camera = Camera(frame=0.5)
    taught = at.taught(camera)
    names = taught.view.names
    random = np.random.default_rng(77)
    low, high = np.array([18.0, 540.0, 0.03, 7e-4]), np.array([33.0, 625.0, 0.13, 1.4e-3])
    trials: list[dict[str, Any]] = []

    def fits(point: np.ndarray, unit: float, seed: int) -> list[Any]:
        cells = at_points(at.bank, TREATED, seed, camera, lambda _: point, unit)
        return at.found(taught, filmed(cells, camera))[1]

    for place in range(at.asked.points):
        point = low + (high - low) * random.random(4)
        control = fits(point, 1.0, 5000 + 100 * place)
        for number, name in enumerate(names):
            for way, factor in enumerate(CHANGES):
                moved = point * np.where(np.array(names[:-1]) == name, factor, 1.0)
                unit = factor if name == names[-1] else 1.0
                treated = fits(moved, unit, 5000 + 100 * place + 1 + 2 * number + way)
                if min(len(control), len(treated)) < TREATED:
                    continue
                found = cc.infer.compare(control, treated)
                interval = found.factor(name)
                trials.append(
                    {
                        "moved": name,
                        "by": round(factor, 4),
                        "named": found.likeliest,
                        "found": [round(float(v), 4) for v in interval],
                    }
                )
        print(place, len(trials), np.mean([t["moved"] == t["named"] for t in trials]), flush=True)
    right = {
        n: round(float(np.mean([t["named"] == n for t in trials if t["moved"] == n])), 3)
        for n in names
    }
    held = {
        n: round(
            float(
                np.mean(
                    [t["found"][1] < t["by"] < t["found"][2] for t in trials if t["moved"] == n]
                )
            ),
            3,
        )
        for n in names
    }
    overall = float(np.mean([t["named"] == t["moved"] for t in trials]))
    return {
        "trials": len(trials), "points": at.asked.points, "cells a side": TREATED, "right": right,
        "overall": round(overall, 3), "90 % intervals of the factor that hold it": held,
    }  # fmt: skip


def methods(at: Measuring) -> dict[str, Any]:
    """How often the means of ABC and of the neural posterior are within a standard deviation."""
    from cellcrawl.infer import neural

    result: dict[str, Any] = {}
    for name in list(CAMERAS)[:1] + list(CAMERAS)[2:3]:
        camera = CAMERAS[name]
        taught = at.taught(camera)
        began = time.perf_counter()
        estimate = neural.train_estimate(taught)
        seconds = time.perf_counter() - began
        cells = filmed(at.cells, camera)
        found = [fitting._fit(cell, taught, "npe", estimate) for cell in cells]
        apart = np.array([[n in one.disagreement for n in one.names] for one in found])
        result[name] = {
            "fresh": described(calibration(taught, at.cells, found)),
            "within one standard deviation": {
                n: round(float(1.0 - apart[:, i].mean()), 4)
                for i, n in enumerate(taught.view.names)
            },
            "all of them": round(float(1.0 - apart.any(axis=1).mean()), 4),
            "seconds of training": round(seconds, 1),
        }
        print(name, json.dumps(result[name]), flush=True)
    return result


def again(at: Measuring) -> dict[str, Any]:
    """How often the means of two trainings of ABC are within a standard deviation."""
    name = next(iter(CAMERAS))
    camera = CAMERAS[name]
    cells = filmed(at.cells, camera)
    first = at.found(at.taught(camera), cells)[1]
    second = at.found(taught_for(at.bank, cells[:1], camera, seed=1), cells)[1]
    apart = np.array(
        [
            np.abs(a.mean - b.mean) / np.minimum(a.spread, b.spread)
            for a, b in zip(first, second, strict=True)
        ]
    )
    told = np.round((apart <= 1.0).mean(axis=0), 4).tolist()
    return {name: dict(zip(first[0].names, told, strict=True))}


def choice(at: Measuring) -> dict[str, Any]:
    """How often the law of a cell is taken for another, by banks of both."""
    result = {}
    for path in at.asked.other:
        other = cc.infer.open_bank(path)
        for name in list(CAMERAS)[:3]:
            cell = at.cells[0].cell(CAMERAS[name])
            found = cc.infer.choose(
                cell, [at.bank, other], time_unit=TIME, length_unit=1.0,
                pixel=CAMERAS[name].pixel, error=CAMERAS[name].error,
            )  # fmt: skip
            ranges = other.prior.ranges.items()
            own = [f"{n[5:]} {r.low:g} to {r.high:g}" for n, r in ranges if n.startswith("laws.")]
            law = ", ".join([type(other.law).__name__, *own, f"{len(other):,} runs"])
            result[f"{law}: {name}"] = {
                "error rate": round(found.error_rate, 4),
                "confusion": np.round(found.confusion, 3).tolist(),
            }
            print(law, name, found.error_rate, flush=True)
    return result


def microscope(at: Measuring) -> dict[str, Any]:
    """R² of each parameter, of runs set apart, by what the microscope delivers."""
    result = {}
    for name, camera in MICROSCOPES.items():
        cell = at.cells[0].cell(camera)
        assert cell is not None
        taught = taught_for(at.bank, [cell], camera, 1)
        found = taught.calibration.recovered
        result[name] = {
            n: round(float(v), 3) for n, v in zip(taught.view.names, found, strict=True)
        }
        print(name, result[name], flush=True)
    return result


PARTS = {
    "cameras": cameras,
    "alarms": alarms,
    "drug": drug,
    "methods": methods,
    "again": again,
    "choice": choice,
    "microscope": microscope,
}
