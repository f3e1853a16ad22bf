"""A branch as one file, written as it grows: it goes on after a kill and says if damaged."""

from __future__ import annotations

import contextlib
import json
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Final, Self

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked, file_path
from cellcrawl.branches.branch import Branch
from cellcrawl.branches.mesh import Mesh
from cellcrawl.branches.points import SpecialPoint
from cellcrawl.branches.setting import Setting
from cellcrawl.branches.state import SteadyState
from cellcrawl.branches.system import System
from cellcrawl.errors import InputError, StorageError
from cellcrawl.laws import as_law
from cellcrawl.locks import locked
from cellcrawl.parameters import Parameters
from cellcrawl.simulation.checksums import damaged, digest
from cellcrawl.simulation.dataset import package_version

if TYPE_CHECKING:
    from cellcrawl.branches.continuation import Walker

KIND: Final = "cellcrawl branch"
SCHEMA: Final = 1
_PAUSE = 2.0  # seconds between two writes
_SUFFIXES: Final = (".nc",)


class FileKeeper:
    """Holds the file that a branch is written to while it grows; none without a path."""

    def __init__(self, path: str | Path | None, overwrite: bool, what: str, resume: str) -> None:
        self.path = None if path is None else file_path("output", path)
        self._stack = contextlib.ExitStack()
        if self.path is None:
            return
        if self.path.suffix not in _SUFFIXES:
            raise InputError(f"output = {str(self.path)!r}: {what} a file that ends in .nc")
        if self.path.exists() and not overwrite:
            raise InputError(
                f"{self.path} exists: give another output, go on with {resume}, or ask to "
                "overwrite it"
            )

    def __enter__(self) -> Self:
        if self.path is not None:
            lock = self.path.with_name(self.path.name + ".lock")
            self._stack.enter_context(locked(lock, self.path, remove=True))
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._stack.close()


class Keeper(FileKeeper):
    """Writes a branch now and then while it grows; does nothing without a path."""

    def __init__(self, path: str | Path | None, overwrite: bool) -> None:
        super().__init__(path, overwrite, "a branch is", "resume_branch")
        self._written = 0.0

    def keep(self, branch: Branch, walker: Walker, *, last: bool = False) -> None:
        """Write the branch if it is the last time, or some seconds after the time before."""
        if self.path is None or not (last or time.monotonic() - self._written > _PAUSE):
            return
        write(branch, walker, self.path)
        self._written = time.monotonic()


def write(branch: Branch, walker: Walker, path: Path) -> None:
    """Write a branch, in the place of what is there only once all is written."""
    first = branch.states[0]
    header: dict[str, Any] = {
        "name": branch.name,
        "to": branch.to,
        "status": branch.status,
        "message": branch.message,
        "spectra": branch.spectra,
        "mirror": first.system.mirror,
        "parameters": first.parameters.to_dict(),
        "laws": first.setting.laws.describe(),
        "rest_area": first.setting.rest_area,
        "weight": walker.weight,
        "step": walker.step,
        "symmetries": list(first.eigenvalues_by_symmetry) if branch.spectra else [],
        "points": [
            {
                "kind": point.kind,
                "symmetry": point.symmetry,
                "value": point.value,
                "frequency": point.frequency,
                "position": point.position,
                "has_vector": point.vector is not None,
            }
            for point in branch.special_points
        ],
    }
    everyone = [*branch.states, *(point.state for point in branch.special_points), walker.state]
    header["meshes"] = [
        [s.mesh.nodes, list(s.mesh.places), s.mesh.sharpness, s.mesh.share] for s in everyone
    ]
    vectors = [p.vector for p in branch.special_points if p.vector is not None]
    arrays: dict[str, np.ndarray] = {
        "value": np.array([s.setting.value(branch.name) for s in everyone]),
        "tangent": walker.tangent,
        **ragged("unknowns", [s.unknowns for s in everyone]),
        **ragged("phi", [s.phi for s in everyone]),
        **complex_arrays("vector", vectors),
    }
    if branch.spectra:
        for k, symmetry in enumerate(header["symmetries"]):
            values = [s.eigenvalues_by_symmetry[symmetry] for s in branch.states]
            arrays |= complex_arrays(f"eigenvalues_{k}", values)
        arrays |= complex_arrays("neutral", [s.neutral_eigenvalues for s in branch.states])
    write_arrays(path, KIND, SCHEMA, header, arrays)


