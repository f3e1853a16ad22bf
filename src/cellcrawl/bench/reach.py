"""The solver's targets, each measured in this run: accuracy at two tolerances, speed by ratios."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from typing import NamedTuple

from cellcrawl.bench.cases import LAWS, POINTS, Case, errors
from cellcrawl.bench.references import References
from cellcrawl.bench.work_precision import prepare, timed, warm_up

_CRAWLERS = ((26, 600), (36, 560), (24, 540))


class Target(NamedTuple):
    """A figure asked for and the one measured."""

    what: str
    asked: str
    measured: str
    met: bool


def measure(quick: bool = False, references: References | None = None) -> Iterator[Target]:
    """Measure every target."""
    warm_up()
    references = references or References()
    yield from _accuracy(quick, references)
    yield from _speed(quick, references)


def _accuracy(quick: bool, references: References) -> Iterator[Target]:
    for rtol, limit in ((1e-4, 1e-4), (1e-7, 1e-6)):
        worst, where = 0.0, ""
        for point in POINTS[:2] if quick else POINTS:
            for law in LAWS:
                for t_end in (2.0, 5.0):
                    case = Case(*point, law, t_end=t_end)
                    found, _ = prepare("adaptive", case, rtol=rtol)()
                    miss = errors(found, references.of(case)).largest
                    if miss > worst:
                        worst, where = miss, f"{case.label}, t = {t_end:g}"
        yield Target(
            f"worst error at rtol {rtol:g}, t = 2 and 5",
            f"<= {limit:g}",
            f"{worst:.1e} at {where}",
            worst <= limit,
        )


def _speed(quick: bool, references: References) -> Iterator[Target]:
    t_end = 20.0 if quick else 100.0
    for law in LAWS:
        for point in _CRAWLERS[:1] if quick else _CRAWLERS:
            yield _against_published(Case(*point, law, t_end=t_end, random=True), 40.0, references)
        yield _against_published(Case(16, 600, law, t_end=t_end, random=True), 10.0, references)
    yield _against_refined(Case(26, 600, t_end=5.0), references)
    for law, limit in (("printed", 0.12), ("consistent", 0.2)):
        case = Case(26, 600, law, t_end=100.0, random=True)
        _, seconds, _ = timed(partial(prepare, "adaptive", case))
        yield Target(
            f"{case.label}, t = 0...100, default tolerance, one core",
            f"<= {limit:g} s",
            f"{seconds:.3f} s",
            seconds <= limit,
        )


def _against_published(case: Case, asked: float, references: References) -> Target:
    """Time to t_end against the paper's scheme as published, and both errors at t = 5."""
    _, fast, _ = timed(partial(prepare, "adaptive", case))
    _, slow, _ = timed(partial(prepare, "paper", case))
    early = Case(case.r_on, case.zeta_1, case.elasticity, t_end=5.0, random=case.random)
    truth = references.of(early)
    ours, theirs = (
        errors(prepare(name, early)()[0], truth).largest for name in ("adaptive", "paper")
    )
    ratio = slow / fast
    return Target(
        f"speed against the paper's scheme as published, {case.label}, t = 0...{case.t_end:g}",
        f">= {asked:g}x at a smaller error",
        f"{ratio:.0f}x ({fast:.3f} against {slow:.2f} s; errors at t = 5: "
        f"{ours:.1e} against {theirs:.1e})",
        ratio >= asked and ours <= theirs,
    )


def _against_refined(case: Case, references: References) -> Target:
    """Time against the paper's scheme refined until its error is 1e-4 too."""
    truth = references.of(case)
    _, fast, _ = timed(partial(prepare, "adaptive", case))
    nodes, dt, miss, slow = 2000, 1e-3, math.inf, math.nan
    while miss > 1e-4 and dt > 1e-6:
        found, slow, _ = timed(partial(prepare, "paper", case, nodes=nodes, dt=dt))
        miss = errors(found, truth).largest
        dt /= max(2.0, min(miss / 1e-4, 8.0))
    return Target(
        f"speed against the paper's scheme refined to 1e-4, {case.label}, t = 5",
        ">= 500x",
        f"{slow / fast:.0f}x ({fast:.4f} against {slow:.1f} s at error {miss:.1e})",
        slow / fast >= 500.0,
    )
