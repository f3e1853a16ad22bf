"""A particle whose turn is known in closed form, by our branch code and by another.

    python benchmarks/particle.py [--pycont PYTHON] [--output DIR]

The deformable particle of Ohta and Ohkuma (Phys. Rev. Lett. 102, 154101, 2009),
``v' = gamma v - |v|^2 v - a S v`` and ``S' = -kappa S + b (v v - |v|^2 / 2)``, goes straight up to
``gamma_c = kappa^2 / (a b) + kappa / 2`` and in a circle beyond. Newton's method, arclength steps
and the location of crossings are those of `cellcrawl.branches`. PYTHON is one in which
``pip install pycont-lite`` was done: its answer, from the equations alone, stands beside ours.
"""

from __future__ import annotations

import argparse
import json
import subprocess
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from cellcrawl.bench.machine import record
from cellcrawl.branches.continuation import tangent_of
from cellcrawl.branches.mesh import Mesh
from cellcrawl.branches.points import SpecialPoint, crossings
from cellcrawl.branches.spectrum import ANTISYMMETRIC, SYMMETRIC, Block
from cellcrawl.branches.system import Root, System

STEP, STEPS = 0.1, 12
OTHER = """
import numpy as np, pycont
A, B, K = {a}, {b}, {kappa}
def G(u, gamma):
    v, s, q = u
    turn = -A * q
    return np.array([gamma * v - v**3 - A * s * v,
                     -K * s + 0.5 * B * v * v + 2 * q * turn, -K * q - 2 * s * turn])
v = np.sqrt(0.3 / (1 + A * B / (2 * K)))
found = pycont.arclengthContinuation(
    G, np.array([v, 0.5 * B * v * v / K, 0.0]), 0.3, 1e-6, 0.02, 0.01, 60,
    solver_parameters={{"tolerance": 1e-12}}, verbosity=0)
print(min((float(event.p) for event in found.events if event.kind == "BP"),
          key=lambda p: abs(p - {closed_form})))
"""


@dataclass(frozen=True)
class Motor:
    """The particle's numbers, in the place of a cell's setting."""

    gamma: float
    a: float = 1.0
    b: float = 0.5
    kappa: float = 0.5

    def value(self, name: str) -> float:
        """Return one of them."""
        return float(getattr(self, name))

    def replace(self, name: str, value: float) -> Motor:
        """Return the same with one changed."""
        return replace(self, **{name: value})

    @property
    def turns_at(self) -> float:
        """Where it begins to turn, in closed form."""
        return self.kappa**2 / (self.a * self.b) + 0.5 * self.kappa


class Particle(System):
    """Speed and elongation of a particle that goes straight; the rest is `System`'s own."""

    size = 2

    def unpack(self, y: np.ndarray) -> Any:
        """There is no shape."""
        return None, 0.0, 0.0

    def weights(self) -> np.ndarray:
        """Both count alike."""
        return np.ones(2)

    def evaluate(self, setting: Any, y: Any, phi: Any, reference: Any) -> Any:
        """Return the rates of speed and elongation."""
        (v, s), m = y, setting
        rates = [m.gamma * v - v**3 - m.a * s * v, -m.kappa * s + 0.5 * m.b * v * v]
        return np.array(rates), SimpleNamespace(at=SimpleNamespace(phi=phi)), None

    def jacobian(self, setting: Any, y: Any, now: Any, of_whole: Any, reference: Any) -> Any:
        """Return their derivatives."""
        (v, s), m = y, setting
        return np.array([[m.gamma - 3 * v * v - m.a * s, -m.a * v], [m.b * v, -m.kappa]])

    def by_parameter(self, setting: Any, name: str, y: Any, phi: Any, reference: Any) -> Any:
        """Return the derivative by gamma."""
        return np.array([y[0], 0.0])


@dataclass
class Straight:
    """A particle that goes straight, in the place of a gliding cell."""

    setting: Motor
    unknowns: np.ndarray
    system: Particle = field(default_factory=lambda: Particle(Mesh(17), True))
    phi: np.ndarray = field(default_factory=lambda: np.zeros(1))

    @classmethod
    def of(cls, setting: Any, system: Any, root: Root) -> Straight:
        """Return the state of a root."""
        return cls(setting, root.unknowns, system)

    @property
    def mesh(self) -> Mesh:
        """Not used."""
        return self.system.mesh

    def block(self, symmetry: str) -> Block:
        """Return the linear flow; changes to the side without rotation are one number."""
        m, s = self.setting, self.unknowns[1]
        matrix = np.array([[2.0 * m.a * s - m.kappa]])
        if symmetry == SYMMETRIC:
            matrix = self.system.jacobian(m, self.unknowns, None, None, None)
        size = matrix.shape[0]
        return Block(symmetry, matrix, np.zeros((size, 0)), np.zeros((size, 0)), np.arange(size))

    @property
    def eigenvalues_by_symmetry(self) -> dict[str, np.ndarray]:
        """Growth rates."""
        return {name: self.block(name).eigenvalues for name in (SYMMETRIC, ANTISYMMETRIC)}


def ours(motor: Motor) -> list[SpecialPoint]:
    """Follow the straight particle in gamma, and return where its fate changes."""
    v = np.sqrt(motor.gamma / (1.0 + motor.a * motor.b / (2.0 * motor.kappa)))
    state: Any = Straight(motor, np.array([1.1 * v, 0.4 * motor.b * v * v / motor.kappa]))
    root = state.system.solve(motor, state.unknowns, state.phi)
    root = root._replace(by_parameter=np.array([root.unknowns[0], 0.0]))
    tangent, found = np.array([0.0, 0.0, 1.0]), []
    state = Straight.of(motor, state.system, root)
    for k in range(STEPS):
        tangent = tangent_of(state.system, root, 1.0, tangent)
        ahead = STEP * tangent
        along = ("gamma", tangent, 1.0, state.setting.gamma + ahead[-1])
        guess = state.unknowns + ahead[:-1]
        root = state.system.solve(state.setting, guess, state.phi, None, along)
        after: Any = Straight.of(state.setting.replace("gamma", root.parameter), state.system, root)
        found += crossings("gamma", 1.0, state, after, k)
        state = after
    return found


def main() -> None:
    """Compare, print, and keep the numbers."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pycont", help="a Python that has pycont-lite")
    parser.add_argument("--output", type=Path)
    asked = parser.parse_args()
    rows = []
    for a, b, kappa in ((1.0, 0.5, 0.5), (1.3, 0.7, 0.4)):
        motor = Motor(0.3, a, b, kappa)
        (point,) = ours(motor)
        row: dict[str, Any] = {
            "a": a, "b": b, "kappa": kappa, "closed_form": motor.turns_at, "kind": point.kind,
            "ours": point.value, "ours_off": abs(point.value - motor.turns_at),
        }  # fmt: skip
        if asked.pycont:
            text = OTHER.format(a=a, b=b, kappa=kappa, closed_form=motor.turns_at)
            told = subprocess.run(
                [asked.pycont, "-c", text], check=True, capture_output=True, text=True
            )
            row["pycont_lite"] = float(told.stdout.strip().splitlines()[-1])
        rows.append(row)
        print(row)
    if asked.output is not None:
        asked.output.mkdir(parents=True, exist_ok=True)
        content = {"machine": record(), "particle": rows}
        (asked.output / "particle.json").write_text(json.dumps(content, indent=1), "utf-8")


if __name__ == "__main__":
    main()
