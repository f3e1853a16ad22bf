"""`cellcrawl bench`: the benchmarks, as tables, pictures and JSON."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from cellcrawl.command_line.options import make_folder, save_picture, say
from cellcrawl.validation import one_of

if TYPE_CHECKING:
    from cellcrawl.bench.references import References

_KINDS = (
    "work-precision",
    "targets",
    "long",
    "references",
    "scaling",
    "startup",
    "modes",
    "confidence",
    "microscope",
    "storage",
    "sweep",
)


@click.command()
@click.argument("kind", default="work-precision", metavar="[KIND]")
@click.option("--quick", is_flag=True, help="A part of it, in under two minutes.")
@click.option("--calibrate", is_flag=True, help="Of confidence: fit it anew first, and store it.")
@click.option(
    "--output",
    type=click.Path(path_type=Path, file_okay=False),
    metavar="DIR",
    help="Also write the results there, as JSON with machine and versions, and a picture.",
)
@click.option(
    "--references",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="True values that `bench references` recorded; computed anew unless given.",
)
def bench(
    kind: str, quick: bool, calibrate: bool, output: Path | None, references: Path | None
) -> int:
    """Measure accuracy and speed on this machine.

    \b
    KIND is one of
      work-precision  error against time of every solver (default)
      targets         the solver's targets at t = 2 and 5: accuracy, speed by ratios
      long            its targets for long runs: t = 100, 1000 and 10000, minutes of work
      references      the true values of ten cells, with a check by CVODE
      scaling         cost against nodes and against the length of the run
      startup         import, first and second start from the shell
      storage         size of a stored run, time to write and to read it
      sweep           scheduling, memory of the driver, workers
      modes           how often the classifier is right
      confidence      whether it is right as often as it says
      microscope      what comes back of runs and shapes seen in pixels

    Compare figures of one run only, and quote ratios: machines differ, and share their cores.
    CVODE takes part if scikit-sundae is installed, SciPy's solvers if SciPy is.

    \b
    Examples
      cellcrawl bench --quick
      cellcrawl bench targets --output benchmarks/results
      cellcrawl bench long --references benchmarks/results/references.json
    """
    from cellcrawl.bench import machine
    from cellcrawl.bench.references import References

    one_of("KIND", kind, _KINDS)
    if output is not None:
        make_folder(output)  # before measuring for minutes
    if calibrate:
        one_of("KIND with --calibrate", kind, ("confidence",))
    known = References(references)
    say(machine.describe(machine.record()))
    if calibrate:
        from cellcrawl.bench import confidence

        say(f"fitted   {confidence.calibrate()}")
    result = _MEASURE[kind](quick, known)
    if output is not None:
        machine.write(output / f"{kind}.json", result.data)
        if result.figure is not None:
            save_picture(result.figure, output / f"{kind}.png", 160)
        say(f"results  {output}")
    return 0


class _Result(NamedTuple):
    data: dict[str, Any]
    figure: Any


def _work_precision(quick: bool, known: References) -> _Result:
    from cellcrawl.bench import work_precision as wp

    rows: list[wp.Row] = []
    for row in _table(wp.Row, wp.measure(quick, known)):
        rows.append(row)
    ratios = []
    for case, t_end in dict.fromkeys((row.case, row.t_end) for row in rows):
        part = [row for row in rows if (row.case, row.t_end) == (case, t_end)]
        for solver in dict.fromkeys(row.solver for row in part if row.solver != "adaptive"):
            shown = {e: wp.speed_up(part, solver, e) for e in (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)}
            ratios.append({"case": case, "t_end": t_end, "solver": solver, "times": shown})
            values = "  ".join(f"{e:g}: {_times(ratio)}" for e, ratio in shown.items())
            say(f"{case}, t = {t_end:g}: adaptive is faster than {solver} at error {values}")
    return _Result({"rows": [row._asdict() for row in rows], "ratios": ratios}, wp.plot(rows))


def _targets(quick: bool, known: References) -> _Result:
    from cellcrawl.bench import reach

    rows = list(_table(reach.Target, reach.measure(quick, known)))
    return _Result({"targets": [row._asdict() for row in rows]}, None)


def _long(quick: bool, known: References) -> _Result:
    from cellcrawl.bench import long
    from cellcrawl.bench.reach import Target

    rows = []
    for row in _table(long.Row, long.errors_by_tolerance(quick, known)):
        rows.append(row)
    targets = list(_table(Target, long.measure(quick, known, rows)))
    amplified = list(_table(long.Amplified, long.amplification(quick)))
    data = {
        "targets": [row._asdict() for row in targets],
        "errors": [row._asdict() for row in rows],
        "amplified": [row._asdict() for row in amplified],
    }
    return _Result(data, None)


def _references(quick: bool, known: References) -> _Result:
    from cellcrawl.bench import references

    made = list(references.measure(quick))
    list(_table(references.Reference, (row for row, _ in made)))
    data = {
        "by": f"adaptive solver, rtol {references.RTOL:g}",
        "check": f"CVODE BDF+GMRES, {references.CHECK_NODES} nodes, rtol {references.CHECK_RTOL:g}",
        "references": [recorded for _, recorded in made],
    }
    return _Result(data, None)


def _scaling(quick: bool, known: References) -> _Result:
    from cellcrawl.bench import scaling

    nodes = list(_table(scaling.NodeCost, scaling.cost_of_nodes(quick)))
    streams = list(_table(scaling.Stream, scaling.cost_of_time(quick)))
    data = {"nodes": [r._asdict() for r in nodes], "streams": [r._asdict() for r in streams]}
    return _Result(data, scaling.plot(nodes, streams))


def _startup(quick: bool, known: References) -> _Result:
    from cellcrawl.bench import startup

    rows = list(_table(startup.Start, startup.measure(quick)))
    return _Result({"starts": [row._asdict() for row in rows]}, None)


def _modes(quick: bool, known: References) -> _Result:
    from cellcrawl.bench import modes

    kinds = list(_table(modes.Kind, modes.measure_kinds(quick)))
    tracks, right = (sum(getattr(row, name) for row in kinds) for name in ("tracks", "right"))
    say(f"{right} of {tracks} synthetic tracks named right ({right / tracks:.2%})")
    points = list(_table(modes.Point, modes.measure_points(quick)))
    data = {"kinds": [r._asdict() for r in kinds], "points": [r._asdict() for r in points]}
    return _Result(data, modes.plot())


def _confidence(quick: bool, known: References) -> _Result:
    from cellcrawl.bench import confidence

    together, apart = confidence.measure(quick)
    rows = list(_table(confidence.Reliability, [*together, *apart]))
    say(confidence.summary(rows))
    data = {"confidence": [r._asdict() for r in rows]}
    return _Result(data, confidence.plot(together, apart))


def _microscope(quick: bool, known: References) -> _Result:
    from cellcrawl.bench import microscope

    cells = list(_table(microscope.Seen, microscope.measure_cells(quick)))
    shapes = list(_table(microscope.Shape, microscope.measure_shapes(quick)))
    data = {"cells": [r._asdict() for r in cells], "shapes": [r._asdict() for r in shapes]}
    return _Result(data, None)


def _storage(quick: bool, known: References) -> _Result:
    from cellcrawl.bench import storage

    rows = list(_table(storage.Stored, storage.measure(quick)))
    return _Result({"stored": [row._asdict() for row in rows]}, None)


def _sweep(quick: bool, known: References) -> _Result:
    from cellcrawl.bench import sweeps

    rows = list(_table(sweeps.Figure, sweeps.measure(quick)))
    return _Result({"sweep": [row._asdict() for row in rows]}, None)


_MEASURE = {
    "modes": _modes,
    "confidence": _confidence,
    "microscope": _microscope,
    "work-precision": _work_precision,
    "targets": _targets,
    "long": _long,
    "references": _references,
    "scaling": _scaling,
    "startup": _startup,
    "storage": _storage,
    "sweep": _sweep,
}


def _table(kind: Any, rows: Iterable[Any]) -> Iterable[Any]:
    """Print rows as they come, under their names."""
    say("  ".join(kind._fields))
    for row in rows:
        say("  ".join(_cell(value) for value in row))
        sys.stdout.flush()
        yield row


def _times(ratio: float) -> str:
    return f"{ratio:.1f}x" if math.isfinite(ratio) else "not reached"


def _cell(value: Any) -> str:
    if isinstance(value, float):
        return "-" if math.isnan(value) else f"{value:.3g}"
    return str(value)
