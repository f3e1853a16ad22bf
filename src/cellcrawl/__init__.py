"""Simulate how single cells crawl.

A deformable cell edge, force-sensitive adhesions that stick and slip, and one membrane tension that
ties the edge together (Chen, Saintillan & Rangamani, PRX Life 1, 023007, 2023).
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cellcrawl import branches as branches
    from cellcrawl import curve as curve
    from cellcrawl import data as data
    from cellcrawl import infer as infer
    from cellcrawl import laws as laws
    from cellcrawl import linear as linear
    from cellcrawl import microscopy as microscopy
    from cellcrawl import modes as modes
    from cellcrawl import observables as observables
    from cellcrawl import one_dimensional as one_dimensional
    from cellcrawl import parameters as parameters
    from cellcrawl import plot as plot
    from cellcrawl import reproduction as reproduction
    from cellcrawl import solvers as solvers
    from cellcrawl import starts as starts
    from cellcrawl import surroundings as surroundings
    from cellcrawl import sweeps as sweeps
    from cellcrawl import verification as verification
    from cellcrawl.citing import cite as cite
    from cellcrawl.curve import Curve as Curve
    from cellcrawl.errors import CellcrawlError as CellcrawlError
    from cellcrawl.errors import InputError as InputError
    from cellcrawl.errors import StorageError as StorageError
    from cellcrawl.explorer import explore as explore
    from cellcrawl.microscopy import observe as observe
    from cellcrawl.microscopy import read_outlines as read_outlines
    from cellcrawl.microscopy import read_tracks as read_tracks
    from cellcrawl.microscopy import write_outlines as write_outlines
    from cellcrawl.microscopy import write_tracks as write_tracks
    from cellcrawl.modes import classify as classify
    from cellcrawl.modes import classify_track as classify_track
    from cellcrawl.movies import movie as movie
    from cellcrawl.parameters import ActivationEnergies as ActivationEnergies
    from cellcrawl.parameters import Parameters as Parameters
    from cellcrawl.parameters import PhysicalParameters as PhysicalParameters
    from cellcrawl.parameters import Scales as Scales
    from cellcrawl.parameters import Schedule as Schedule
    from cellcrawl.simulation import FromRun as FromRun
    from cellcrawl.simulation import open_run as open_run
    from cellcrawl.simulation import resume as resume
    from cellcrawl.simulation import simulate as simulate
    from cellcrawl.starts import CellState as CellState
    from cellcrawl.starts import Eigenmode as Eigenmode
    from cellcrawl.starts import FromOutline as FromOutline
    from cellcrawl.starts import PerturbedCircle as PerturbedCircle
    from cellcrawl.starts import RandomPerturbation as RandomPerturbation
    from cellcrawl.starts import Start as Start
    from cellcrawl.sweeps import Grid as Grid
    from cellcrawl.sweeps import Sweep as Sweep
    from cellcrawl.sweeps import open_sweep as open_sweep
    from cellcrawl.sweeps import sweep as sweep

# Where each public name lives; loaded on first use, so that `import cellcrawl` stays light.
_HOMES = {
    "ActivationEnergies": "parameters",
    "CellState": "starts",
    "CellcrawlError": "errors",
    "Curve": "curve",
    "Eigenmode": "starts",
    "FromOutline": "starts",
    "FromRun": "simulation",
    "Grid": "sweeps",
    "InputError": "errors",
    "Parameters": "parameters",
    "PerturbedCircle": "starts",
    "PhysicalParameters": "parameters",
    "RandomPerturbation": "starts",
    "Scales": "parameters",
    "Schedule": "parameters",
    "Start": "starts",
    "StorageError": "errors",
    "cite": "citing",
    "classify": "modes",
    "explore": "explorer",
    "classify_track": "modes",
    "Sweep": "sweeps",
    "movie": "movies",
    "open_run": "simulation",
    "open_sweep": "sweeps",
    "observe": "microscopy",
    "read_outlines": "microscopy",
    "read_tracks": "microscopy",
    "resume": "simulation",
    "simulate": "simulation",
    "sweep": "sweeps",
    "write_outlines": "microscopy",
    "write_tracks": "microscopy",
}
_MODULES = (
    "branches",
    "infer",
    "laws",
    "linear",
    "microscopy",
    "modes",
    "observables",
    "one_dimensional",
    "plot",
    "surroundings",
    "sweeps",
)
# Modules of which the reference names a part; their other functions check no arguments.
_INNER = ("curve", "data", "parameters", "reproduction", "solvers", "starts", "verification")

__all__ = [*_HOMES, *_MODULES, "__version__"]


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        value = getattr(importlib.import_module(f"cellcrawl.{_HOMES[name]}"), name)
    elif name in _MODULES or name in _INNER:
        value = importlib.import_module(f"cellcrawl.{name}")
    elif name == "__version__":
        value = importlib.import_module("importlib.metadata").version("cellcrawl")
    else:
        raise AttributeError(f"module 'cellcrawl' has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*__all__, *_INNER])
