"""Runs that are kept: made once, reused wherever the same one is asked for, gone on with if cut."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

import xarray as xr

from cellcrawl.errors import InputError, StorageError
from cellcrawl.parameters import CONSTANT, Parameters, Schedule
from cellcrawl.simulation import open_run, resume, simulate
from cellcrawl.simulation.dataset import SCHEMA_VERSION, package_version
from cellcrawl.simulation.storage import RunStore
from cellcrawl.starts import RandomPerturbation


def kept_run(
    folder: Path,
    parameters: Parameters,
    t_end: float,
    *,
    seed: int = 1,
    amplitude: float = 1e-4,
    save_every: float = 0.1,
    schedule: Schedule | None = None,
    nodes: int | None = None,
    **options: Any,
) -> xr.Dataset:
    """Return the run from a random start, from its file in ``folder`` if it is there.

    The file's name ends in a hash of everything the run depends on: parameters, start, schedule,
    solver options, times, version. A run that was interrupted goes on from where it was.

    Raises
    ------
    KeyboardInterrupt
        If Ctrl-C ended the run; what was computed is kept.
    StorageError
        If the file cannot be written, or an unreadable one is in the way and cannot be removed.
    """
    plan = CONSTANT if schedule is None else schedule
    start = RandomPerturbation(seed=seed, amplitude=amplitude)
    identity = {
        "parameters": parameters.to_dict(),
        "start": start.describe(),
        "schedule": plan.to_dict(),
        "nodes": nodes,
        "options": options,
        "t_end": float(t_end),
        "save_every": float(save_every),
        "version": package_version(),
        "schema": SCHEMA_VERSION,
    }
    path = folder / f"{_label(parameters, seed)}-{content_hash(identity)[:10]}.nc"
    run = _opened(path, float(t_end))
    if run is None:
        folder.mkdir(parents=True, exist_ok=True)
        run = simulate(
            parameters,
            t_end,
            start=start,
            schedule=plan,
            save_every=save_every,
            nodes=nodes,
            output=path,
            overwrite=True,
            **options,
        )
    if run.attrs["status"] == "interrupted":
        run.close()
        raise KeyboardInterrupt
    loaded: xr.Dataset = run.load()
    run.close()
    loaded.encoding["source"] = str(path)
    return loaded


def content_hash(identity: Any) -> str:
    """Return a hash of plain values, the same wherever they are equal."""
    return hashlib.sha256(json.dumps(identity, sort_keys=True).encode()).hexdigest()


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
