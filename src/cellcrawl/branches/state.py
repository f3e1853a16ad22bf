"""A cell that keeps its shape: gliding, turning, or at rest as a circle."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.branches.equations import Fields, Measured, Rates, measure, rates
from cellcrawl.branches.mesh import Mesh
from cellcrawl.branches.setting import Setting
from cellcrawl.branches.spectrum import Block, blocks, ordered, unstable_count
from cellcrawl.branches.system import Root, System
from cellcrawl.curve import Curve
from cellcrawl.parameters import Parameters
from cellcrawl.starts.base import CellState
from cellcrawl.validation import real_number, whole_number

if TYPE_CHECKING:
    from cellcrawl.branches.branch import Branch

GLIDING, TURNING, AT_REST = "gliding", "turning", "at rest"
_ROUND = 1e-9  # amplitude below which a shape is the resting circle


class Motion(NamedTuple):
    """Area centroid and its velocity, in the frame of the nodes."""

    centre: np.ndarray
    velocity: np.ndarray


@dataclass(frozen=True, eq=False)
class SteadyState:
    """A cell that moves without changing its shape.

    Made by `from_run`, `gliding`, `turning` and as a point of a `Branch`; immutable. As a start,
    ``simulate(p, start=state)``, it is the cell itself.

    Attributes
    ----------
    setting : Setting
        Parameters, laws and the family of tension and area.
    system : System
        The nodes it was computed on.
    unknowns, phi : array
        The root and the force on the bonds at the nodes.
    """

    setting: Setting
    system: System
    unknowns: np.ndarray
    phi: np.ndarray
    residual: float = 0.0
    _spectrum: dict[str, Any] = field(default_factory=dict, repr=False)

    @classmethod
    def of(cls, setting: Setting, system: System, root: Root) -> SteadyState:
        """Return the state of a root."""
        return cls(setting, system, root.unknowns, root.phi)

    @property
    def parameters(self) -> Parameters:
        """Parameters of the cell."""
        return self.setting.parameters

    @property
    def mesh(self) -> Mesh:
        """Nodes along the edge."""
        return self.system.mesh

    @cached_property
    def fields(self) -> Fields:
        """Angle less its winding and bound fraction on all nodes, length and tension."""
        return self.system.whole(self.system.unpack(self.unknowns)[0])

    @property
    def turning_rate(self) -> float:
        """Rate at which the cell turns, in rad; positive to the left."""
        return self.system.unpack(self.unknowns)[2]

    @cached_property
    def kind(self) -> str:
        """What the cell does: "gliding", "turning" or "at rest"."""
        if not self.system.mirror:
            return TURNING
        wobble = np.abs(self.fields.w).max() + np.ptp(self.fields.n)
        return AT_REST if wobble < _ROUND else GLIDING

    @property
    def length(self) -> float:
        """Length of the edge."""
        return self.fields.length

    @property
    def tension(self) -> float:
        """Membrane tension."""
        return self.fields.sigma

    @property
    def area(self) -> float:
        """Enclosed area."""
        return self._measured.area

    @property
    def circularity(self) -> float:
        """``4 pi A / L^2``."""
        return 4.0 * math.pi * self.area / self.length**2

    @property
    def speed(self) -> float:
        """Speed of the centroid."""
        return float(np.hypot(*self._motion.velocity))

    @property
    def path_radius(self) -> float:
        """Radius of the circle on which the centroid goes; infinite for a gliding cell."""
        turn = abs(self.turning_rate)
        return self.speed / turn if turn > 0.0 else math.inf

    @cached_property
    def largest_curvature(self) -> float:
        """Curvature of the sharpest corner."""
        kappa, alpha = self._rates.kappa, self.mesh.alpha
        width = 2.0 * math.pi / self.mesh.nodes
        centre = float(alpha[int(np.argmax(kappa))])
        top = float(kappa.max())
        for _ in range(6):
            near = centre + np.linspace(-width, width, 33)
            values = self.mesh.values(kappa, near)
            k = int(np.argmax(values))
            centre, top, width = float(near[k]), float(values[k]), width / 8.0
        return top

    @property
    def blocks(self) -> tuple[Block, ...]:
        """The linear flow around the state."""
        if "blocks" not in self._spectrum:
            _, slide, turn = self.system.unpack(self.unknowns)
            self._spectrum["blocks"] = blocks(
                self.setting, self.mesh, self.fields, self.phi, slide, turn
            )
        return tuple(self._spectrum["blocks"])

    def block(self, symmetry: str) -> Block:
        """Return the part of the linear flow of one symmetry."""
        return next(block for block in self.blocks if block.symmetry == symmetry)

    def without_matrices(self) -> SteadyState:
        """Return the same state with its eigenvalues and without the matrices behind them."""
        values = {block.symmetry: block.eigenvalues for block in self.blocks}
        neutral = np.concatenate([block.neutral for block in self.blocks])
        kept = {"eigenvalues": values, "neutral": neutral}
        return SteadyState(self.setting, self.system, self.unknowns, self.phi, self.residual, kept)

    @property
    def eigenvalues_by_symmetry(self) -> dict[str, np.ndarray]:
        """Growth rates, those of symmetric and antisymmetric changes apart for a gliding cell."""
        if "eigenvalues" not in self._spectrum:
            found = {block.symmetry: block.eigenvalues for block in self.blocks}
            self._spectrum["eigenvalues"] = found
        return dict(self._spectrum["eigenvalues"])

    @property
    def eigenvalues(self) -> np.ndarray:
        """Growth rates of small changes, complex, the largest real part first.

        Without rotation, relabelling and what would open the edge (`neutral_eigenvalues`).
        """
        return ordered(np.concatenate(list(self.eigenvalues_by_symmetry.values())))

    @property
    def neutral_eigenvalues(self) -> np.ndarray:
        """Eigenvalues of rotation, relabelling and closure: 0, or plus and minus i omega."""
        if "neutral" not in self._spectrum:
            self._spectrum["neutral"] = np.concatenate([block.neutral for block in self.blocks])
        return np.asarray(self._spectrum["neutral"])

    @property
    def unstable_modes(self) -> int:
        """Number of growth rates above 0."""
        return unstable_count(self.eigenvalues)

    @property
    def stable(self) -> bool:
        """Whether all small changes decay."""
        return self.unstable_modes == 0

    @cached_property
    def _measured(self) -> Measured:
        return measure(self.mesh, self.fields.w, self.length)

    @cached_property
    def _rates(self) -> Rates:
        _, slide, turn = self.system.unpack(self.unknowns)
        phi = self.phi if self.phi.size == self.mesh.nodes else self.mesh.unfolded(self.phi, 1.0)
        return rates(self.setting, self.mesh.whole, self.fields, phi, slide, turn)

    @cached_property
    def _motion(self) -> Motion:
        mesh, of_whole = self.mesh, self._measured
        theta = 0.5 * math.pi + mesh.alpha + self.fields.w
        per_node = self.length * mesh.whole.mean
        x, y = of_whole.x, of_whole.y
        normals = np.array([np.sin(theta), -np.cos(theta)])
        arms = np.array([x, y])
        centre = (per_node * arms**2 * normals).sum(axis=1) / (2.0 * self.area)
        speed = self._rates.at.speed
        velocity = ((arms - centre[:, None]) * (per_node * speed)).sum(axis=1) / self.area
        return Motion(centre, velocity)

    def _turned(self) -> float:
        """Angle by which the nodes' frame is turned so that the cell heads along x."""
        vx, vy = self._motion.velocity
        return -math.atan2(vy, vx) if math.hypot(vx, vy) > 1e-12 else 0.0

    @checked
    def state(self, parameters: Parameters, nodes: int) -> CellState:
        """Return the cell on ``nodes`` nodes at equal arclengths, as a start for `simulate`."""
        whole_number("nodes", nodes, 16, 1_000_000)
        alpha = 2.0 * math.pi * np.arange(nodes) / nodes
        w, n = (self.mesh.values(f, alpha) for f in (self.fields.w, self.fields.n))
        return self._cell(w, n, self.length, self.tension)

    def _cell(self, w: np.ndarray, n: np.ndarray, length: float, tension: float) -> CellState:
        nodes = w.size
        alpha = 2.0 * math.pi * np.arange(nodes) / nodes
        curve = Curve(0.5 * math.pi + alpha + w + self._turned(), length).closed()
        return CellState(curve.moved(-curve.centroid), np.clip(n, 0.0, 1.0), tension)

    def describe(self) -> dict[str, Any]:
        """Return what this start is, as plain values for JSON."""
        laws = self.setting.laws.describe()
        return {
            "kind": "SteadyState",
            "parameters": self.parameters.to_dict(),
            "laws": laws,
            "rest_area": self.setting.rest_area,
            "speed": self.speed,
            "turning_rate": self.turning_rate,
        }

    @checked
    def dataset(self, nodes: int = 256) -> xr.Dataset:
        """Return the cell as a run of one record, for pictures and observables.

        The centroid is at the origin and the cell heads along x.
        """
        from cellcrawl.branches.records import as_dataset

        return as_dataset([self], nodes)

    def record(self, nodes: int) -> dict[str, np.ndarray | float]:
        """Return the fields of the run contract at equal arclengths."""
        from cellcrawl.branches.records import record_of

        cell = self.state(self.parameters, nodes)
        return record_of(self.setting, cell, float(self._rates.at.phi.mean()))

    @checked
    def perturbed(self, index: int = 0, amplitude: float = 1e-4, phase: float = 0.0) -> CellState:
        """Return the cell with one of its eigenvectors added, on 1024 nodes.

        Parameters
        ----------
        index : int
            Which of `eigenvalues`.
        amplitude : float
            Largest change of angle or bound fraction, up to 0.1 either way.
        phase : float
            Of a complex eigenvector, in rad.
        """
        amplitude = real_number("amplitude", amplitude, -0.1, 0.1)
        w, n, length = self.eigenvector(index, 1024)
        turn = np.exp(1j * real_number("phase", phase, -1e3, 1e3))
        w, n, length = (w * turn).real, (n * turn).real, float((length * turn).real)
        alpha = 2.0 * math.pi * np.arange(1024) / 1024
        base = [self.mesh.values(f, alpha) for f in (self.fields.w, self.fields.n)]
        cell = self._cell(
            base[0] + amplitude * w, base[1] + amplitude * n,
            self.length + amplitude * length, 0.0,
        )  # fmt: skip
        return CellState(cell.curve, cell.bound_fraction, self.setting.tension(cell.curve.area))

    @checked
    def eigenvector(self, index: int = 0, nodes: int = 256) -> tuple[np.ndarray, np.ndarray, Any]:
        """Return changes of tangent angle, bound fraction and length that grow together.

        Complex; at equal arclengths from the front on, the largest of them 1.
        """
        values = self.eigenvalues
        wanted = values[whole_number("index", index, 0, values.size - 1)]
        found = self.eigenvalues_by_symmetry
        symmetry = min(found, key=lambda name: float(np.abs(found[name] - wanted).min()))
        block = self.block(symmetry)
        _, vector = block.near(complex(wanted))
        return self.spread(block, vector, nodes)

    def spread(
        self, block: Block, vector: np.ndarray, nodes: int
    ) -> tuple[np.ndarray, np.ndarray, Any]:
        """Return a vector of a block at equal arclengths."""
        count = self.system.nodes
        full = block.on_nodes(vector, count)
        w, n, length = full[:count], full[count : 2 * count], full[-1]
        if self.system.mirror:
            parity = -1.0 if block.symmetry == "symmetric" else 1.0
            w, n = self.mesh.unfolded(w, parity), self.mesh.unfolded(n, -parity)
        alpha = 2.0 * math.pi * np.arange(nodes) / nodes
        w, n = self.mesh.values(w, alpha), self.mesh.values(n, alpha)
        top = np.concatenate([w, n])[np.argmax(np.abs(np.concatenate([w, n])))]
        return w / top, n / top, length / top

    def continue_in(self, name: str, to: float, **options: Any) -> Branch:
        """Follow the state as a parameter changes; see `cellcrawl.branches.continue_in`."""
        from cellcrawl.branches.continuation import continue_in

        return continue_in(self, name, to, **options)

    def __repr__(self) -> str:
        p = self.parameters
        spin = "" if self.system.mirror else f", turning rate {self.turning_rate:.6g}"
        return (
            f"SteadyState({self.kind}, r_on={p.r_on:g}, zeta_1={p.zeta_1:g}: speed "
            f"{self.speed:.6g}{spin}, tension {self.tension:.6g})"
        )
