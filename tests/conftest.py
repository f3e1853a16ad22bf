"""Shared starts and settings of the tests."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import hypothesis
import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.bench.cases import check_start as check_start
from cellcrawl.curve import Curve

hypothesis.settings.register_profile(
    "cellcrawl", deadline=None, suppress_health_check=[hypothesis.HealthCheck.too_slow]
)
hypothesis.settings.load_profile("cellcrawl")


@dataclass(frozen=True, eq=False)
class Given:
    """A start that is a state already made."""

    given: cc.CellState

    def state(self, parameters: cc.Parameters, nodes: int) -> cc.CellState:
        assert nodes == self.given.curve.nodes
        return self.given

    def describe(self) -> dict[str, Any]:
        return {"kind": "Given"}


def rotated(state: cc.CellState, angle: float) -> cc.CellState:
    """The state turned about the origin."""
    c, s = math.cos(angle), math.sin(angle)
    curve = state.curve
    origin = np.array([[c, -s], [s, c]]) @ curve.origin
    return cc.CellState(
        Curve(curve.theta + angle, curve.length, origin), state.bound_fraction, state.tension
    )


def reflected(state: cc.CellState) -> cc.CellState:
    """The state mirrored in the x axis, still counter-clockwise, node 0 in place."""
    curve = state.curve
    back = np.roll(np.arange(curve.nodes)[::-1], 1)
    theta = np.unwrap(math.pi - curve.theta[back])
    origin = curve.origin * np.array([1.0, -1.0])
    return cc.CellState(
        Curve(theta, curve.length, origin), state.bound_fraction[back], state.tension
    )


def shifted(state: cc.CellState, nodes: int) -> cc.CellState:
    """The state with another node as node 0."""
    curve = state.curve
    theta = np.roll(curve.theta, -nodes)
    theta[-nodes:] += 2.0 * math.pi
    return cc.CellState(
        Curve(theta, curve.length, curve.points[nodes]),
        np.roll(state.bound_fraction, -nodes),
        state.tension,
    )


@pytest.fixture(scope="session")
def zigzag_parameters() -> cc.Parameters:
    return cc.Parameters(r_on=26, zeta_1=600)
