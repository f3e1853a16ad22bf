"""`simulate` and `resume`: a solver, followed from saved time to saved time until the run ends."""

from __future__ import annotations

import math
import time as clock
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import xarray as xr

from cellcrawl.curve import first_crossing
from cellcrawl.errors import InputError, nearest_name
from cellcrawl.parameters import CONSTANT, Conditions, Parameters, Schedule
from cellcrawl.simulation.dataset import SCHEMA_VERSION, decode_attribute, package_version
from cellcrawl.simulation.events import RESUMABLE, crossing_at, locate_crossing
from cellcrawl.simulation.interruption import Interruption
from cellcrawl.simulation.progress import Progress, make_progress
from cellcrawl.simulation.recorder import MemoryRecorder, Recorder, StoreRecorder
from cellcrawl.simulation.storage import RunStore
from cellcrawl.solvers import SOLVERS, Breakdown, Solver
from cellcrawl.starts import RandomPerturbation, Start
from cellcrawl.validation import real_number

DEFAULT_SOLVER = "adaptive"
_CHECK_EVERY = 0.1  # longest time between two looks for a self-crossing
_SAME_TIME = 1e-9  # relative


def simulate(
    parameters: Parameters | None = None,
    t_end: float = 100.0,
    *,
    start: Start | None = None,
    save_every: float = 0.1,
    solver: str = DEFAULT_SOLVER,
    nodes: int | None = None,
    schedule: Schedule | None = None,
    output: str | Path | None = None,
    overwrite: bool = False,
    progress: bool = False,
    **options: Any,
) -> xr.Dataset:
    """Simulate one crawling cell.

    Parameters
    ----------
    parameters : Parameters
        Those of the paper's (25, 600) cell unless given.
    t_end : float
        Time at which to stop, in 1/k_off0.
    start : Start, optional
        The first state; ``RandomPerturbation(seed=1)`` unless given.
    save_every : float
        Time between saved records. Records are at its multiples; if ``t_end`` is none of them, or
        the run ends early, the last valid state is one more record.
    solver : str
        Numerical scheme. ``"adaptive"`` meets a relative tolerance ``rtol`` (default 1e-4) and
        chooses nodes and steps itself. ``"paper"`` is the paper's own, ``"spline"``
        an independent check of both (each with options ``nodes``, ``dt``).
    nodes : int, optional
        Nodes in the output; 256 unless given. ``"paper"`` and ``"spline"`` compute on them too,
        and take 2000 and 512.
    schedule : Schedule, optional
        Parameters that change during the run.
    output : str or Path, optional
        ``run.nc`` (netCDF) or ``run.zarr``. Written in blocks while the run goes: memory stays
        flat, and a killed run opens with `open_run` and goes on with `resume`.
    overwrite : bool
        Replace a run that is already at ``output``.
    progress : bool
        Show a progress bar with the time left and the tension.
    **options
        The solver's own options.

    Returns
    -------
    Dataset
        Fields of the edge on (time, node), global quantities on (time); ``attrs["status"]`` says
        how the run ended and ``attrs["status_message"]`` what that means. A cell that tears ends
        as "fragmented", Ctrl-C as "interrupted"; what was computed is kept.

    Raises
    ------
    InputError
        For a value that cannot be used; nothing has been computed or written then.
    StorageError
        If ``output`` cannot be written; what was written before stays readable.

    Examples
    --------
    >>> ds = simulate(Parameters(r_on=26, zeta_1=600), t_end=0.5, nodes=200)
    >>> ds.attrs["status"], ds.sizes["time"], ds.sizes["node"]
    ('completed', 6, 200)
    """
    conditions = Conditions(
        _expect(Parameters() if parameters is None else parameters, Parameters, "parameters"),
        _expect(CONSTANT if schedule is None else schedule, Schedule, "schedule"),
    )
    first = _expect(RandomPerturbation() if start is None else start, Start, "start")
    until = real_number("t_end", t_end, 0.0, 1e9)
    every = real_number("save_every", save_every, 0.0, 1e9, open_low=True)
    store = RunStore(output) if output is not None else None
    if store is not None and store.exists() and not overwrite:
        raise InputError(
            f"{store.path} exists: give another output, resume it, or ask to overwrite it"
        )
    scheme = solver_named(solver)
    count = scheme.checked_nodes(nodes)
    _check_options(scheme, options)
    state = first.state(conditions.at(0.0), scheme.start_nodes(count, **options))
    engine = scheme(state, conditions, nodes=count, **options)
    if crossing_at(engine, 0.0) is not None:
        raise InputError("the start crosses itself: the model needs a simple edge")
    identity = {
        "parameters": conditions.parameters.to_dict(),
        "schedule": conditions.schedule.to_dict(),
        "start": first.describe(),
        "seed": getattr(first, "seed", -1),
        "solver": engine.name,
        "solver_options": engine.options(),
        "save_every": every,
        "cellcrawl_version": package_version(),
        "schema_version": SCHEMA_VERSION,
    }
    recorder: Recorder = MemoryRecorder()
    if store is not None:
        if overwrite:
            store.remove()
        recorder = StoreRecorder(store, 0)
    bar = make_progress(progress, 0.0, until)
    return _Run(engine, conditions, recorder, identity, every, bar, 0, 0.0).follow(until)


