"""What is promised of long runs, each measured in this run: errors, invariants, exact states."""

from __future__ import annotations

import math
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from cellcrawl.bench import exact, rivals
from cellcrawl.bench.cases import LAWS, LONG, POINTS, Case, check_start, errors, sampled
from cellcrawl.bench.reach import Target
from cellcrawl.bench.references import References
from cellcrawl.bench.work_precision import Solve, prepare, prepare_rival, timed, warm_up
from cellcrawl.parameters import Parameters
from cellcrawl.solvers import SOLVERS
from cellcrawl.solvers.conditions import Conditions
from cellcrawl.starts import PerturbedCircle

T_END: Final = 2.0 * LONG
TOLERANCES: Final = (1e-3, 1e-4, 1e-5, 1e-6)
_FAR: Final = {(36, 560): 20.0}
"""Errors of the centroid let grow beyond ten times rtol, where the model itself amplifies them."""
_CHANGE: Final = 1e-5  # of the bound fraction at the start
_EXACT: Final = 1e-7
_ERROR: Final = 1e-3  # at which times are compared
_TURNS: Final = 4  # more of each run, for other work on the machine only adds to a time
_AGAINST_CVODE: Final = ((26, 600), (16, 600), (24, 540))
_TRIED: Final = (5e-4, 3e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5)  # for the fastest run with that error
_GRIDS: Final = tuple((nodes, rtol) for nodes in (256, 320, 384, 448, 512) for rtol in (1e-6, 1e-7))
_STREAM: Final = """
import resource, sys
import cellcrawl as cc
from cellcrawl.bench.exact import off_law
t_end, p = float(sys.argv[2]), cc.Parameters(r_on=26)
run = cc.simulate(p, t_end, output=sys.argv[1], save_every=t_end / 1000, nodes=512)
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
peak /= 1024 if sys.platform != "darwin" else 1024**2
print(peak, off_law(run.isel(time=slice(None, None, 10)).load(), p), run.attrs["status"])
"""


class Row(NamedTuple):
    """One run to t = 100: largest errors over its second half, in units of rtol, and its cost."""

    case: str
    rtol: float
    length: float
    tension: float
    area: float
    centroid: float
    error: float
    """The larger of length and centroid, as it is."""
    seconds: float
    nodes: int


def errors_by_tolerance(quick: bool, references: References) -> Iterator[Row]:
    """Run every cell at every tolerance."""
    warm_up()
    for point in POINTS[:1] if quick else POINTS:
        for law in LAWS:
            case = Case(*point, law, t_end=T_END)
            truth = references.of(case)
            for rtol in TOLERANCES[:2] if quick else TOLERANCES:
                found, seconds, nodes = timed(partial(prepare, "adaptive", case, rtol=rtol))
                miss = errors(found, truth)
                length, tension, area, centroid = (value / rtol for value in miss)
                yield Row(
                    case.label,
                    rtol,
                    length,
                    tension,
                    area,
                    centroid,
                    miss.largest,
                    seconds,
                    nodes,
                )


class Amplified(NamedTuple):
    """By how much the model itself magnifies a small change of a cell's start."""

    case: str
    wave: int
    """Of the bound fraction, around the cell, that is changed by 1e-5."""
    early: float
    """Distance of the centroid at t = 5, over the change."""
    late: float
    """The largest over t = 50 to 100."""


def amplification(quick: bool) -> Iterator[Amplified]:
    """Run pairs of cells whose starts differ by a wave of 1e-5."""
    for point in POINTS[:1] if quick else POINTS:
        p = Parameters(r_on=point[0], zeta_1=point[1])
        plain = _centroids(p, check_start(p))
        for wave in (1, 3):
            start = check_start(p)
            a, b = start.bound_fraction.get(wave, (0.0, 0.0))
            changed = {**start.bound_fraction, wave: (a + _CHANGE, b)}
            other = _centroids(p, PerturbedCircle(start.radius, changed))
            away = np.hypot(*(other - plain).T) / _CHANGE
            yield Amplified(Case(*point).label, wave, float(away[0]), float(away[1:].max()))


def _centroids(parameters: Parameters, start: PerturbedCircle) -> np.ndarray:
    """Return the centroid at t = 5 and at the times of a long run, shape (times, 2)."""
    scheme = SOLVERS["adaptive"]
    state = start.state(parameters, scheme.start_nodes(256, rtol=_EXACT))
    solver = scheme(state, Conditions(parameters), nodes=256, rtol=_EXACT)
    return sampled(solver, (5.0, *Case(26, 600, t_end=T_END).times))[:, 3:]


def measure(quick: bool, references: References, rows: list[Row]) -> Iterator[Target]:
    """Measure every target; ``rows`` are those of `errors_by_tolerance`."""
    yield from _errors(rows)
    yield _law(quick)
    yield from _states(quick)
    yield _at_true_error(references)
    yield from _against_cvode(quick, references)
    yield from _streams(quick)


def _errors(rows: list[Row]) -> Iterator[Target]:
    for point in POINTS:
        mine = [row for row in rows if row.case.startswith(f"({point[0]:g}, {point[1]:g})")]
        for name, limit in (("length", 10.0), ("centroid", _FAR.get(point, 10.0))):
            found = [(getattr(row, name), row.case, row.rtol) for row in mine]
            if not found:
                continue
            value, case, rtol = max(found)
            yield Target(
                f"error of the {name}, t = {LONG:g} to {T_END:g}, {point}, both laws, "
                f"rtol {max(TOLERANCES):g} to {min(TOLERANCES):g}",
                f"<= {limit:g} rtol",
                f"{value:.2g} rtol at {case}, rtol {rtol:g}",
                value <= limit,
            )


