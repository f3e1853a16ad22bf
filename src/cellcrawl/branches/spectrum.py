"""Growth rates of small changes of a steady cell, those that mean nothing told apart.

Rotation and relabelling of a state are states too: known vectors that the linear flow sends to 0.
An edge that does not close is no cell: known rows that it multiplies by 0, or by the turning rate.
Both are taken out by projection; what is left are the growth rates of the cell. To drop "the
smallest" eigenvalues instead would drop, at a pitchfork, the very one that is looked for.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from cellcrawl.branches.equations import Fields, linear, measure, rates
from cellcrawl.branches.mesh import Mesh, Operators
from cellcrawl.branches.setting import Setting
from cellcrawl.threads import on_one_thread

SYMMETRIC, ANTISYMMETRIC, WHOLE = "symmetric", "antisymmetric", ""
_MARGINAL = 1e-7
_INDEPENDENT = 1e-6


@dataclass(frozen=True, eq=False)
class Block:
    """The linear flow on changes of one symmetry, in coordinates without what means nothing.

    Attributes
    ----------
    symmetry : str
        "symmetric", "antisymmetric" or, for a cell without a mirror axis, "".
    matrix : array, shape (m, m)
        Of changes ``(w, n, L)`` on the nodes that are kept, tension substituted.
    rows, columns : array, shape (m, ...)
        The closure rows and the vectors of rotation and relabelling.
    kept : array of int, shape (m,)
        Which entries of ``(w, n, L)`` on the nodes kept they are.
    """

    symmetry: str
    matrix: np.ndarray
    rows: np.ndarray
    columns: np.ndarray
    kept: np.ndarray

    @cached_property
    def basis(self) -> np.ndarray:
        """Orthonormal vectors across all that means nothing, shape (m, m - known)."""
        known = np.column_stack([self.rows, self.columns])
        known = known / np.maximum(np.linalg.norm(known, axis=0), 1e-300)
        vectors, sizes, _ = np.linalg.svd(known, full_matrices=True)
        count = int(np.sum(sizes > _INDEPENDENT))
        return np.asarray(vectors[:, count:])

    @cached_property
    @on_one_thread
    def reduced(self) -> np.ndarray:
        """The linear flow of the cell."""
        return np.asarray(self.basis.T @ self.matrix @ self.basis)

    @cached_property
    @on_one_thread
    def eigenvalues(self) -> np.ndarray:
        """Growth rates, complex, the largest real part first."""
        return ordered(np.linalg.eigvals(self.reduced))

    @cached_property
    def neutral(self) -> np.ndarray:
        """What the linear flow makes of rotation, relabelling and closure; 0 but for rounding."""
        found = []
        for side, matrix in ((self.columns, self.matrix), (self.rows, self.matrix.T)):
            if side.shape[1]:
                q, sizes, _ = np.linalg.svd(side, full_matrices=False)
                q = q[:, sizes > _INDEPENDENT * sizes[0]]
                found.append(np.linalg.eigvals(q.T @ matrix @ q))
        return np.concatenate(found) if found else np.zeros(0)

    @on_one_thread
    def near(self, value: complex, vector: np.ndarray | None = None) -> tuple[complex, np.ndarray]:
        """Return the eigenvalue nearest to ``value`` and its vector ``(w, n, L)`` of the block.

        By inverse iteration, from any ``vector`` of a state nearby.
        """
        matrix, size = self.reduced, self.reduced.shape[0]
        x: np.ndarray
        if vector is None:
            x = np.array(np.random.default_rng(0).normal(size=size), dtype=complex)
        else:
            x = self.basis.T @ np.asarray(vector, dtype=complex)
        x = x / np.linalg.norm(x)
        eye = np.eye(size)
        real = abs(value.imag) < 1e-12
        shift = complex(value.real if real else value)
        for _ in range(12):
            away = shift + 1e-10 * (1.0 + abs(shift)) * (1.0 if real else 1.0 + 1.0j)
            y = np.linalg.solve(matrix - away * eye, x)
            y /= np.linalg.norm(y)
            found = complex(y.conj() @ (matrix @ y))
            turned = abs(abs(y.conj() @ x) - 1.0)
            x, moved = y, abs(found - shift)
            shift = complex(found.real) if real else found
            if moved < 1e-13 * (1.0 + abs(shift)) or (turned < 1e-15 and moved < 1e-11):
                break
        return shift, self.basis @ x

    def on_nodes(self, vector: np.ndarray, count: int) -> np.ndarray:
        """Return a vector of the block as ``(w, n, L)`` on ``count`` nodes that are kept."""
        full = np.zeros(2 * count + 1, vector.dtype)
        full[self.kept] = vector
        return full


def ordered(values: np.ndarray) -> np.ndarray:
    """Return eigenvalues, the largest real part first, of a pair the positive imaginary part."""
    return np.asarray(values[np.lexsort((-values.imag, -np.round(values.real, 12)))])


def unstable_count(values: np.ndarray) -> int:
    """Return how many eigenvalues grow."""
    return int(np.sum(values.real > _MARGINAL))


@on_one_thread
def blocks(
    setting: Setting, mesh: Mesh, shape: Fields, phi: np.ndarray, slide: float, turn: float
) -> tuple[Block, ...]:
    """Return the linear flow at a steady whole shape, in two parts if it has a mirror axis.

    ``phi``, the guess of the force on the bonds, has half the edge's nodes then.
    """
    mirror = phi.size == mesh.kept
    parts: tuple[tuple[str, Operators], ...]
    if mirror:
        half = Fields(shape.w[: mesh.kept], shape.n[: mesh.kept], shape.length, shape.sigma)
        now = rates(setting, mesh.symmetric, half, phi)
        parts = ((SYMMETRIC, mesh.symmetric), (ANTISYMMETRIC, mesh.antisymmetric))
    else:
        half = shape
        now = rates(setting, mesh.whole, shape, phi, slide, turn)
        parts = ((WHOLE, mesh.whole),)
    of_whole = measure(mesh, shape.w, shape.length)
    slope = mesh.whole.angle_slope
    relabelled = np.concatenate([1.0 + slope @ shape.w, slope @ shape.n])
    turned = np.concatenate([np.ones(mesh.nodes), np.zeros(mesh.nodes)])
    made = []
    for symmetry, ops in parts:
        lin = linear(setting, ops, half, now)
        matrix = lin.matrix.copy()
        if symmetry != ANTISYMMETRIC:
            stiffness = setting.tension_rate
            area_by = _folded(mesh, of_whole.area_by, symmetry, -1.0)
            by = np.concatenate([area_by, np.zeros(half.n.size), [2 * of_whole.area / half.length]])
            matrix += np.outer(lin.by_sigma, stiffness * by)
        count = half.n.size
        kept = np.arange(2 * count + 1)
        if symmetry == SYMMETRIC:
            kept = kept[1:]
        elif symmetry == ANTISYMMETRIC:
            kept = np.delete(kept, [count, 2 * count])  # n at the axis, L
        rows, columns = [], []
        for k in range(2):
            if symmetry in (WHOLE, (ANTISYMMETRIC, SYMMETRIC)[k]):
                parity = 1.0 if symmetry == ANTISYMMETRIC else -1.0
                row = _folded(mesh, of_whole.closure_by[k], symmetry, parity)
                rows.append(np.concatenate([row, np.zeros(count + 1)])[kept])
        if symmetry != SYMMETRIC:
            for vector in (turned, relabelled):
                w, n = vector[: mesh.nodes][:count], vector[mesh.nodes :][:count]
                columns.append(np.concatenate([w, n, [0.0]])[kept])
        made.append(
            Block(
                symmetry,
                matrix[np.ix_(kept, kept)],
                np.array(rows).T.reshape(kept.size, -1),
                np.array(columns).T.reshape(kept.size, -1),
                kept,
            )
        )
    return tuple(made)


def _folded(mesh: Mesh, row: np.ndarray, symmetry: str, parity: float) -> np.ndarray:
    if symmetry == WHOLE:
        return row
    kept = mesh.kept
    made = np.array(row[:kept])
    made[1:] += parity * row[: kept - 1 : -1]
    if parity < 0.0:
        made[0] = 0.0
    return made


def is_real(value: complex) -> bool:
    """Whether an eigenvalue is real."""
    return math.isclose(value.imag, 0.0, abs_tol=1e-9)