def resume(path: str | Path, t_end: float, *, progress: bool = False) -> xr.Dataset:
    """Go on with a saved run, to the same bits as if it had never stopped.

    Parameters
    ----------
    path : str or Path
        The run's file: finished, interrupted or killed.
    t_end : float
        New time at which to stop.
    progress : bool
        Show a progress bar.

    Returns
    -------
    Dataset
        The whole run. One that is already past ``t_end`` is refused; one that ended there is
        returned as it is.

    Raises
    ------
    InputError
        If there is no run, or it ended in a way that cannot go on (a torn cell).
    """
    until = real_number("t_end", t_end, 0.0, 1e9)
    store = RunStore(path)
    if not store.exists():
        raise InputError(f"there is no run at {store.path}")
    with store.open() as saved:
        status, reached = saved.attrs["status"], float(saved.attrs["end_time"])
        if status not in RESUMABLE:
            raise InputError(
                f"{store.path} ended at t = {reached:g} as {status!r} and cannot go on: start a "
                "new run, from its last state with FromRun if you like"
            )
        identity = {
            name: decode_attribute(saved, name)
            for name in ("parameters", "schedule", "start", "solver_options")
        }
        for name in ("seed", "solver", "save_every", "cellcrawl_version", "schema_version"):
            identity[name] = saved.attrs[name]
        records = int(saved.attrs["records_on_grid"])
        spent = decode_attribute(saved, "diagnostics")["wall_time"]
    if status == "completed" and _same(until, reached):
        store.consolidate()
        return store.open()
    if until < reached:
        raise InputError(f"{store.path} has reached t = {reached:g} already: t_end must be above")
    conditions = Conditions(
        Parameters.from_dict(identity["parameters"]), Schedule(identity["schedule"])
    )
    engine = solver_named(str(identity["solver"]))(None, conditions, **identity["solver_options"])
    engine.restore(store.checkpoint())
    bar = make_progress(progress, reached, until)
    recorder = StoreRecorder(store, records)
    every = float(identity["save_every"])
    return _Run(engine, conditions, recorder, identity, every, bar, records, spent).follow(until)


def solver_named(name: str) -> type[Solver]:
    """Return the solver class of that name, or raise `InputError`."""
    if name not in SOLVERS:
        raise InputError(f"there is no solver {name!r}: {nearest_name(name, SOLVERS)}")
    return SOLVERS[name]


