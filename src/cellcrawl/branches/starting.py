"""States from runs, from cells, and from parameters alone."""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.branches.equations import Fields, rates
from cellcrawl.branches.mesh import even_samples
from cellcrawl.branches.points import PITCHFORK
from cellcrawl.branches.resolution import better_mesh, choose, resampled
from cellcrawl.branches.setting import OutOfRange, Setting, bounds_of
from cellcrawl.branches.state import GLIDING, TURNING, SteadyState
from cellcrawl.branches.system import NotFound, System
from cellcrawl.curve import fourier
from cellcrawl.data import decode_attribute, records_with
from cellcrawl.data.units import DIMENSIONLESS, units_of
from cellcrawl.errors import InputError
from cellcrawl.laws import as_law
from cellcrawl.laws.law import PAPER, Law
from cellcrawl.laws.rest import rest_state
from cellcrawl.parameters import Parameters
from cellcrawl.threads import on_one_thread
from cellcrawl.validation import real_number

_NEEDED: Final = ("x", "y", "theta", "length", "bound_fraction", "tension", "area")
_CIRCLE_AREA = 1e-6  # relative: what small perturbations of a circle add to its area
_MIRRORED = 0.02  # share of the bound fraction without a mirror axis in a gliding cell
_FAR_TENSION, _FAR_SHAPE = 0.02, 0.1
_LATE = 0.2  # part of a run that must be steady
_GUESS = 3.0
_SETTLING: Final = (25.0, 60.0)


@checked
def from_run(run: xr.Dataset, *, rest_area: float | None = None) -> SteadyState:
    """Return the steady state at the end of a run: gliding or turning, to rounding.

    Parameters
    ----------
    run : Dataset
        A run whose cell glides or turns steadily at its end, without surroundings.
    rest_area : float, optional
        Area at which the cell has the tension of the resting circle. Unless given the run's own:
        pi if it is within a millionth, as for a run from a slightly perturbed circle.

    Raises
    ------
    InputError
        If the run has torn, is not steady, or Newton's method leads elsewhere from its end.

    Examples
    --------
    >>> from cellcrawl import PerturbedCircle, Parameters, simulate
    >>> front = PerturbedCircle(bound_fraction={1: (0.01, 0.0)})
    >>> run = simulate(Parameters(r_on=56, zeta_1=560), t_end=60, start=front)
    >>> from_run(run).kind
    'gliding'
    """
    end = last_of(run, "from_run", rest_area)
    _refuse_unsteady(run)
    setting, theta, n, length, sigma = end
    found = polished(setting, theta, n, length, sigma)
    size = abs(found.tension / sigma - 1.0), abs(found.length / length - 1.0)
    if size[0] > _FAR_TENSION or size[1] > _FAR_SHAPE:
        raise InputError(
            f"this run is not near a steady state at its end: the nearest found has tension "
            f"{found.tension:.6g} and length {found.length:.6g}, the run {sigma:.6g} and "
            f"{length:.6g}; run longer"
        )
    return found


class End(NamedTuple):
    """The last record of a run at equal arclengths, and the setting it goes on in."""

    setting: Setting
    theta: np.ndarray
    bound_fraction: np.ndarray
    length: float
    tension: float


def last_of(run: xr.Dataset, asking: str, rest_area: float | None = None) -> End:
    """Return the end of a run that states and orbits can begin from.

    Raises
    ------
    InputError
        For one with units or surroundings, or that has torn.
    """
    records = records_with(run, *_NEEDED)
    if units_of(records) != DIMENSIONLESS:
        raise InputError(f"{asking} needs a run in the model's units")
    status = records.attrs.get("status", "completed")
    if status not in ("completed", "interrupted", "running"):
        raise InputError(
            f"this run ended as {status!r}, and nothing can go on from its end: take the part "
            "before with .sel(time=slice(...)), or another run"
        )
    if "surroundings" in records.attrs:
        raise InputError(
            "this run has surroundings, which make one place unlike another: branches are for "
            "cells on ground that is everywhere the same"
        )
    parameters = Parameters.from_dict(decode_attribute(records, "parameters"))
    schedule = decode_attribute(records, "schedule")
    if schedule:
        from cellcrawl.parameters import Schedule

        parameters = Schedule(schedule).at(parameters, float(records.time[-1]))
    laws = as_law(decode_attribute(records, "laws")) if "laws" in records.attrs else PAPER
    last = records[list(_NEEDED)].isel(time=-1)
    theta, n = last["theta"].values, last["bound_fraction"].values
    length, sigma = float(last["length"]), float(last["tension"])
    if rest_area is None:
        rest = rest_state(parameters, laws).tension
        area = fourier.area(last["x"].values, last["y"].values)
        rest_area = float(area) - (sigma - rest) / max(parameters.tension_rate, 1e-300)
        if abs(rest_area / math.pi - 1.0) < _CIRCLE_AREA:
            rest_area = math.pi
    setting = Setting(parameters, laws, real_number("rest_area", rest_area, -1e3, 1e3))
    return End(setting, theta, n, length, sigma)


