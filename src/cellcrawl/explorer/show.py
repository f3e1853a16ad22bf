"""Show the live cell: in a browser, in a notebook, or as a file."""

from __future__ import annotations

import base64
import html
import tempfile
import webbrowser
from importlib import metadata, resources
from pathlib import Path
from typing import Any, Final

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.data import decode_attribute
from cellcrawl.data.units import units_of
from cellcrawl.errors import InputError, StorageError
from cellcrawl.explorer import bundle, links
from cellcrawl.modes import FEWEST_RECORDS, classify
from cellcrawl.observables.inputs import records_with
from cellcrawl.parameters import Parameters
from cellcrawl.validation import one_of, shown, whole_number

MODULE: Final = "solver.wasm"
VIEWS: Final = ("full", "small", "bare")
_POINTS: Final = 256
_FRAMES: Final = 400
_FIELDS: Final = {
    "bound_fraction": "",
    "off_rate": "rate",
    "friction": "friction",
    "curvature": "curvature",
    "normal_velocity": "velocity",
}
_WHOLE: Final = {"tension": "tension", "length": "length", "area": "area"}
_HEIGHTS: Final = {"full": 1100, "small": 440, "bare": 380}


class Explorer:
    """The page of a cell: shows itself in a notebook, opens in a browser, can be saved.

    Attributes
    ----------
    text : str
        The whole page, one file that needs nothing else.
    view : str
        How much of it a notebook shows: "full", "small" or "bare".
    """

    def __init__(self, text: str, view: str) -> None:
        self.text, self.view = text, view

    def save(self, path: str | Path) -> Path:
        """Write the page to a file and return its path.

        Raises
        ------
        StorageError
            If it cannot be written.
        """
        place = Path(path)
        try:
            place.write_text(self.text, "utf-8")
        except OSError as error:
            raise StorageError(f"{place} cannot be written: {error.strerror or error}") from None
        return place

    def open(self) -> Path:
        """Write the page to a temporary file, open it in the browser, and return its path."""
        place = self.save(Path(tempfile.mkdtemp(prefix="cellcrawl-")) / "cell.html")
        webbrowser.open(place.as_uri())
        return place

    def _repr_html_(self) -> str:
        return (
            f'<iframe srcdoc="{html.escape(self.text)}" width="100%" height="{_HEIGHTS[self.view]}"'
            ' style="border:0" title="A crawling cell, computed live"></iframe>'
        )


@checked
def explore(what: Any = None, *, seed: int = 2, view: str = "small") -> Explorer:
    """Return the live cell: a page on which this package's solver runs in the browser.

    Parameters
    ----------
    what : Parameters, Dataset or str, optional
        The cell to begin with; a run, which is played back; or a link of the page. A zigzagging
        cell of the paper unless given.
    seed : int
        Seed of the random start, 0 or more.
    view : {"small", "full", "bare"}
        How much of the page to show first: the cell with its map, everything, or the cell alone.

    Returns
    -------
    Explorer
        Shows itself in a notebook; ``.open()`` opens it in a browser, ``.save(path)`` writes it.

    Raises
    ------
    InputError
        For anything else, or a run of fewer than two records.

    Notes
    -----
    A run is played back from at most 400 of its records, with 256 points of its edge.

    Examples
    --------
    >>> from cellcrawl import Parameters
    >>> page = explore(Parameters(r_on=24, zeta_1=540))
    """
    from cellcrawl.explorer.content import content  # brings matplotlib

    one_of("view", view, VIEWS)
    whole_number("seed", seed, 0, 10**15 - 1)
    about = {**content(), "version": metadata.version("cellcrawl"), "begin": f"view={view}"}
    if what is None:
        what = Parameters(r_on=26.0, zeta_1=600.0)
    if isinstance(what, Parameters):
        about["begin"] = links.write(what, seed, view=view)
    elif isinstance(what, str):
        links.read(what)
        about["begin"] = f"{what.rpartition('#')[2]}&view={view}"
    elif isinstance(what, xr.Dataset):
        about["run"] = _recording(what)
    else:
        raise InputError(f"explore takes Parameters, a run or a link, not {shown(what)}")
    return Explorer(bundle.page(shipped_module(), about), view)


def shipped_module() -> bytes:
    """Return the compiled solver that comes with the package."""
    return resources.files("cellcrawl.explorer").joinpath(MODULE).read_bytes()


def _recording(dataset: xr.Dataset) -> dict[str, Any]:
    """Return what a page needs to play a run back, in the model's own units."""
    run = records_with(dataset, "x", "y", "centroid_x", "centroid_y", *_FIELDS, *_WHOLE, at_least=2)
    one = units_of(dataset).one

    def size(kind: str) -> float:
        found = one(kind) if kind else 1.0
        return found if np.isfinite(found) else 1.0

    every = max(1, -(-(run.sizes["time"] - 1) // (_FRAMES - 1)))
    some = run.isel(time=slice(None, None, every))
    nodes = some.sizes["node"]
    at = np.arange(_POINTS) * nodes / _POINTS

    def on_points(name: str) -> np.ndarray:
        values = some[name].values
        closed = np.concatenate([values, values[:, :1]], axis=1)
        return np.array([np.interp(at, np.arange(nodes + 1), row) for row in closed])

    center = {axis: some[f"centroid_{axis}"].values for axis in "xy"}
    arrays = {axis: (on_points(axis) - center[axis][:, None]) / size("length") for axis in "xy"}
    arrays |= {name: on_points(name) / size(kind) for name, kind in _FIELDS.items()}
    named = classify(dataset) if dataset.sizes["time"] >= FEWEST_RECORDS else None
    return {
        "t": (some["time"].values / size("time")).tolist(),
        **{f"centroid_{a}": (center[a] / size("length")).tolist() for a in "xy"},
        **{name: (some[name].values / size(kind)).tolist() for name, kind in _WHOLE.items()},
        "fields": {name: _packed(values) for name, values in arrays.items()},
        "parameters": decode_attribute(dataset, "parameters"),
        "status": str(dataset.attrs.get("status", "completed")),
        "mode": named.mode if named else "",
        "confidence": named.confidence if named else 0.0,
        "words": named.summary() if named else "",
    }


def _packed(values: np.ndarray) -> dict[str, Any]:
    """Return numbers (frame, point) as 16 bits each, with the two that the ends stand for."""
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    span = high - low if high > low else 1.0
    whole = np.nan_to_num((values - low) / span * 65535.0).round().astype("<u2")
    return {"low": low, "span": span, "data": base64.b64encode(whole.tobytes()).decode()}
