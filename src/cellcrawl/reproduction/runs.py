"""Runs that are kept: made once, reused wherever the same one is asked for, gone on with if cut."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import xarray as xr

from cellcrawl.errors import InputError, StorageError
from cellcrawl.parameters import CONSTANT, Parameters, Schedule
from cellcrawl.simulation import open_run, resume, simulate
from cellcrawl.simulation.description import RunDescription
from cellcrawl.simulation.storage import RunStore
from cellcrawl.starts import RandomPerturbation
from cellcrawl.sweeps.identity import run_key


def kept_run(
    folder: Path,
    parameters: Parameters,
    t_end: float,
    *,
    seed: int = 1,
    amplitude: float = 1e-4,
    save_every: float = 0.1,
    schedule: Schedule = CONSTANT,
    nodes: int | None = None,
    **options: Any,
) -> xr.Dataset:
    """Return the run from a random start, from its file in ``folder`` if it is there.

    The file's name ends in the hash that names the run in a sweep: of parameters, start, schedule,
    times, solver and code. A run that was interrupted goes on from where it was.

    Raises
    ------
    KeyboardInterrupt
        If Ctrl-C ended the run; what was computed is kept.
    StorageError
        If the file cannot be written, or an unreadable one is in the way and cannot be removed.
    """
    start = RandomPerturbation(seed=seed, amplitude=amplitude)
    described = RunDescription(
        parameters=parameters,
        t_end=t_end,
        start=start,
        save_every=save_every,
        nodes=nodes,
        schedule=schedule,
        options=options,
    )
    path = folder / f"{_label(parameters, seed)}-{run_key(described, 'fields')[:10]}.nc"
    run = _opened(path, described.t_end)
    if run is None:
        folder.mkdir(parents=True, exist_ok=True)
        store = RunStore(path)
        if store.exists():  # damaged, and in a place that nothing else is put
            with store.writing():
                store.remove()
        run = simulate(
            parameters,
            t_end,
            start=start,
            schedule=schedule,
            save_every=save_every,
            nodes=nodes,
            output=path,
            **options,
        )
    if run.attrs["status"] == "interrupted":
        run.close()
        raise KeyboardInterrupt
    loaded: xr.Dataset = run.load()
    run.close()
    loaded.encoding["source"] = str(path)
    return loaded


def _opened(path: Path, t_end: float) -> xr.Dataset | None:
    """Return the run at ``path`` up to ``t_end``, None if there is none that can be used."""
    if not RunStore(path).exists():
        return None
    try:
        run = open_run(path)
        if run.attrs["status"] in ("running", "interrupted"):
            run.close()
            run = resume(path, t_end)
    except (InputError, StorageError, KeyError):
        return None  # damaged: it is made anew
    return run


def _label(parameters: Parameters, seed: int) -> str:
    return f"{parameters.r_on:g}-{parameters.zeta_1:g}-seed{seed}"