@dataclass
class _Run:
    """One run on its way: the only place where solver, events, recorder and progress meet."""

    solver: Solver
    conditions: Conditions
    recorder: Recorder
    identity: dict[str, Any]
    save_every: float
    progress: Progress
    records: int
    wall_time: float

    def follow(self, t_end: float) -> xr.Dataset:
        """Go on to ``t_end`` or to whatever ends the run first; return the Dataset."""
        self._began = clock.monotonic()
        with Interruption() as interruption, self.progress:
            ended, closing = self._follow(t_end, interruption)
            frame = None if closing is None else self.solver.frame(closing)
            reached = self._last_record() if closing is None else closing
            attributes = self._attributes(ended, reached)
            return self.recorder.finish(frame, self._checkpoint, attributes)

    def _follow(self, t_end: float, interruption: Interruption) -> tuple[Breakdown, float | None]:
        """Return how the run ended and the time of a closing record, None if it is on the grid."""
        now = self._last_record() if self.records else -0.5 * _CHECK_EVERY
        valid = self._checkpoint = self.solver.checkpoint()
        while True:
            target, on_grid = self._next_target(now, t_end)
            ended = self.solver.advance(target)
            if ended is not None:
                last = self.solver.time
                if crossing_at(self.solver, last) is None:
                    self._checkpoint = self.solver.checkpoint()
                    return ended, self._off_grid(max(last, now))
                target = last
            frame = self.solver.frame(target)
            if first_crossing(frame.points) is not None:
                found = locate_crossing(self.solver, valid, now, target)
                self._checkpoint = self.solver.checkpoint()
                return found.breakdown, self._off_grid(found.last_valid)
            valid, now = self.solver.checkpoint(), target
            self._checkpoint = valid
            if on_grid:
                self.records += 1
                self.progress.update(target, frame.tension)
                if self.recorder.record(frame):
                    running = Breakdown("running", target, f"has reached t = {target:g}")
                    self.recorder.commit(valid, self._attributes(running, target))
            if now >= t_end or _same(now, t_end):
                done = Breakdown("completed", t_end, f"reached t_end = {t_end:g}")
                return done, self._off_grid(now)
            if interruption.requested:
                message = f"stopped at t = {now:.6g} by {interruption.requested}: can be resumed"
                return Breakdown("interrupted", now, message), self._off_grid(now)

    def _next_target(self, now: float, t_end: float) -> tuple[float, bool]:
        """Return the next time to look at and whether it is on the grid of saved times."""
        record = self.records * self.save_every
        check = (math.floor(now / _CHECK_EVERY + _SAME_TIME) + 1) * _CHECK_EVERY
        on_grid = record <= check or _same(record, check)
        target = record if on_grid else check
        if target > t_end and not _same(target, t_end):
            return t_end, False
        return target, on_grid

    def _last_record(self) -> float:
        return (self.records - 1) * self.save_every

    def _off_grid(self, time: float) -> float | None:
        last = self._last_record()
        return None if time <= last or _same(time, last) else time

    def _attributes(self, ended: Breakdown, reached: float) -> dict[str, Any]:
        spent = self.wall_time + clock.monotonic() - self._began
        return {
            "title": "cellcrawl run",
            "status": ended.status,
            "status_message": ended.message,
            "end_time": float(ended.time if ended.status == "completed" else reached),
            **self.identity,
            "records_on_grid": self.records,
            "diagnostics": {**self.solver.diagnostics(), "wall_time": round(spent, 3)},
        }


def _same(a: float, b: float) -> bool:
    return abs(a - b) <= _SAME_TIME * max(abs(a), abs(b))


def _expect(value: Any, kind: Any, name: str) -> Any:
    if not isinstance(value, kind):
        raise InputError(f"{name} must be a {kind.__name__}, not {type(value).__name__}")
    return value


def _check_options(scheme: type[Solver], options: dict[str, Any]) -> None:
    for name in options:
        if name not in scheme.OPTIONS:
            hint = nearest_name(name, scheme.OPTIONS)
            raise InputError(f"solver {scheme.name!r} has no option {name!r}: {hint}")
