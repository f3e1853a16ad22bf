"""New cells for `infer.py`: runs of a bank's prior with other seeds, filmed by `cellcrawl.observe`.

A film begins anywhere in a run, as a look at a bank does, and a run is as long as the bank's.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

import cellcrawl as cc
from cellcrawl.infer import films
from cellcrawl.infer.cells import Cell, cells_of
from cellcrawl.infer.trained import Calibration

TIME = (0.625, 1.6, "log")  # of 1/k_off0: as wide as the paper's prior, in its own unit
LENGTH = 37.0  # of a film
SAVE_EVERY = 0.1  # and more nodes than a bank's: a film owes nothing to the bank's records
NODES = 192
_FIELDS = ["x", "y", "centroid_x", "centroid_y"]


@dataclass(frozen=True)
class Camera:
    """How a cell is filmed, in the model's units."""

    outlines: bool = True
    pixel: float = 0.0
    error: float = 0.0
    frame: float = 0.25
    length: float = LENGTH

    @property
    def frames(self) -> int:
        """Number of frames."""
        return 1 + round(self.length / self.frame)


PIXELS = Camera(pixel=0.1, error=0.05, frame=0.5)
CAMERAS = {
    "outlines, noise-free": Camera(),
    "track, noise-free": Camera(outlines=False),
    "outlines, pixel 0.1, error 0.05, frames of 0.5": PIXELS,
    "track, error 0.05, frames of 0.5": replace(PIXELS, pixel=0.0, outlines=False),
}
MICROSCOPES = {
    "pixel 0.1, error 0.05, frame 0.5, length 37": PIXELS,
    "frame 0.25": replace(PIXELS, frame=0.25),
    "frame 1": replace(PIXELS, frame=1.0),
    "frame 2": replace(PIXELS, frame=2.0, length=36.0),
    "pixel 0.05": replace(PIXELS, pixel=0.05),
    "pixel 0.2": replace(PIXELS, pixel=0.2),
    "pixel 0.4": replace(PIXELS, pixel=0.4),
    "no error": replace(PIXELS, error=0.0),
    "error 0.1": replace(PIXELS, error=0.1),
    "length 18": replace(PIXELS, length=18.0),
    "length 9": replace(PIXELS, length=9.0),
}


@dataclass(frozen=True)
class Fresh:
    """A new run, the unit of time it is filmed in, and when in it a film begins, 0 to 1."""

    run: xr.Dataset
    point: np.ndarray
    unit: float
    begin: float

    @property
    def there(self) -> float:
        """Longest film of it that a bank would show."""
        late = float(self.run["time"].values[-1]) - films.TRANSIENT
        return films.SAVE_EVERY * np.floor(late / films.SAVE_EVERY + 1e-9)

    def cell(self, camera: Camera, seed: int = 0) -> Cell | None:
        """Film it; None if it ends before the film."""
        needed = (camera.frames - 1) * camera.frame / self.unit
        spare = self.there - needed
        if spare < 0.0:
            return None
        at = films.TRANSIENT + self.begin * spare + np.linspace(0.0, needed, camera.frames)
        film = self.run.interp(time=at, method="cubic", kwargs={"fill_value": "extrapolate"})
        film = film.assign_coords(time=1e3 + camera.frame * np.arange(camera.frames))
        if camera.pixel > 0.0:
            seen = cc.observe(
                film, pixel=camera.pixel, error=camera.error, frame=camera.frame, seed=seed
            )
            (cell,) = cells_of(seen)
        else:
            (cell,) = cells_of(film)
            noise = np.random.default_rng(seed).standard_normal((2, len(cell.path)))
            path = cell.path + camera.error * (noise[0] + 1j * noise[1])
            cell = Cell(cell.name, cell.frame, path, cell.modes, 0.0, True)
        return cell if camera.outlines else cell.track_alone()


def run_of(bank: Any, point: np.ndarray, seed: int, **world: Any) -> xr.Dataset | None:
    """Return the run of a cell as long as the bank's, None if it never comes to be filmed."""
    named = dict(zip(bank.prior.cell_names, (float(v) for v in point), strict=True))
    options = {} if "solver" in world else {"rtol": 1e-3}
    try:
        run = cc.simulate(
            cc.Parameters(**named), float(bank.header["t_end"]), save_every=SAVE_EVERY, nodes=NODES,
            start=cc.RandomPerturbation(seed=seed), **options, **world,
        )  # fmt: skip
    except cc.InputError:
        return None
    if run.attrs["status"] != "completed":  # the closing record is off the grid
        run = run.isel(time=slice(None, -1))
    return run[_FIELDS].astype(np.float32).load() if run.sizes["time"] > 1 else None


def fresh(bank: Any, count: int, seed: int, camera: Camera, **world: Any) -> list[Fresh]:
    """Return new cells of the prior that live as long as the film and move in it."""
    return at_points(
        bank,
        count,
        seed,
        camera,
        lambda tried: bank.prior.draw(range(tried, tried + 1), seed)[0],
        **world,
    )


def at_points(
    bank: Any, count: int, seed: int, camera: Camera, point_of: Any, unit: float | None = None,
    **world: Any,
) -> list[Fresh]:  # fmt: skip
    """Return new cells at points given by number; a known unit of time unless it is drawn."""
    found: list[Fresh] = []
    span = cc.infer.Range(*TIME)
    for tried in range(20 * count):
        if len(found) == count:
            break
        random = np.random.default_rng((seed, tried))
        point = point_of(tried)
        drawn = float(span.value(random.random())) if unit is None else unit
        run = run_of(bank, point, int(random.integers(2**40)), **world)
        if run is None:
            continue
        one = Fresh(run, point, drawn, random.random())
        cell = one.cell(camera)
        if cell is None:
            continue
        try:
            cc.infer.fitting.microscope_of([cell], bank, TIME, 1.0)
        except cc.InputError:  # it rests
            continue
        found.append(one)
    return found


def filmed(cells: list[Fresh], camera: Camera) -> list[Cell]:
    """Return the films of cells that live as long."""
    return [one.cell(camera, i) for i, one in enumerate(cells)]  # type: ignore[misc]


def described(one: Calibration) -> dict[str, Any]:
    """Return a calibration as plain values by parameter."""
    return {
        name: {
            "R2": round(float(one.recovered[i]), 4),
            "coverage": {f"{level:g}": round(float(c[i]), 4) for level, c in one.levels.items()},
            "rank p": round(float(one.evenness[i]), 4),
        }
        for i, name in enumerate(one.names)
    }