def write_arrays(
    path: Path, kind: str, schema: int, header: dict[str, Any], arrays: dict[str, np.ndarray]
) -> None:
    """Write arrays and a header with a checksum, in the place of what is there once all is done."""
    attributes: dict[str, Any] = {
        "kind": kind,
        "branch_schema": schema,
        "cellcrawl_version": package_version(),
        "branch": json.dumps(header),
    }
    attributes["checksum"] = digest(attributes, {}, arrays)
    dataset = xr.Dataset(
        {name: (f"{name}_entry", array) for name, array in arrays.items()}, attrs=attributes
    )
    encoding = {name: {"fletcher32": True} for name, array in arrays.items() if array.size}
    beside = path.with_name(path.name + ".part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        dataset.to_netcdf(beside, engine="h5netcdf", encoding=encoding)
        beside.replace(path)
    except OSError as error:
        with contextlib.suppress(OSError):
            beside.unlink(missing_ok=True)
        raise StorageError(f"cannot write {path}: {error.strerror or error}") from None


def read_arrays(
    path: Path, kind: str, schema: int, missing: str, other: str
) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """Return header and arrays of what `write_arrays` wrote, once its checksum is right."""
    if not path.exists():
        raise InputError(missing)
    try:
        with xr.open_dataset(path, engine="h5netcdf") as saved:
            attributes = dict(saved.attrs)
            arrays = {str(name): saved[name].values for name in saved.data_vars}
    except Exception as error:  # HDF5 and its readers have many
        raise StorageError(f"{path} cannot be read: {type(error).__name__}") from None
    if attributes.get("kind") != kind:
        raise InputError(other)
    if int(attributes.get("branch_schema", 0)) > schema:
        raise StorageError(f"{path} was written by a newer cellcrawl: update cellcrawl")
    told = attributes.pop("checksum", None)
    attributes["branch_schema"] = int(attributes["branch_schema"])
    if told != digest(attributes, {}, arrays):
        raise damaged(path)
    return json.loads(attributes["branch"]), arrays


def setting_of(header: dict[str, Any]) -> Setting:
    """Return the setting that a header tells."""
    return Setting(
        Parameters.from_dict(header["parameters"]), as_law(header["laws"]), header["rest_area"]
    )


@checked
def open_branch(path: str | Path) -> Branch:
    """Return the branch in a file.

    Raises
    ------
    InputError
        If there is none, or its law is not on this machine.
    StorageError
        If the file is damaged, or of a newer version.
    """
    return _read(Path(path))[0]


@checked
def resume_branch(
    path: str | Path, to: float | None = None, *, most_states: int = 400, largest_step: float = 0.12
) -> Branch:
    """Go on with a branch in a file, one that was killed or one that is to go further.

    Parameters
    ----------
    path : str or Path
        The file.
    to : float, optional
        A new value of the parameter at which to stop.
    most_states, largest_step
        As in `continue_in`.
    """
    from cellcrawl.branches.continuation import walk
    from cellcrawl.branches.setting import bounds_of
    from cellcrawl.validation import real_number

    branch, walker = _read(Path(path))
    if to is not None:
        low, high = bounds_of(walker.state.setting.laws, branch.name)
        branch.to = real_number(f"to ({branch.name})", to, low, high)
    elif branch.status not in ("running", "interrupted", "states"):
        return branch
    branch.status = "running"
    return walk(branch, walker, most_states, largest_step, path, True)


def _read(path: Path) -> tuple[Branch, Walker]:
    from cellcrawl.branches.continuation import Walker

    header, arrays = read_arrays(
        path, KIND, SCHEMA, f"there is no branch at {path}", f"{path} holds no branch of cellcrawl"
    )
    name, base = header["name"], setting_of(header)
    unknowns, phis = parts_of(arrays, "unknowns"), parts_of(arrays, "phi")
    states = [
        SteadyState(
            base.replace(name, float(value)),
            System(Mesh(int(nodes), tuple(places), sharpness, share), header["mirror"]),
            y,
            phi,
        )
        for value, (nodes, places, sharpness, share), y, phi in zip(
            arrays["value"], header["meshes"], unknowns, phis, strict=True
        )
    ]
    count = len(states) - len(header["points"]) - 1
    if header["spectra"]:
        neutral = complex_parts(arrays, "neutral")
        for k, symmetry in enumerate(header["symmetries"]):
            found = complex_parts(arrays, f"eigenvalues_{k}")
            for state, values in zip(states, found, strict=False):
                state._spectrum.setdefault("eigenvalues", {})[symmetry] = values
        for state, values in zip(states, neutral, strict=False):
            state._spectrum["neutral"] = values
    branch = Branch(name, header["to"], states[:count], spectra=header["spectra"])
    branch.status, branch.message = header["status"], header["message"]
    vectors = iter(complex_parts(arrays, "vector"))
    for point, state in zip(header["points"], states[count:-1], strict=True):
        vector = next(vectors) if point.pop("has_vector") else None
        branch.special_points.append(SpecialPoint(name=name, state=state, vector=vector, **point))
    walker = Walker(name, header["weight"], states[-1], arrays["tangent"], header["step"])
    last = branch.states[-1]
    if np.array_equal(last.unknowns, walker.state.unknowns):
        walker.state = last
    return branch, walker


def ragged(name: str, parts: Sequence[np.ndarray]) -> dict[str, np.ndarray]:
    """Return arrays of different sizes as one, and their sizes."""
    sizes = np.array([part.size for part in parts], dtype=np.int64)
    return {name: np.concatenate([np.zeros(0), *parts]), f"{name}_sizes": sizes}


def complex_arrays(name: str, parts: Sequence[np.ndarray]) -> dict[str, np.ndarray]:
    """Return complex arrays of different sizes as real ones."""
    real = ragged(f"{name}_real", [np.asarray(part.real) for part in parts])
    imaginary = [np.asarray(part.imag, dtype=float) for part in parts]
    return {**real, f"{name}_imag": np.concatenate([np.zeros(0), *imaginary])}


def parts_of(arrays: Mapping[str, np.ndarray], name: str) -> list[np.ndarray]:
    """Return what `ragged` made one array of."""
    ends = np.cumsum(arrays[f"{name}_sizes"])
    return np.split(arrays[name], ends[:-1]) if ends.size else []


def complex_parts(arrays: Mapping[str, np.ndarray], name: str) -> list[np.ndarray]:
    """Return what `complex_arrays` made real."""
    sizes = arrays[f"{name}_real_sizes"]
    values = arrays[f"{name}_real"] + 1j * arrays[f"{name}_imag"]
    return np.split(values, np.cumsum(sizes)[:-1]) if sizes.size else []
