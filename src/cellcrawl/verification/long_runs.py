"""Long runs: the shape keeps the tension law and stays closed, and cells end in exact states."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final, NamedTuple

from cellcrawl.bench import exact
from cellcrawl.bench.cases import LAWS
from cellcrawl.verification.check import Result, at_most, near

Cell = tuple[float, float, str]


class _Lawful(NamedTuple):
    """How a solver is run for long, to when, and how far off the law its shape may then be.

    ``area`` allows for how well the output nodes tell an area: it must not grow with the run.
    """

    options: dict[str, Any]
    t_end: float
    longer: float
    area: float
    gap: float


# Coarse, where errors are large: the law must hold all the same.
_LAWFUL: Final = {
    "adaptive": _Lawful({"rtol": 1e-4, "nodes": 1024}, 1000.0, 10000.0, 1e-4, 1e-4),
    "paper": _Lawful({"nodes": 200, "dt": 1e-3}, 1000.0, 2000.0, 1e-4, 1e-8),
    "spline": _Lawful({"nodes": 96, "dt": 5e-3}, 1000.0, 2000.0, 2e-4, 2e-4),
}
_CELLS: Final = {
    "adaptive": ((26, 600), (16, 600), (24, 540), (36, 560), (56, 560)),
    "paper": ((26, 600),),
    "spline": ((26, 600),),
}
_RTOL: Final = 1e-4


def law_in(solver: str, full: bool) -> Iterator[Result]:
    """Measure area against tension and closure of the shape itself over a long run."""
    how = _LAWFUL[solver]
    for point in _CELLS[solver]:
        for law in LAWS if full else LAWS[:1]:
            longer = full and point == (26, 600) and law == LAWS[0]
            t_end = how.longer if longer else how.t_end
            options = dict(how.options)
            if solver == "paper" and law == "consistent":
                options["dt"] = 3e-4
            run, p = exact.lawful_run(solver, (*point, law), t_end, **options)
            exact.completed(run)
            told = f"{solver} solver, {point}, {law}, t = 0 to {t_end:g}"
            yield at_most(
                f"area of the points against the tension law, {told}",
                exact.off_law(run, p),
                how.area,
            )
            yield at_most(
                f"gap in the edge over its length, from its tangents, {told}",
                exact.gap(run),
                how.gap,
            )


def states(full: bool) -> Iterator[Result]:
    """Measure gliding cells at the end of a long run against an independent continuation."""
    for cell, t_end in (((16, 600, "printed"), 1500.0), ((56, 560, "printed"), 400.0)):
        true, found = exact.GLIDES[cell], exact.glide(cell, t_end, rtol=_RTOL)
        told = f"of the gliding cell {cell[:2]}, t = {t_end:g}, rtol {_RTOL:g}"
        for name in ("speed", "length", "tension", "circularity"):
            value = getattr(true, name)
            if value == value:
                within = 10.0 * _RTOL * value
                yield near(f"{name} {told}", getattr(found, name), value, within)


def periods(full: bool) -> Iterator[Result]:
    """Measure the periods of zigzag and rotation against independent periodic orbits."""
    for point, period in exact.PERIODS.items():
        found = exact.tension_period(point, rtol=_RTOL)
        yield near(
            f"period of the tension at {point}, t = 150 to 600, rtol {_RTOL:g}",
            found,
            period,
            10.0 * _RTOL * period,
        )
