"""`simulate` and `resume`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.data import FIELDS, RESUMABLE, SCHEMA_VERSION, decode_attribute
from cellcrawl.errors import CellcrawlError, InputError, StorageError
from cellcrawl.laws import as_law
from cellcrawl.laws.law import PAPER
from cellcrawl.parameters import CONSTANT, Parameters, Schedule
from cellcrawl.simulation.description import DEFAULT_SOLVER, RunDescription, solver_named
from cellcrawl.simulation.following import Follower, Kept, same_time
from cellcrawl.simulation.progress import Progress, make_progress
from cellcrawl.simulation.recorder import Checkpoint, MemoryRecorder, Recorder, StoreRecorder
from cellcrawl.simulation.storage import RunStore
from cellcrawl.simulation.tension_law import KEY, TensionLaw
from cellcrawl.solvers import Solver
from cellcrawl.solvers.conditions import Conditions
from cellcrawl.starts import RandomPerturbation, Start
from cellcrawl.surroundings import as_surroundings
from cellcrawl.validation import real_number

_SAME = 1e-9  # a restored state gives its last record to rounding


@checked
def simulate(
    parameters: Parameters | None = None,
    t_end: float = 100.0,
    *,
    start: Start | None = None,
    save_every: float = 0.1,
    solver: str = DEFAULT_SOLVER,
    nodes: int | None = None,
    schedule: Schedule | None = None,
    laws: Any = None,
    surroundings: Any = None,
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
    laws : Law or str, optional
        A law set of `cellcrawl.laws`, by itself or by name; the paper's unless given.
    surroundings : Surrounding or sequence of these, optional
        What the cell crawls in, of `cellcrawl.surroundings`.
    output : str or Path, optional
        ``run.nc`` (netCDF) or ``run.zarr``. Written in blocks while the run goes: memory stays
        flat, and a killed run opens with `open_run` and goes on with `resume`.
    overwrite : bool
        Replace a run that is already at ``output``; anything else there is refused.
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
        If ``output`` cannot be written or loses its files meanwhile; what was written before stays
        readable.

    Examples
    --------
    >>> ds = simulate(Parameters(r_on=26, zeta_1=600), t_end=0.5, nodes=200)
    >>> ds.attrs["status"], ds.sizes["time"], ds.sizes["node"]
    ('completed', 6, 200)
    """
    description = RunDescription(
        parameters=Parameters() if parameters is None else parameters,
        t_end=t_end,
        start=RandomPerturbation() if start is None else start,
        save_every=save_every,
        solver=solver,
        nodes=nodes,
        schedule=CONSTANT if schedule is None else schedule,
        laws=PAPER if laws is None else laws,
        surroundings=surroundings,
        options=options,
    )
    store = RunStore(output) if output is not None else None
    if store is not None:
        _make_room(store, overwrite, remove=False)
    engine = description.solver_at_start()
    bar = make_progress(progress, 0.0, description.t_end)
    if store is None:
        return follow(description, engine, MemoryRecorder(), bar)
    with store.writing():
        _make_room(store, overwrite, remove=True)
        return follow(description, engine, StoreRecorder(store, 0), bar)


def _make_room(store: RunStore, overwrite: bool, *, remove: bool) -> None:
    """See that a run may be written there; with ``remove``, delete the one it replaces."""
    if not store.exists():
        return
    if not overwrite:
        raise InputError(
            f"{store.path} exists: give another output, resume it, or ask to overwrite it"
        )
    store.refuse_what_is_no_run()
    if remove:
        store.remove()


def follow(
    description: RunDescription, engine: Solver, recorder: Recorder[Kept], progress: Progress
) -> Kept:
    """Follow a solver at its start to the end of the run; return what was recorded."""
    identity = description.identity(engine)
    law = TensionLaw(description.conditions, engine.invariant_tolerance)
    follower = Follower(engine, law, recorder, identity, description.save_every, progress)
    return follower.follow(description.t_end)


@checked
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
        If there is no run, it ended in a way that cannot go on (a torn cell), or another process
        writes it.
    StorageError
        If the file is damaged, or cannot be written.
    """
    until = real_number("t_end", t_end, 0.0, 1e9)
    store = RunStore(path)
    if not store.exists():
        raise InputError(f"there is no run at {store.path}")
    with store.writing():
        return _resume(store, until, progress)


def _resume(store: RunStore, until: float, progress: bool) -> xr.Dataset:
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
        for name in ("seed", "solver", "save_every", "cellcrawl_version"):
            identity[name] = saved.attrs[name]
        identity["schema_version"] = SCHEMA_VERSION
        for name in ("laws", "surroundings"):
            if name in saved.attrs:
                identity[name] = decode_attribute(saved, name)
        records = int(saved.attrs["records_on_grid"])
        spent = decode_attribute(saved, "diagnostics").get("wall_time", 0.0)
        last = saved[["time", *FIELDS]].isel(time=[-1]).load()
    if status == "completed" and same_time(until, reached):
        store.consolidate()
        return store.open()
    if until < reached:
        raise InputError(f"{store.path} has reached t = {reached:g} already: t_end must be above")
    checkpoint = store.checkpoint()
    conditions = Conditions(
        Parameters.from_dict(identity["parameters"]),
        Schedule(identity["schedule"]),
        as_law(identity.get("laws", PAPER)),
        as_surroundings(identity.get("surroundings")),
    )
    engine, law = _restored(checkpoint, conditions, identity, last, store.path)
    store.check_records()
    bar = make_progress(progress, reached, until)
    recorder = StoreRecorder(store, records)
    every = float(identity["save_every"])
    return Follower(engine, law, recorder, identity, every, bar, records, spent).follow(until)


def _restored(
    checkpoint: Checkpoint,
    conditions: Conditions,
    identity: dict[str, Any],
    last: xr.Dataset,
    path: Path,
) -> tuple[Solver, TensionLaw]:
    """Return the solver in the state to go on from, which must be that of the last record."""
    scheme = solver_named(str(identity["solver"]))
    try:
        engine = scheme(None, conditions, **identity["solver_options"])
        engine.restore(checkpoint)
        law = TensionLaw(conditions, engine.invariant_tolerance)
        if KEY in checkpoint:  # or the run is older than the law's check, which then begins here
            law.restore(checkpoint[KEY])
        frame = engine.frame(float(last["time"].item()))
        same = all(
            np.allclose(getattr(frame, name), last[name].values[0], rtol=_SAME, atol=_SAME)
            for name in FIELDS
        )
    except CellcrawlError:
        raise
    except Exception:  # a state of other names or shapes than this version's solver has
        same = False
    if not same:
        raise StorageError(
            f"the state to go on from in {path} is not that of its last record: the file was "
            f"edited, or written by another version ({identity['cellcrawl_version']}); start a new "
            "run from its last record with FromRun"
        )
    return engine, law