def _refuse_unsteady(records: xr.Dataset) -> None:
    time = records.time.values
    if time.size < 3:
        return
    late = records.sel(time=slice(time[-1] - _LATE * (time[-1] - time[0]), None))
    tension = late["tension"].values
    turns = np.sum(np.diff(np.sign(np.diff(tension))) != 0)
    spread = float(np.ptp(tension) / max(abs(tension[-1]), 1.0))
    if turns >= 2 and spread > _FAR_TENSION / 4.0:
        raise InputError(
            f"this run is not steady at its end: its tension goes up and down by {100 * spread:.2g}"
            " % (a cell that zigzags, rotates or wanders); cellcrawl.branches.gliding finds the "
            "gliding cell beside it, stable or not"
        )


def polished(
    setting: Setting, theta: np.ndarray, n: np.ndarray, length: float, sigma: float
) -> SteadyState:
    """Return the steady state near a cell that is given at equal arclengths.

    Raises
    ------
    InputError
        If Newton's method does not come to one.
    """
    alpha = 2.0 * math.pi * np.arange(theta.size) / theta.size
    w = theta - alpha
    shift, lopsided = _front(n, w)
    mirror = lopsided < _MIRRORED

    series = fourier.TrigonometricSeries(w + 1j * n)

    def sampler(at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        there = series(at + shift)
        angle, bound = there.real + shift - 0.5 * math.pi, there.imag
        if mirror:
            mirrored = series(shift - at)
            back = mirrored.real + shift - 0.5 * math.pi
            angle, bound = 0.5 * (angle - back), 0.5 * (bound + mirrored.imag)
        return angle, bound

    mesh = choose(sampler, mirror)
    system = System(mesh, mirror)
    w0, n0 = sampler(mesh.alpha)
    turn = slide = 0.0
    fields = Fields(w0[: system.nodes], n0[: system.nodes], length, sigma)
    if not mirror:
        turn, slide = _motion_of(setting, system, fields)
    y = system.pack(fields, slide, turn)
    return settle(setting, system, y, np.full(system.nodes, _GUESS))


@on_one_thread
def settle(setting: Setting, system: System, y: np.ndarray, phi: np.ndarray) -> SteadyState:
    """Return the state near some unknowns, on nodes that resolve it.

    Raises
    ------
    InputError
        If Newton's method does not come to one.
    """
    try:
        root = system.solve(setting, y, phi)
        mesh = better_mesh(system, root.unknowns, anew=True)
        if mesh is not None:
            system, y = resampled(system, root.unknowns, mesh)
            root = system.solve(setting, y, np.full(system.nodes, _GUESS))
    except NotFound as error:
        raise InputError(
            f"Newton's method found no steady state near the one given ({error}): run longer, or "
            "begin nearer"
        ) from None
    return SteadyState.of(setting, system, root)


def _front(n: np.ndarray, w: np.ndarray) -> tuple[float, float]:
    """Return where the mirror axis leaves at the front, and how much is not mirrored about it."""
    waves = np.fft.rfft(n)[1:]
    k = np.arange(1, waves.size + 1)
    power = np.abs(waves) ** 2
    total = float(power.sum())
    if total < 1e-20 * n.size**2:
        return 0.0, 0.0
    shifts = np.linspace(0.0, 2.0 * math.pi, 4096, endpoint=False)
    few = min(k.size, 24)
    phase = np.angle(waves[:few])[None, :] + np.outer(shifts, k[:few])
    odd = np.sum(power[:few] * np.sin(phase) ** 2, axis=1)
    candidates = np.flatnonzero((odd <= np.roll(odd, 1)) & (odd <= np.roll(odd, -1)))
    least = min(candidates, key=lambda i: odd[i])
    at = float(shifts[least])
    for _ in range(30):
        phase = np.angle(waves) + k * at
        slope = np.sum(power * k * np.sin(2.0 * phase))
        bend = np.sum(2.0 * power * k * k * np.cos(2.0 * phase))
        if not bend > 0.0:
            break
        at -= slope / bend
    odd_part = float(np.sum(power * np.sin(np.angle(waves) + k * at) ** 2)) / total
    front = even_samples(n, np.array([at, at + math.pi]))
    if front[1] > front[0]:  # most linkers are bound at the front
        at += math.pi
    return at % (2.0 * math.pi), math.sqrt(odd_part)


def _motion_of(setting: Setting, system: System, fields: Fields) -> tuple[float, float]:
    """Turning rate and relabelling that leave least of the rates of a nearly steady shape."""
    try:
        now = rates(setting, system.ops, fields, np.full(system.nodes, _GUESS))
    except OutOfRange:
        return 0.0, 0.0
    g = np.sqrt(system.mesh.whole.mean)
    left = np.concatenate([g * now.w, g * now.n])
    columns = np.array(
        [np.concatenate([-g, 0.0 * g]), np.concatenate([g * now.kappa, g * now.bound_slope])]
    ).T
    (turn, slide), *_ = np.linalg.lstsq(columns, -left, rcond=None)
    return float(turn), float(slide)


def run_to(
    parameters: Parameters, laws: Law, mirror: bool, t_end: float, strength: float = 0.02
) -> Any:
    """Simulate a cell from a circle with a front; without ``mirror`` also with a side."""
    from cellcrawl.simulation import simulate
    from cellcrawl.starts import PerturbedCircle

    side = 0.0 if mirror else 0.6 * strength
    bound = {1: (strength, 0.0), 2: (0.0, side)} if side else {1: (strength, 0.0)}
    start = PerturbedCircle(bound_fraction=bound)
    return simulate(
        parameters, t_end, start=start, laws=laws, save_every=t_end / 4.0, nodes=512, rtol=1e-5
    )


@checked
def gliding(parameters: Parameters, *, laws: Any = None) -> SteadyState:
    """Return a gliding state at some parameters, stable or not, from nothing.

    A short symmetric run is polished; where that leads back to the circle, the branch of gliding
    states is followed from the circle's onset.

    Raises
    ------
    InputError
        If neither leads to a gliding state.
    """
    law = PAPER if laws is None else as_law(laws)
    setting = Setting(parameters, law)
    for t_end, strength in zip(_SETTLING, (0.02, 0.1), strict=True):
        try:
            run = run_to(parameters, law, True, t_end, strength)
            if run.attrs["status"] != "completed":
                continue
            last = run.isel(time=-1)
            found = polished(
                setting, last["theta"].values, last["bound_fraction"].values,
                float(last["length"]), float(last["tension"]),
            )  # fmt: skip
        except InputError:
            continue
        if found.kind == GLIDING and found.system.mirror:
            return found
    followed = _along_branch(setting, None)
    if followed is not None:
        return followed
    raise InputError(
        f"no gliding state was found at r_on = {parameters.r_on:g}, zeta_1 = "
        f"{parameters.zeta_1:g}: follow one from where cells glide, with gliding(...).continue_in"
    )


@checked
def turning(parameters: Parameters, *, laws: Any = None) -> SteadyState:
    """Return a steadily turning state at some parameters, stable or not, from nothing.

    A lopsided run is polished; where it does not end in a steady turn, the branch of turning states
    is followed from the pitchfork at which it leaves the gliding ones.

    Raises
    ------
    InputError
        If neither leads to a turning state.
    """
    law = PAPER if laws is None else as_law(laws)
    setting = Setting(parameters, law)
    try:
        run = run_to(parameters, law, False, 80.0, 0.1)
        if run.attrs["status"] == "completed":
            found = from_run(run, rest_area=math.pi)
            if found.kind == TURNING:
                return found
    except InputError:
        pass
    followed = _along_branch(setting, PITCHFORK)
    if followed is not None:
        return followed
    raise InputError(
        f"no steadily turning state was found at r_on = {parameters.r_on:g}, zeta_1 = "
        f"{parameters.zeta_1:g}: follow one from where cells turn, with turning(...).continue_in"
    )


def _along_branch(setting: Setting, leave_at: str | None) -> SteadyState | None:
    """Follow gliding states in r_on from where they leave the circle, to a cell's parameters.

    With ``leave_at``, the branches that leave at points of that kind are followed.
    """
    from cellcrawl.branches.circle import from_circle, onsets

    parameters, laws = setting.parameters, setting.laws
    low, high = bounds_of(laws, "r_on")
    for onset in reversed(onsets(parameters, "r_on", low, high, laws=laws)):
        try:
            first = from_circle(parameters, "r_on", near=onset, laws=laws)
            if leave_at is None:
                branch = first.continue_in("r_on", parameters.r_on, spectra=False)
                if branch.status == "completed":
                    return branch.states[-1]
                continue
            away = low if onset > 0.5 * (low + high) or onset > parameters.r_on else high
            branch = first.continue_in("r_on", away, most_states=40)
            for point in branch.points(leave_at):
                other = point.branch_off().continue_in("r_on", parameters.r_on, spectra=False)
                if other.status == "completed":
                    return other.states[-1]
        except InputError:
            continue
    return None
