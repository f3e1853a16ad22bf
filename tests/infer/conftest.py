"""Banks of made-up films: made by the same way as real ones, but for the solver."""

import functools

import numpy as np
import pytest
import xarray as xr

import cellcrawl as cc
from cellcrawl.infer import films, regression
from cellcrawl.sweeps.executors import InProcess
from cellcrawl.sweeps.worker import Outcome

PRIOR = cc.infer.Prior(
    {
        "r_on": (15.0, 40.0),
        "epsilon": (5e-4, 2e-3, "log"),
        "time_unit": (0.8, 1.25, "log"),
    }
)
T_END = 40.0


def swimmer(r_on, epsilon, seed, t_end=T_END, step=films.SAVE_EVERY, turning=0.0):
    """An ellipse that moves at 200 epsilon and beats at a frequency and depth set by r_on."""
    random = np.random.default_rng(seed)
    every, step = round(step / films.SAVE_EVERY), films.SAVE_EVERY
    time = np.arange(0.0, t_end + 1e-9, step)
    phase, direction = random.uniform(0, 2 * np.pi, 2)
    beat = np.sin(2 * np.pi * time * r_on / 150 + phase)
    heading = direction + 0.02 * r_on * beat + turning * time
    path = np.cumsum(200 * epsilon * step * np.exp(1j * heading))
    around = 2 * np.pi * np.arange(films.NODES) / films.NODES
    stretch = 0.1 + 0.004 * r_on * (1 + 0.3 * beat)
    # Stretched across its heading, and blunter in front.
    edge = (
        np.exp(1j * around) - stretch[:, None] * np.exp(-1j * around) + 0.05 * np.exp(-2j * around)
    )
    # No two cells are quite alike: ruffles of a hundredth, in a few waves.
    ruffles = random.standard_normal((2, 8)) / 100 / np.arange(2, 10)
    waves = np.arange(2, 10)[:, None] * around
    paces = np.cos(random.uniform(0.5, 2, 8) * time[:, None] + random.uniform(0, 6, 8))
    depth = paces @ (ruffles[0][:, None] * np.cos(waves) + ruffles[1][:, None] * np.sin(waves))
    edge = (edge + depth * np.exp(1j * around)) * np.exp(1j * heading)[:, None] + path[:, None]
    whole = xr.Dataset(
        {
            "x": (("time", "node"), edge.real),
            "y": (("time", "node"), edge.imag),
            "centroid_x": ("time", path.real),
            "centroid_y": ("time", path.imag),
        },
        {"time": time},
    )
    return whole.isel(time=slice(None, None, every))


def at_rest(run):
    """The same shapes of a cell that stays where it is."""
    x, y = run.centroid_x - run.centroid_x[0], run.centroid_y - run.centroid_y[0]
    moved = {"x": run.x - x, "y": run.y - y, "centroid_x": 0 * x, "centroid_y": 0 * y}
    return run.assign(moved)


def swim(run, keep, turning=0.0):
    """What a bank's worker does, without a solver; few runs rest or tear."""
    seed = run.start.seed
    mode, status = "gliding", "completed"
    if seed % 20 == 3:
        mode = "stationary"
    if seed % 20 == 7:
        status = "fragmented"
    made = swimmer(run.parameters.r_on, run.parameters.epsilon, seed, run.t_end, turning=turning)
    made = made.isel(time=slice(60 if status == "fragmented" else None))
    if mode == "stationary":
        made = at_rest(made)
    return Outcome({"status": status, "mode": mode, "message": ""}, films.film_of(made))


def make_bank(runs, output, turning=0.0, **named):
    """Make a bank of made-up films."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(films, "execute", functools.partial(swim, turning=turning))
        return cc.infer.bank(PRIOR, runs, output, t_end=T_END, executor=InProcess(), **named)


@pytest.fixture(scope="session", autouse=True)
def _steps():
    """Train no longer than made-up films need; all alike, as what is learned is kept."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(regression, "_FEWEST_STEPS", 120)
        yield


@pytest.fixture(scope="session")
def made_up():
    return make_bank


@pytest.fixture(scope="session")
def bank(tmp_path_factory):
    return make_bank(160, tmp_path_factory.mktemp("bank") / "bank.h5")
