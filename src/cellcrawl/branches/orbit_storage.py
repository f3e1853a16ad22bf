"""A branch of orbits as one file, written as it grows: it goes on after a kill."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.branches.orbit import Orbit
from cellcrawl.branches.orbit_branch import OrbitBranch, OrbitPoint, OrbitWalker, walk
from cellcrawl.branches.setting import bounds_of
from cellcrawl.branches.shooting import Basis
from cellcrawl.branches.storage import (
    FileKeeper,
    complex_arrays,
    complex_parts,
    parts_of,
    ragged,
    read_arrays,
    setting_of,
    write_arrays,
)
from cellcrawl.validation import real_number

KIND: Final = "cellcrawl orbits"
SCHEMA: Final = 1
_RESUMABLE = ("running", "interrupted", "orbits")


class Keeper(FileKeeper):
    """Writes a branch of orbits while it grows; does nothing without a path."""

    def __init__(self, path: str | Path | None, overwrite: bool) -> None:
        super().__init__(path, overwrite, "orbits are", "resume_orbits")

    def keep(self, branch: OrbitBranch, walker: OrbitWalker) -> None:
        """Write the branch."""
        if self.path is not None:
            write(branch, walker, self.path)


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
    header, arrays = read_arrays(
        path, KIND, SCHEMA, f"there are no orbits at {path}", f"{path} holds no orbits of cellcrawl"
    )
    name, base = header["name"], setting_of(header)
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