def _law(quick: bool) -> Target:
    t_end = 100.0 if quick else 1000.0
    worst, where = 0.0, ""
    for point in POINTS[:1] if quick else POINTS:
        for law in LAWS:
            cell = (*point, law)
            run, p = exact.lawful_run("adaptive", cell, t_end, rtol=1e-4, nodes=1024)
            off = exact.off_law(run, p) if run.attrs["status"] == "completed" else math.inf
            if off >= worst:
                worst, where = off, f"{point}, {law}: {run.attrs['status']}"
    return Target(
        f"area of the shape against the tension law, rtol 1e-4, t = 0 to {t_end:g}",
        "<= 1e-4",
        f"{worst:.1e} at {where}",
        worst <= 1e-4,
    )


def _states(quick: bool) -> Iterator[Target]:
    """Compare speed and length of the glider, and the two periods, with exact ones."""
    t_end = 200.0 if quick else 1500.0
    for law in LAWS[:1] if quick else LAWS:
        true = exact.GLIDES[16, 600, law]
        for rtol in TOLERANCES[1:2] if quick else TOLERANCES:
            found = exact.glide((16, 600, law), t_end, rtol=rtol)
            for name in ("speed", "length"):
                off = abs(getattr(found, name) / getattr(true, name) - 1.0) / rtol
                told = f"{name} of the glider (16, 600) {law} at t = {t_end:g}, rtol {rtol:g}"
                yield Target(told, "<= 10 rtol", f"{off:.2g} rtol", off <= 10.0)
    for point, period in exact.PERIODS.items():
        for rtol in TOLERANCES[1:2] if quick else TOLERANCES[:3]:
            found_period = exact.tension_period(point, 150.0 if quick else 600.0, rtol=rtol)
            off = abs(found_period / period - 1.0) / rtol
            told = f"period of the tension at {point}, rtol {rtol:g}"
            yield Target(told, "<= 10 rtol", f"{off:.2g} rtol", off <= 10.0)


def _at_true_error(references: References) -> Target:
    case = Case(26, 600, t_end=T_END)
    seconds, setting = _fastest(_ours(case), references.of(case))
    return Target(
        f"time at (26, 600), t = 0 to {T_END:g}, for a true error of at most {_ERROR:g}",
        "<= 60 ms",
        _took(seconds, setting),
        seconds <= 0.06,
    )


def _against_cvode(quick: bool, references: References) -> Iterator[Target]:
    """Compare the fastest runs of both whose true error is at most 1e-3."""
    name = "CVODE BDF+GMRES"
    solve = rivals.available().get(name)
    if solve is None:
        return
    for point in _AGAINST_CVODE[:1] if quick else _AGAINST_CVODE:
        case = Case(*point, t_end=T_END)
        truth = references.of(case)
        ours, setting = _fastest(_ours(case), truth)
        tried = {
            f"{nodes} nodes, rtol {rtol:g}": partial(prepare_rival, solve, case, nodes, rtol)
            for nodes, rtol in (_GRIDS[-1:] if quick else _GRIDS)
        }
        theirs, their_setting = _fastest(tried, truth)
        ratio = theirs / ours if math.isfinite(ours) else 0.0
        times = f"{ratio:.1f}x" if math.isfinite(ratio) else "alone"
        yield Target(
            f"speed against {name}, true error at most {_ERROR:g}, {point}, t = 0 to {T_END:g}",
            ">= 8x",
            f"{times} ({_took(ours, setting)}; {_took(theirs, their_setting)})",
            ratio >= 8.0,
        )


def _ours(case: Case) -> dict[str, Callable[[], Solve]]:
    """Return runs of the adaptive solver at several tolerances, by name."""
    return {f"rtol {rtol:g}": partial(prepare, "adaptive", case, rtol=rtol) for rtol in _TRIED}


def _took(seconds: float, setting: str) -> str:
    return (
        f"{1e3 * seconds:.0f} ms at {setting}" if math.isfinite(seconds) else "does not get there"
    )


def _fastest(settings: Mapping[str, Callable[[], Solve]], truth: np.ndarray) -> tuple[float, str]:
    """Return the least of some times, and the setting, of those whose error is small enough."""
    best, where = math.inf, ""
    for name, prepared in settings.items():
        found, seconds, _ = timed(prepared)
        if errors(found, truth).largest <= _ERROR:
            seconds = min(seconds, *(timed(prepared)[1] for _ in range(_TURNS)))
            if seconds < best:
                best, where = seconds, name
    return best, where


def _streams(quick: bool) -> Iterator[Target]:
    """Write runs of two lengths to disk: is the law kept, is memory flat."""
    peaks = {}
    for t_end in (100.0, 200.0) if quick else (1000.0, 10000.0):
        with tempfile.TemporaryDirectory() as folder:
            command = [sys.executable, "-c", _STREAM, str(Path(folder) / "run.nc"), str(t_end)]
            said = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        peak, off, status = said.split()
        peaks[t_end] = float(peak)
        yield Target(
            f"area of the shape against the tension law, (26, 600), t = 0 to {t_end:g}, on disk",
            "<= 1e-4, completed",
            f"{float(off):.1e}, {status}",
            float(off) <= 1e-4 and status == "completed",
        )
    short, long = peaks
    yield Target(
        f"peak memory of t = 0 to {long:g} over that of {short:g}, as many records",
        "<= 1.05",
        f"{peaks[long] / peaks[short]:.3f} ({peaks[long]:.0f} MB)",
        peaks[long] <= 1.05 * peaks[short],
    )
