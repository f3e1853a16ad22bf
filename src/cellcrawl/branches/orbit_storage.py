"""A branch of orbits as one file, written as it grows: it goes on after a kill."""

from __future__ import annotations

import contextlib
import json
from pathlib import Path
from types import TracebackType
from typing import Any, Final, Self

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked, file_path
from cellcrawl.branches.orbit import Orbit
from cellcrawl.branches.orbit_branch import OrbitBranch, OrbitPoint, OrbitWalker, walk
from cellcrawl.branches.setting import Setting, bounds_of
from cellcrawl.branches.shooting import Basis
from cellcrawl.branches.storage import complex_arrays, complex_parts, parts_of, ragged, write_arrays
from cellcrawl.errors import InputError, StorageError
from cellcrawl.laws import as_law
from cellcrawl.locks import locked
from cellcrawl.parameters import Parameters
from cellcrawl.simulation.checksums import damaged, digest
from cellcrawl.validation import real_number

KIND: Final = "cellcrawl orbits"
SCHEMA: Final = 1
_RESUMABLE = ("running", "interrupted", "orbits")


class Keeper:
    """Writes a branch of orbits while it grows; does nothing without a path."""

    def __init__(self, path: str | Path | None, overwrite: bool) -> None:
        self._path = None if path is None else file_path("output", path)
        self._stack = contextlib.ExitStack()
        if self._path is None:
            return
        if self._path.suffix != ".nc":
            raise InputError(f"output = {str(self._path)!r}: orbits are a file that ends in .nc")
        if self._path.exists() and not overwrite:
            raise InputError(
                f"{self._path} exists: give another output, go on with resume_orbits, or ask to "
                "overwrite it"
            )

    def __enter__(self) -> Self:
        if self._path is not None:
            lock = self._path.with_name(self._path.name + ".lock")
            self._stack.enter_context(locked(lock, self._path, remove=True))
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._stack.close()

    def keep(self, branch: OrbitBranch, walker: OrbitWalker) -> None:
        """Write the branch."""
        if self._path is not None:
            write(branch, walker, self._path)


def write(branch: OrbitBranch, walker: OrbitWalker, path: Path) -> None:
    """Write a branch of orbits, in the place of what is there only once all is written."""
    first = branch.orbits[0]
    everyone = [*branch.orbits, *(point.orbit for point in branch.special_points)]
    header: dict[str, Any] = {
        "name": branch.name,
        "to": branch.to,
        "status": branch.status,
        "message": branch.message,
        "spectra": branch.spectra,
        "reflected": first.reflected,
        "parameters": first.parameters.to_dict(),
        "laws": first.setting.laws.describe(),
        "rest_area": first.setting.rest_area,
        "step": walker.step,
        "orbits": len(branch.orbits),
        "nodes": branch.nodes,
        "points": [
            {
                "kind": point.kind,
                "value": point.value,
                "multiplier": [point.multiplier.real, point.multiplier.imag],
                "position": point.position,
            }
            for point in branch.special_points
        ],
        "each": [[one.nodes, one.steps, one.basis.along.size] for one in everyone],
    }
    arrays: dict[str, np.ndarray] = {
        "value": np.array([one.setting.value(branch.name) for one in everyone]),
        "period": np.array([one.period for one in everyone]),
        "residual": np.array([one.residual for one in everyone]),
        "tangent": walker.tangent,
        **ragged("shape", [one.shape for one in everyone]),
        **ragged("basis_vectors", [one.basis.vectors.ravel() for one in everyone]),
        **ragged("basis_matrix", [one.basis.matrix.ravel() for one in everyone]),
        **ragged("basis_along", [one.basis.along for one in everyone]),
    }
    if branch.spectra:
        arrays |= complex_arrays("multipliers", [one.multipliers for one in everyone])
        arrays["neutral"] = np.array([one.neutral_multipliers[0] for one in everyone])
    write_arrays(path, KIND, SCHEMA, header, arrays)


@checked
def open_orbits(path: str | Path) -> OrbitBranch:
    """Return the branch of orbits in a file.

    Raises
    ------
    InputError
        If there is none, or its law is not on this machine.
    StorageError
        If the file is damaged, or of a newer version.
    """
    return _read(Path(path))[0]


@checked
def resume_orbits(
    path: str | Path, to: float | None = None, *, most_orbits: int = 60, largest_step: float = 0.06
) -> OrbitBranch:
    """Go on with a branch of orbits in a file, one that was killed or one that is to go further."""
    branch, walker = _read(Path(path))
    if to is not None:
        low, high = bounds_of(branch.orbits[0].setting.laws, branch.name)
        branch.to = real_number(f"to ({branch.name})", to, low, high)
    elif branch.status not in _RESUMABLE:
        return branch
    branch.status = "running"
    return walk(branch, walker, most_orbits, largest_step, path, True)


def _read(path: Path) -> tuple[OrbitBranch, OrbitWalker]:
    if not path.exists():
        raise InputError(f"there are no orbits at {path}")
    try:
        with xr.open_dataset(path, engine="h5netcdf") as saved:
            attributes = dict(saved.attrs)
            arrays = {str(name): saved[name].values for name in saved.data_vars}
    except Exception as error:  # HDF5 and its readers have many
        raise StorageError(f"{path} cannot be read: {type(error).__name__}") from None
    if attributes.get("kind") != KIND:
        raise InputError(f"{path} holds no orbits of cellcrawl")
    if int(attributes.get("branch_schema", 0)) > SCHEMA:
        raise StorageError(f"{path} was written by a newer cellcrawl: update cellcrawl")
    told = attributes.pop("checksum", None)
    attributes["branch_schema"] = int(attributes["branch_schema"])
    if told != digest(attributes, {}, arrays):
        raise damaged(path)
    header = json.loads(attributes["branch"])
    name = header["name"]
    base = Setting(
        Parameters.from_dict(header["parameters"]), as_law(header["laws"]), header["rest_area"]
    )
    kept: list[dict[str, Any]] = [{} for _ in header["each"]]
    if header["spectra"]:
        found = complex_parts(arrays, "multipliers")
        for one, values, neutral in zip(kept, found, arrays["neutral"], strict=True):
            one["multipliers"], one["neutral"] = values, float(neutral)
    parts = [parts_of(arrays, f"basis_{part}") for part in ("vectors", "matrix", "along")]
    shapes = parts_of(arrays, "shape")
    orbits = []
    for k, (nodes, steps, count) in enumerate(header["each"]):
        basis = Basis(
            parts[0][k].reshape(-1, count), parts[1][k].reshape(count, count), parts[2][k]
        )
        setting = base.replace(name, float(arrays["value"][k]))
        period, residual = float(arrays["period"][k]), float(arrays["residual"][k])
        shape, reflected = shapes[k], header["reflected"]
        orbits.append(
            Orbit(setting, reflected, shape, period, nodes, steps, residual, basis, kept[k])
        )
    many = header["orbits"]
    branch = OrbitBranch(name, header["to"], orbits[:many], spectra=header["spectra"])
    branch.nodes = header["nodes"]
    branch.status, branch.message = header["status"], header["message"]
    for point, here in zip(header["points"], orbits[many:], strict=True):
        multiplier = complex(*point.pop("multiplier"))
        branch.special_points.append(
            OrbitPoint(name=name, orbit=here, multiplier=multiplier, **point)
        )
    return branch, OrbitWalker(arrays["tangent"], header["step"])
