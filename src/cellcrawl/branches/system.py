"""The square system whose roots are cells that keep their shape, with or without a mirror axis.

Unknowns are ``(w, n, L, sigma)`` and multipliers. Tension is an unknown of its own beside the
tension law, which keeps Newton's method well at the stiff, consistent law. Closure is kept by the
flow, so that its equations are dependent on the rest: the edge is asked to close, and a multiplier
that vanishes at the root takes the place of each. Without a mirror axis the orientation and the
first node are fixed by a reference shape, and the speed of relabelling and the turning rate are
their multipliers.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from cellcrawl.branches.equations import Fields, Measured, Rates, linear, measure, rates
from cellcrawl.branches.mesh import Mesh, Operators
from cellcrawl.branches.setting import OutOfRange, Setting

_MOST_STEPS = 12
_SETTLED = 1e-9
_LONGEST = 0.5  # change of the shape in one step, in the norm of `System.norm`


class NotFound(Exception):
    """Newton's method did not come to a root; the message says how it ended."""


class Root(NamedTuple):
    """A root, with the derivatives there."""

    unknowns: np.ndarray
    parameter: float
    phi: np.ndarray
    jacobian: np.ndarray
    by_parameter: np.ndarray
    steps: int


@dataclass(frozen=True)
class System:
    """Equations and unknowns on a mesh; with ``mirror`` one half of the edge is kept.

    Attributes
    ----------
    mesh : Mesh
    mirror : bool
    """

    mesh: Mesh
    mirror: bool

    @property
    def ops(self) -> Operators:
        """Operators on the nodes that are kept."""
        return self.mesh.symmetric if self.mirror else self.mesh.whole

    @property
    def nodes(self) -> int:
        """Nodes that are kept."""
        return self.mesh.kept if self.mirror else self.mesh.nodes

    @property
    def multipliers(self) -> int:
        """Numbers beside the shape and its tension."""
        return 1 if self.mirror else 4

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return 2 * self.nodes + 2 + self.multipliers - (1 if self.mirror else 0)

    def pack(self, shape: Fields, slide: float = 0.0, turn: float = 0.0) -> np.ndarray:
        """Return the unknowns of a shape."""
        w = shape.w[1:] if self.mirror else shape.w
        extra = [0.0] if self.mirror else [slide, turn, 0.0, 0.0]
        return np.concatenate([w, shape.n, [shape.length, shape.sigma], extra])

    def unpack(self, y: np.ndarray) -> tuple[Fields, float, float]:
        """Return shape, speed of relabelling and turning rate."""
        count = self.nodes
        w = np.concatenate([[0.0], y[: count - 1]]) if self.mirror else y[:count]
        first = count - 1 if self.mirror else count
        n = y[first : first + count]
        length, sigma = (float(value) for value in y[first + count : first + count + 2])
        slide, turn = (0.0, 0.0) if self.mirror else (float(y[-4]), float(y[-3]))
        return Fields(w, n, length, sigma), slide, turn

    def whole(self, shape: Fields) -> Fields:
        """Return a shape on all nodes."""
        if not self.mirror:
            return shape
        w, n = self.mesh.unfolded(shape.w, -1.0), self.mesh.unfolded(shape.n, 1.0)
        return Fields(w, n, shape.length, shape.sigma)

    def weights(self) -> np.ndarray:
        """Weights of the squares of unknowns in the norm; multipliers and tension have none."""
        mean = self.mesh.symmetric.mean if self.mirror else self.mesh.whole.mean
        w = mean[1:] if self.mirror else mean
        shape = self.unpack(np.ones(self.size))[0]
        extra = np.zeros(self.size - w.size - shape.n.size)
        extra[0] = 0.05
        return np.concatenate([w, mean, extra])

    def norm(self, step: np.ndarray) -> float:
        """Return the size of a change."""
        return math.sqrt(float(self.weights() @ (step * step)))

    def evaluate(
        self, setting: Setting, y: np.ndarray, phi: np.ndarray, reference: Fields
    ) -> tuple[np.ndarray, Rates, Measured]:
        """Return the residual, and what it is made of."""
        shape, slide, turn = self.unpack(y)
        if not (shape.length > 0.0 and shape.n.min() > -0.2 and shape.n.max() < 1.2):
            raise OutOfRange
        now = rates(setting, self.ops, shape, phi, slide, turn)
        of_whole = measure(self.mesh, self.whole(shape).w, shape.length)
        scale = max(setting.tension_rate, 1.0)
        law = (shape.sigma - setting.tension(of_whole.area)) / scale
        if self.mirror:
            row = self._folded(of_whole.closure_by[1])
            w_t = (now.w + y[-1] * self.mesh.nodes * row)[1:]
            tail = [now.length, law, of_whole.closure[1]]
        else:
            push = y[-2] * of_whole.closure_by[0] + y[-1] * of_whole.closure_by[1]
            w_t = now.w + self.mesh.nodes * push
            phases = self._phases(reference) @ np.concatenate(
                [shape.w - reference.w, shape.n - reference.n]
            )
            tail = [now.length, law, *of_whole.closure, *phases]
        return np.concatenate([w_t, now.n, tail]), now, of_whole

    def jacobian(
        self, setting: Setting, y: np.ndarray, now: Rates, of_whole: Measured, reference: Fields
    ) -> np.ndarray:
        """Return the derivatives of the residual by the unknowns; exact at a root."""
        shape, _, _ = self.unpack(y)
        made = linear(setting, self.ops, shape, now)
        count, nodes = self.nodes, self.mesh.nodes
        keep = np.arange(2 * count + 1)
        if self.mirror:
            keep = keep[1:]
        m = keep.size
        jac = np.zeros((self.size, self.size))
        jac[:m, :m] = made.matrix[np.ix_(keep, keep)]
        jac[:m, m] = made.by_sigma[keep]
        scale = max(setting.tension_rate, 1.0)
        stiffness = setting.tension_rate / scale
        area_by = self._folded(of_whole.area_by) if self.mirror else of_whole.area_by
        w = keep[: count - 1] if self.mirror else keep[:count]
        first = w.size
        jac[m, :first] = -stiffness * area_by[w]
        jac[m, m - 1] = -stiffness * 2.0 * of_whole.area / shape.length
        jac[m, m] = 1.0 / scale
        if self.mirror:
            row = self._folded(of_whole.closure_by[1])
            jac[:first, m + 1] = nodes * row[1:]
            jac[m + 1, :first] = row[1:]
            return jac
        jac[:m, m + 1], jac[:m, m + 2] = made.by_slide, made.by_turn
        for k in range(2):
            jac[:first, m + 3 + k] = nodes * of_whole.closure_by[k]
            jac[m + 1 + k, :first] = of_whole.closure_by[k]
        jac[m + 3 : m + 5, : 2 * count] = self._phases(reference)
        return jac

    def _phases(self, reference: Fields) -> np.ndarray:
        """Rows that measure rotation and relabelling against a reference, shape (2, 2 nodes)."""
        g, slope = self.mesh.whole.mean, self.mesh.whole.angle_slope
        along_w, along_n = 1.0 + slope @ reference.w, slope @ reference.n
        nothing = np.zeros(self.nodes)
        return np.array([np.concatenate([g, nothing]), np.concatenate([g * along_w, g * along_n])])

    def _folded(self, row: np.ndarray) -> np.ndarray:
        """Return a row on the whole edge as one on half of it, for an odd angle."""
        kept = self.mesh.kept
        made = np.array(row[:kept])
        made[1:] -= row[: kept - 1 : -1]
        made[0] = 0.0
        return made

    def solve(
        self,
        setting: Setting,
        y: np.ndarray,
        phi: np.ndarray,
        reference: Fields | None = None,
        along: tuple[str, np.ndarray, float, float] | None = None,
    ) -> Root:
        """Find the root near ``y`` by Newton's method.

        Parameters
        ----------
        along : (name, tangent, weight, value), optional
            Free a parameter: the step from ``y`` and ``value`` stays across the tangent, whose last
            entry is for the parameter, in the norm in which its square has ``weight``.

        Raises
        ------
        NotFound
            If it does not come to one.
        """
        start, value = np.array(y), 0.0
        reference = self.unpack(start)[0] if reference is None else reference
        y, name = np.array(y), None
        if along is not None:
            name, tangent, weight, value = along
            row = np.append(self.weights() * tangent[:-1], weight * tangent[-1])
            first = value
        size, reached, steps = math.inf, False, 0
        try:
            while True:
                here = setting if name is None else setting.replace(name, value)
                residual, now, of_whole = self.evaluate(here, y, phi, reference)
                phi = now.at.phi
                if reached or steps == _MOST_STEPS:
                    break
                jac = self.jacobian(here, y, now, of_whole, reference)
                if name is None:
                    step = np.linalg.solve(jac, -residual)
                    change = 0.0
                else:
                    by = self.by_parameter(here, name, y, phi, reference)
                    bordered = np.block([[jac, by[:, None]], [row[None, :]]])
                    off = row @ np.append(y - start, value - first)
                    solution = np.linalg.solve(bordered, -np.append(residual, off))
                    step, change = solution[:-1], float(solution[-1])
                steps += 1
                before, size = size, self.norm(step)
                if not math.isfinite(size) or (size > 10.0 * before and size > 1e-6):
                    break
                shorter = min(1.0, _LONGEST / max(size, 1e-300))
                y = y + shorter * step
                value += shorter * change
                reached = size < _SETTLED
        except OutOfRange:
            raise NotFound("the forces have no balance, or a value left the model") from None
        except ValueError as error:
            raise NotFound(str(error)) from None
        except np.linalg.LinAlgError:
            raise NotFound("the equations became singular") from None
        if not reached or np.max(np.abs(residual)) > 1e-4:
            raise NotFound(f"Newton's method did not settle in {steps} steps")
        here = setting if name is None else setting.replace(name, value)
        jac = self.jacobian(here, y, now, of_whole, reference)
        by = np.zeros(0) if name is None else self.by_parameter(here, name, y, phi, reference)
        return Root(y, value, phi, jac, by, steps)

    def by_parameter(
        self, setting: Setting, name: str, y: np.ndarray, phi: np.ndarray, reference: Fields
    ) -> np.ndarray:
        """Return the derivative of the residual by a parameter, by central differences.

        It steers steps and tangents; where a root lies does not hang on it.
        """
        from cellcrawl.branches.setting import bounds_of

        low, high = bounds_of(setting.laws, name)
        value = setting.value(name)
        step = 1e-6 * max(abs(value), 1e-3)
        up, down = min(value + step, high), max(value - step, low)
        above = self.evaluate(setting.replace(name, up), y, phi, reference)[0]
        below = self.evaluate(setting.replace(name, down), y, phi, reference)[0]
        return np.asarray((above - below) / (up - down))
