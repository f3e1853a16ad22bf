"""`cellcrawl branches`: gliding and turning cells followed, and where they lose their hold."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cellcrawl.command_line.look import Look, look_options
from cellcrawl.command_line.main import CANCELLED, RUN_FAILED
from cellcrawl.command_line.options import (
    cannot_write,
    make_folder,
    parameter_options,
    save_picture,
    say,
)
from cellcrawl.errors import InputError
from cellcrawl.parameters import Parameters

if TYPE_CHECKING:
    from cellcrawl.branches import Branch, OrbitBranch, PointCurve, SpecialPoint

_USUAL = Parameters(zeta_1=560.0)
_COLUMNS = ("kind", "symmetry", "r_on", "zeta_1", "frequency", "speed", "turning_rate", "tension")
_GLIDING, _TURNING = "gliding", "turning"
_SETTLED = 150.0  # time after which a run is on its orbit
_NODES, _MOST = 256, 12


@click.command()
@click.option(
    "--at-zeta-1",
    "several",
    metavar="V1,V2,...",
    help="Several values of zeta_1, a branch each, as in 540,560,580,600.",
)
@click.option(
    "--to", type=float, default=10.0, show_default=True, metavar="NUMBER", help="Last r_on."
)
@click.option("--turning", is_flag=True, help="Follow turning cells too, from their pitchfork.")
@click.option(
    "--orbits",
    metavar="R1,R2,...",
    help="Follow zigzags and rotations too, from runs at these r_on, both ways; with --turning "
    "also the wobbles that turning cells begin.",
)
@click.option("--curves", is_flag=True, help="Follow each special point over r_on and zeta_1 too.")
@click.option(
    "--output",
    type=click.Path(path_type=Path, file_okay=False),
    default=Path("cellcrawl-branches"),
    show_default=True,
    metavar="DIR",
    help="Where branches, the table of special points and the picture go.",
)
@click.option("--overwrite", is_flag=True, help="Replace branches that are there.")
@click.option("--dpi", type=click.IntRange(30, 1200), default=200, show_default=True)
@look_options
@parameter_options(_USUAL)
def branches(
    several: str | None,
    to: float,
    turning: bool,
    orbits: str | None,
    curves: bool,
    output: Path,
    overwrite: bool,
    dpi: int,
    look: Look,
    **parameters: Any,
) -> int:
    """Follow gliding cells in r_on from where they leave the resting circle.

    Prints every point at which they lose or gain their hold, and what is lost there: the mirror
    axis (pitchfork: they begin to turn), steadiness (Hopf point) or existence (fold). Branches are
    files that `cellcrawl.branches.open_branch` reads.

    \b
    Examples
      cellcrawl branches
      cellcrawl branches --at-zeta-1 540,560,580,600 --output crossings
      cellcrawl branches --turning --orbits 24,34 --zeta-1 600
      cellcrawl branches --turning --curves --elasticity consistent
    """
    from cellcrawl import plot

    usual = _USUAL.to_dict()
    cell = Parameters(**{**usual, **{k: v for k, v in parameters.items() if v is not None}})
    cells = [cell] if several is None else [cell.replace(zeta_1=v) for v in _numbers(several)]
    make_folder(output)
    made: list[Branch] = []
    cycles: list[OrbitBranch] = []
    places = [] if orbits is None else _numbers(orbits, "--orbits")
    points: list[SpecialPoint] = []
    try:
        for one in cells:
            found = _followed(one, to, turning, output, overwrite)
            made += found
            for branch in found:
                points += branch.special_points
                _tell(branch)
            cycles += _orbits(one, places, output, overwrite)
            if places:
                cycles += _wobbles(found, output, overwrite)
        say(f"special points  {len(points)}")
        _write(points, output / "special_points.csv")
        lines = _curves(points, cell, to) if curves else []
    except KeyboardInterrupt:
        say("stopped; what was followed is in the files")
        return CANCELLED
    with look.used():
        save_picture(plot.branch_panels([*made, *cycles]), output / "branches.png", dpi)
        if lines:
            save_picture(plot.boundaries(lines).figure, output / "curves.png", dpi)
    ended = [one.status for one in made] + [one.status for one in cycles]
    if "interrupted" in ended:
        return CANCELLED
    return RUN_FAILED if any(branch.status == "no convergence" for branch in made) else 0


def _numbers(text: str, flag: str = "--at-zeta-1") -> list[float]:
    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise InputError(f"{flag} {text!r}: give numbers with commas, as in 560,600") from None


def _followed(
    cell: Parameters, to: float, turning: bool, output: Path, overwrite: bool
) -> list[Branch]:
    from cellcrawl.branches import from_circle

    def file(kind: str) -> Path:
        return output / f"{kind}-{cell.zeta_1:g}.nc"

    start = from_circle(cell, "r_on", near=200.0)
    gliding = start.continue_in("r_on", to, output=file(_GLIDING), overwrite=overwrite)
    made = [gliding]
    forks = gliding.points("pitchfork") if turning else []
    for number, fork in enumerate(forks):
        name = _TURNING if number == 0 else f"{_TURNING}-{number + 1}"
        aim = max(1.0, 0.8 * fork.value)
        try:
            first = fork.branch_off()
            made.append(first.continue_in("r_on", aim, output=file(name), overwrite=overwrite))
        except InputError as error:
            say(f"turning cells from {fork.value:.6g}: {error}")
    return made


def _orbits(
    cell: Parameters, places: list[float], output: Path, overwrite: bool
) -> list[OrbitBranch]:
    """Follow the orbits that runs at some r_on end on, both ways."""
    from cellcrawl.branches import orbit
    from cellcrawl.simulation import simulate

    made = []
    for place in places:
        one = cell.replace(r_on=place)
        run = simulate(one, _SETTLED, save_every=1.0)
        try:
            found = orbit(run, nodes=_NODES)
        except InputError as error:
            say(f"r_on = {place:g}: {error}")
            continue
        say(f"{found}, {'stable' if found.stable else 'unstable'}")
        for way, aim in (("down", max(1.0, 0.6 * place)), ("up", min(200.0, 1.5 * place))):
            file = output / f"{found.kind.replace(' ', '-')}-{cell.zeta_1:g}-{place:g}-{way}.nc"
            branch = found.continue_in(
                "r_on", aim, nodes=_NODES, most_orbits=_MOST, output=file, overwrite=overwrite
            )
            say(f"  {way}: {len(branch)} orbits; {branch.message}")
            for point in branch.special_points:
                say(f"  r_on {point.value:12.5f}  {point.kind}")
            made.append(branch)
    return made


def _wobbles(found: list[Branch], output: Path, overwrite: bool) -> list[OrbitBranch]:
    """Follow the small orbits that leave turning cells at their Hopf points."""
    from cellcrawl.branches import from_hopf

    made = []
    for point in [
        p for branch in found if branch[0].kind == _TURNING for p in branch.points("Hopf")
    ]:
        zeta_1 = point.parameters.zeta_1
        try:
            first = from_hopf(point, nodes=_NODES)
        except InputError as error:
            say(f"r_on = {point.value:g}: {error}")
            continue
        born = first.parameters.r_on
        branch = first.continue_in(
            "r_on", born + 10.0 * (born - point.value), nodes=_NODES, most_orbits=_MOST,
            output=output / f"wobble-{zeta_1:g}-{point.value:.4g}.nc", overwrite=overwrite,
        )  # fmt: skip
        say(f"wobble of turning cells: {len(branch)} orbits; {branch.message}")
        for special in branch.special_points:
            say(f"  r_on {special.value:12.5f}  {special.kind}")
        made.append(branch)
    return made


def _tell(branch: Branch) -> None:
    kind, cell = branch[0].kind, branch[0].parameters
    say(f"{kind} cells, zeta_1 = {cell.zeta_1:g}: {len(branch)} states; {branch.message}")
    for point in branch.special_points:
        spin = f"  frequency {point.frequency:.6f}" if point.frequency else ""
        what = f"{point.symmetry} {point.kind}".strip()
        say(f"  r_on {point.value:12.7f}  {what}{spin}")


def _write(points: list[SpecialPoint], path: Path) -> None:
    try:
        with path.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(_COLUMNS)
            for point in points:
                state, p = point.state, point.parameters
                r_on = point.value if point.name == "r_on" else p.r_on
                writer.writerow(
                    [
                        point.kind, point.symmetry, repr(r_on), repr(p.zeta_1),
                        repr(point.frequency), repr(state.speed), repr(state.turning_rate),
                        repr(state.tension),
                    ]
                )  # fmt: skip
    except OSError as error:
        raise cannot_write(path, error) from None
    say(f"table    {path}")


def _curves(points: list[SpecialPoint], cell: Parameters, to: float) -> list[PointCurve]:
    """Follow the points of one zeta_1 over both parameters."""
    from cellcrawl.branches import curve_of

    first = points[0].parameters.zeta_1 if points else cell.zeta_1
    box = {"r_on": (max(1.0, 0.5 * to), 70.0), "zeta_1": (400.0, 640.0)}
    made = []
    for point in points:
        if point.parameters.zeta_1 != first or point.kind == "circle" or point.vector is None:
            continue
        curve = curve_of(point, "zeta_1", within=box, most_points=80)
        say(f"{curve.symmetry} {curve.kind} over r_on and zeta_1: {len(curve)} points")
        made.append(curve)
    return made
