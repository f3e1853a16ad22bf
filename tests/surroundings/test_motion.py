"""Surroundings that ask for the motion of the cell and the curvature of its edge."""

from __future__ import annotations

import math

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.laws.law import PAPER
from cellcrawl.surroundings import AlongEdge, Place, Surrounding, Surroundings, TensionGradient
from cellcrawl.surroundings.motion import TRIES, VX, VY, at_rest, improve
from cellcrawl.verification import along_edge
from cellcrawl.verification.restart import different_values, fixed_attributes
from tests.conftest import check_start

CELL = cc.Parameters(r_on=26, zeta_1=600)


class Local:
    h, v_p, pressure = 0.01, 195.6, 0.0


def test_a_velocity_that_follows_from_itself_is_found_in_a_few_tries():
    # V = a + B V, strongly coupled: plain iteration would run away
    a, b = np.array([0.2, -0.1]), np.array([[-1.5, 0.4], [0.2, -3.0]])
    true = np.linalg.solve(np.eye(2) - b, a)
    motion = at_rest(bends=False, moves=True)
    assert _tries(a, b, motion) <= 8
    np.testing.assert_allclose(motion[[VX, VY]], true, rtol=1e-11)
    assert motion[TRIES] == 0.0
    a += 1e-3  # from where it was, with what was learnt
    assert _tries(a, b, motion) <= 4


def _tries(a, b, motion):
    """Improve the velocity until it is ``a + b V``; how many tries that took."""
    return next(k for k in range(1, 40) if improve(*(a + b @ motion[[VX, VY]]), motion))


@pytest.mark.parametrize("angle", [0.0, 1.0, 2.5, -2.0])
@pytest.mark.parametrize("heading", [0.0, 2.0, -3.0])
def test_the_angle_is_from_the_direction_of_motion(angle, heading):
    place = Place(
        x=0.0, y=0.0, time=0.0, normal_x=1.0, normal_y=0.0,
        velocity_x=0.3 * math.cos(heading), velocity_y=0.3 * math.sin(heading),
        arm_x=1.2 * math.cos(heading + angle), arm_y=1.2 * math.sin(heading + angle),
    )  # fmt: skip
    assert place.angle == pytest.approx(angle, abs=1e-12)


def test_what_goes_with_the_front_is_strongest_ahead_and_fades_at_rest():
    part = AlongEdge("v_p", front=0.2, bend=0.1, sharp=2.0, slow=0.01)

    def gain(speed, arm, curvature):
        place = Place(x=0.0, y=0.0, time=0.0, normal_x=1.0, normal_y=0.0, velocity_x=speed,
                      velocity_y=0.0, arm_x=arm[0], arm_y=arm[1], curvature=curvature)  # fmt: skip
        return float(part.change(place, Local)["v_p"]) / Local.v_p - 1.0

    assert gain(10.0, (1.3, 0.0), 1.0) == pytest.approx(0.2, rel=1e-5)
    assert gain(10.0, (-1.3, 0.0), 1.0) == pytest.approx(-0.2, rel=1e-5)
    assert gain(10.0, (0.0, 0.7), 1.0) == pytest.approx(0.0, abs=1e-12)
    assert gain(0.01, (1.0, 0.0), 1.0) == pytest.approx(0.2 / math.sqrt(2.0), rel=1e-5)
    assert gain(0.0, (1.0, 0.0), 3.0) == pytest.approx(0.1 * math.tanh(1.0), rel=1e-9)


@pytest.mark.slow  # compiles the solvers for a tension gradient
@pytest.mark.parametrize("mu", [100.0, 400.0])
def test_a_tension_gradient_slows_polarisation_as_theory_says(mu):
    found, theory = along_edge.polarisation_rate(mu)
    assert found == pytest.approx(theory, rel=1e-6)


@pytest.mark.slow  # compiles the solvers for a tension gradient
def test_polarisation_stops_where_the_drag_of_the_motion_is_enough():
    found, theory = along_edge.polarisation_rate(310.71)
    assert abs(found) < 1e-3
    assert abs(theory) < 1e-3


@pytest.mark.slow  # compiles the solvers for a tension gradient
def test_without_strength_a_tension_gradient_leaves_every_bit():
    run = {"start": check_start(CELL), "t_end": 1.0}
    base = cc.simulate(CELL, **run)
    still = cc.simulate(CELL, **run, surroundings=TensionGradient(mu=0.0))
    assert different_values(base, still) == 0


@pytest.mark.slow  # compiles the solvers for a tension gradient
def test_every_record_has_the_velocity_its_parameters_were_made_with():
    # friction is pull with the velocity that the record's own edge has; both are near 1000
    assert along_edge.amiss(200.0) < 1e-5


@pytest.mark.slow  # compiles the solvers for a tension gradient
def test_a_run_with_motion_resumes_to_the_same_bits(tmp_path):
    run = {"start": check_start(CELL), "surroundings": TensionGradient(mu=200.0)}
    path = tmp_path / "run.nc"
    cc.simulate(CELL, 0.3337, output=path, **run).close()
    cc.resume(path, 0.5).close()
    resumed = cc.resume(path, 1.0)
    straight = cc.simulate(CELL, 1.0, **run)
    assert different_values(resumed, straight) == 0
    assert fixed_attributes(resumed) == fixed_attributes(straight)


class MovingDiffusion(Surrounding):
    """Diffusion that goes with the motion."""

    def change(self, at, p):
        return {"D": p.D * (1.0 + at.velocity_x)}


def test_diffusion_cannot_go_with_the_motion():
    with pytest.raises(cc.InputError, match="D depend on the motion") as refused:
        Surroundings([MovingDiffusion()]).compiled(PAPER)
    assert "\n" not in str(refused.value)


def test_what_asks_for_motion_or_curvature_is_known():
    for part, bends, moves in (
        (TensionGradient(mu=1.0), True, True),
        (AlongEdge("r_on", front=0.1), True, True),
        (cc.surroundings.UniformForce(x=1.0), False, False),
    ):
        made = Surroundings([part]).compiled(PAPER)
        assert (made.bends, made.moves) == (bends, moves)
