import json
import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

import cellcrawl as cc
from tests.conftest import check_start
from tests.strategies import parameters

P = cc.Parameters(r_on=26, zeta_1=600)
SQUARE = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])


def polar(state):
    x, y = state.curve.points.T
    return np.arctan2(y, x), np.hypot(x, y)


def projection(values, angle, k):
    """Complex amplitude of ``exp(i k phi)`` in a real wave, by least squares."""
    if k == 0:
        return complex(values.mean())
    columns = np.column_stack([np.ones_like(angle), np.cos(k * angle), np.sin(k * angle)])
    fit = np.linalg.lstsq(columns, values, rcond=None)[0]
    return complex(fit[1], -fit[2])


@pytest.mark.parametrize("nodes", [64, 401])
def test_check_start_has_its_radius_and_bound_fraction_at_every_node(nodes):
    state = check_start(P).state(P, nodes)
    phi, radius = polar(state)
    r = 1 + 0.01 * np.cos(phi) + 0.02 * np.cos(2 * phi) + 0.01 * np.sin(3 * phi)
    n = P.n_bar * (1 + 0.05 * np.cos(phi + 0.3) + 0.03 * np.cos(2 * phi - 1))
    np.testing.assert_allclose(radius, r, rtol=0, atol=1e-12)
    np.testing.assert_allclose(state.bound_fraction, n, rtol=0, atol=1e-12)
    assert state.tension == P.sigma_bar


small = st.tuples(st.floats(-0.05, 0.05), st.floats(-0.05, 0.05))
modes = st.dictionaries(st.integers(0, 6), small, max_size=3)


@settings(max_examples=30)
@given(modes, modes)
def test_any_perturbed_circle_has_its_modes(radius, bound):
    state = cc.PerturbedCircle(radius, bound).state(P, 256)
    phi, r = polar(state)
    for found, modes, rest in ((r, radius, 1.0), (state.bound_fraction, bound, P.n_bar)):
        expected = rest + sum(
            a * np.cos(k * phi) + b * np.sin(k * phi) for k, (a, b) in modes.items()
        )
        np.testing.assert_allclose(found, expected + 0 * phi, rtol=0, atol=1e-6)
    chords = np.hypot(*(np.roll(state.curve.points, -1, axis=0) - state.curve.points).T)
    assert np.ptp(chords) < 0.02 * chords.mean()  # equal in arclength, nearly so in chord


def test_nothing_perturbed_is_the_resting_circle():
    state = cc.PerturbedCircle().state(P, 64)
    np.testing.assert_allclose(state.curve.curvature, 1.0, atol=1e-12)
    assert np.all(state.bound_fraction == P.n_bar)


def test_same_seed_gives_the_same_bits_and_another_does_not():
    first, again, other = (cc.RandomPerturbation(seed=s).state(P, 256) for s in (7, 7, 8))
    assert np.array_equal(first.curve.theta, again.curve.theta)
    assert np.array_equal(first.bound_fraction, again.bound_fraction)
    assert first.curve.length == again.curve.length
    assert not np.array_equal(first.bound_fraction, other.bound_fraction)
    assert not np.array_equal(first.curve.theta, other.curve.theta)


def test_random_modes_are_independent_uniform_and_as_many_as_asked():
    state = cc.RandomPerturbation(seed=3).state(P, 2048)
    _, radius = polar(state)
    for field in (radius - 1.0, state.bound_fraction - P.n_bar):
        # the nodes are equally spaced in angle to 1e-2 spacings: amplitudes to 1e-6 of 1e-4
        amplitude = 2.0 * np.fft.rfft(field) / field.size
        assert np.abs(amplitude[1:101].real).max() < 1.1e-4
        assert np.abs(amplitude[1:101].imag).max() < 1.1e-4
        assert np.std(amplitude[1:101].real) == pytest.approx(1e-4 / math.sqrt(3), rel=0.3)
        assert np.abs(amplitude[120:]).max() < 3e-6
    correlation = np.corrcoef(radius, state.bound_fraction)[0, 1]
    assert abs(correlation) < 0.3


def test_start_does_not_depend_on_the_number_of_nodes():
    coarse, fine = (cc.RandomPerturbation(seed=3, modes=20).state(P, n) for n in (256, 512))
    np.testing.assert_allclose(fine.bound_fraction[::2], coarse.bound_fraction, atol=1e-12)
    np.testing.assert_allclose(fine.curve.theta[::2], coarse.curve.theta, atol=1e-10)


@settings(  # many cells have no resting circle, or none that a mode of this size leaves convex
    max_examples=25, suppress_health_check=[HealthCheck.filter_too_much]
)
@given(
    parameters,
    st.integers(0, 20),
    st.sampled_from("+-"),
    st.sampled_from(["radius", "bound_fraction"]),
)
def test_eigenmode_satisfies_its_linear_relations(p, k, branch, carrier):
    # MODEL.md section 4: lam R = -eps c r, (lam + q) n = -n_bar r and the force balance
    amplitude = 1e-7
    try:
        ahead = cc.Eigenmode(k, amplitude, branch, carrier).state(p, 128)
        behind = cc.Eigenmode(k, -amplitude, branch, carrier).state(p, 128)
    except cc.InputError:
        assume(False)

    def mode(of: Callable[[cc.CellState], complex]) -> complex:
        """The odd part in the amplitude: what is of second order drops out."""
        return 0.5 * (of(ahead) - of(behind))

    def radius_wave(state: cc.CellState) -> complex:
        angle, radius = polar(state)
        return projection(radius - 1.0, angle, k)

    def bound_wave(state: cc.CellState) -> complex:
        return projection(state.bound_fraction - p.n_bar, polar(state)[0], k)

    size_r, size_n = mode(radius_wave), mode(bound_wave)
    assume(max(abs(size_r), abs(size_n)) < 1e-3)
    carried = size_r if carrier == "radius" else size_n
    assert carried == pytest.approx(amplitude, abs=1e-11)
    rate = complex(cc.linear.growth_rates(p, k)["+-".index(branch)])
    base = cc.linear.base_state(p)
    q = p.r_on + p.r_p + p.D * k**2
    # the off-rate from the linear force balance (k = 0: with the change of tension)
    pull = p.sigma_bar * p.h * (k**2 - 1) * size_r + (1 + p.h) * mode(lambda state: state.tension)
    size = (pull - p.zeta_1 * math.log(p.r_p) * size_n) / base.a
    assume(abs(size) > 1e-9)
    noise = 1e-12 + 10 * max(abs(size_r), abs(size_n)) ** 2
    slack_r = noise * (
        abs(rate) + p.epsilon * base.c * (abs(p.sigma_bar) * k**2 + p.zeta_1) / base.a
    )
    slack_n = noise * (abs(rate + q) + p.n_bar * (abs(p.sigma_bar) * k**2 + p.zeta_1) / base.a)
    if k > 0 or abs(rate.imag) == 0.0:
        assert abs(rate * size_r + p.epsilon * base.c * size) <= 10 * slack_r
        assert abs((rate + q) * size_n + p.n_bar * size) <= 10 * slack_n


def test_translation_mode_moves_the_off_rate_far_more_than_the_shape():
    # MODEL.md section 4: r_1 / R_1 is about -2600 at (25, 600)
    p = cc.Parameters(r_on=25, zeta_1=600)
    state = cc.Eigenmode(1, amplitude=1e-7).state(p, 128)
    angle, radius = polar(state)
    bound = projection(state.bound_fraction, angle, 1) / projection(radius, angle, 1)
    q = p.r_on + p.r_p + p.D
    rate = cc.Eigenmode(1).growth_rate(p)
    off_rate = -(rate + q) * bound / p.n_bar
    assert off_rate.real == pytest.approx(-2600, rel=0.01)


def test_breathing_mode_changes_the_tension_with_the_area():
    state = cc.Eigenmode(0, amplitude=1e-6).state(P, 64)
    grown = state.curve.area - math.pi
    assert state.tension - P.sigma_bar == pytest.approx(P.tension_rate * grown, rel=1e-4)


def test_shift_of_the_circle_has_no_bound_fraction():
    with pytest.raises(cc.InputError, match=r"has no bound_fraction.*carrier='radius'"):
        cc.Eigenmode(1, branch="-", carrier="bound_fraction").state(P, 64)
    state = cc.Eigenmode(1, 1e-3, branch="-").state(P, 64)
    np.testing.assert_allclose(state.curve.centroid, [1e-3, 0.0], atol=1e-6)
    assert np.all(state.bound_fraction == P.n_bar)


def test_without_adhesion_one_branch_has_no_radius():
    free = P.replace(zeta_1=0.0)
    with pytest.raises(cc.InputError, match=r"has no radius.*carrier='bound_fraction'"):
        cc.Eigenmode(3, branch="-").state(free, 64)
    state = cc.Eigenmode(3, branch="-", carrier="bound_fraction").state(free, 64)
    np.testing.assert_allclose(state.curve.curvature, 1.0, atol=1e-12)


@pytest.mark.parametrize("start", [cc.Eigenmode(9), cc.PerturbedCircle({9: (0.01, 0)})])
def test_too_few_nodes_for_a_mode_are_refused(start):
    with pytest.raises(cc.InputError, match="more than 18"):
        start.state(P, 18)
    start.state(P, 20)


@pytest.mark.parametrize("turn", [0.0, 0.7, 2.0])
def test_outline_keeps_area_and_centroid(turn):
    c, s = math.cos(turn), math.sin(turn)
    xy = (SQUARE - [1.0, 1.0]) * [1.5, 0.8] @ np.array([[c, s], [-s, c]]) + [5.0, -3.0]
    state = cc.FromOutline(xy).state(P, 600)
    assert state.curve.area == pytest.approx(3.0 * 1.6, rel=1e-12)
    np.testing.assert_allclose(state.curve.centroid, [5.0, -3.0], atol=1e-5)
    assert state.tension == P.sigma_bar
    assert np.all(state.bound_fraction == P.n_bar)


def test_outline_in_any_unit_is_scaled_to_the_radius_about_its_centroid():
    state = cc.FromOutline(SQUARE * 1e4, radius=1.0).state(P, 600)
    assert state.curve.area == pytest.approx(math.pi, rel=1e-12)
    np.testing.assert_allclose(state.curve.centroid, [1e4, 1e4], rtol=1e-5)


def test_outline_carries_bound_fraction_along():
    angle = 2.0 * math.pi * np.arange(90) / 90
    xy = np.column_stack([np.cos(angle), np.sin(angle)])
    bound = 0.4 + 0.2 * np.cos(angle)
    for order in (slice(None), slice(None, None, -1)):
        state = cc.FromOutline(xy[order], bound[order], tension=500.0).state(P, 200)
        phi, _ = polar(state)
        np.testing.assert_allclose(state.bound_fraction, 0.4 + 0.2 * np.cos(phi), atol=2e-3)
        assert state.tension == 500.0
    assert np.allclose(cc.FromOutline(xy, 0.25).state(P, 64).bound_fraction, 0.25)


def test_first_node_is_near_the_first_vertex_even_if_it_is_repeated_at_the_end():
    for xy in (SQUARE, np.concatenate([SQUARE, SQUARE[:1]]), SQUARE[[0, 3, 2, 1]]):
        first = cc.FromOutline(xy).state(P, 400).curve.points[0]
        assert np.hypot(*(first - xy[0])) < 0.1


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"bound_fraction": 1.5}, "bound_fraction is 1.5 at vertex 0"),
        ({"bound_fraction": [0.1, 0.2, -0.3, 0.4]}, "bound_fraction is -0.3 at vertex 2"),
        ({"bound_fraction": [0.1, 0.2]}, "one a vertex"),
        ({"bound_fraction": "half"}, "bound_fraction must be an array of numbers"),
        ({"bound_fraction": math.nan}, "bound_fraction is not finite"),
        ({"radius": 0.0}, "radius = 0"),
        ({"radius": math.inf}, "radius = inf"),
        ({"tension": math.nan}, "tension = nan"),
        ({"smoothing": 0.5}, "smoothing = 0.5"),
    ],
)
def test_wrong_outline_options_are_one_line(options, says):
    with pytest.raises(cc.InputError, match=says):
        cc.FromOutline(SQUARE, **options)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: cc.PerturbedCircle(radius={1.5: (0, 0)}), "radius mode = 1.5"),
        (lambda: cc.PerturbedCircle(radius={-1: (0, 0)}), "radius mode = -1"),
        (lambda: cc.PerturbedCircle(radius={"one": (0, 0)}), "radius mode = 'one'"),
        (lambda: cc.PerturbedCircle(radius={"²": (0, 0)}), "radius mode = '²'"),
        (lambda: cc.PerturbedCircle(radius={1: (0, 0), "1": (0, 0)}), "given twice"),
        (lambda: cc.PerturbedCircle(radius={1: 0.1}), "pair of numbers"),
        (lambda: cc.PerturbedCircle(radius={1: {0: 1, 2: 3}}), "pair of numbers"),
        (lambda: cc.PerturbedCircle(radius={1: np.zeros((3, 3))}), "pair of numbers"),
        (lambda: cc.PerturbedCircle(radius={1: (math.nan, 0)}), "cosine = nan"),
        (lambda: cc.PerturbedCircle(radius=[(1, 2)]), "must be a table"),
        (lambda: cc.PerturbedCircle({2: (1.5, 0)}).state(P, 64), "must be positive everywhere"),
        (lambda: cc.PerturbedCircle({}, {2: (0.9, 0)}).state(P, 64), "bound_fraction is"),
        (lambda: cc.RandomPerturbation(seed=-1), "seed = -1"),
        (lambda: cc.RandomPerturbation(seed=1.5), "seed = 1.5"),
        (lambda: cc.RandomPerturbation(amplitude=math.nan), "amplitude = nan"),
        (lambda: cc.RandomPerturbation(modes=0), "modes = 0"),
        (lambda: cc.Eigenmode(k=1.5), "k = 1.5"),
        (lambda: cc.Eigenmode(k=3, branch="*"), "branch = '\\*'"),
        (lambda: cc.Eigenmode(k=3, carrier="radios"), "did you mean 'radius'"),
    ],
)
def test_wrong_starts_are_one_line(make, says):
    with pytest.raises(cc.InputError, match=says) as error:
        make()
    assert len(str(error.value).splitlines()) == 1


@pytest.mark.parametrize(
    "start",
    [
        cc.RandomPerturbation(seed=np.int64(4), amplitude=np.float32(1e-4)),
        cc.PerturbedCircle({np.int64(2): np.array([0.01, 0.02])}),
        cc.Eigenmode(np.int32(3), branch=np.str_("-")),
        cc.FromOutline(SQUARE, 0.3, np.float32(5.0), np.float64(1.0)),
    ],
)
def test_description_is_plain_json_even_of_numpy_values(start):
    described = json.loads(json.dumps(start.describe()))
    kind = getattr(cc, described.pop("kind"))
    again = kind(**described)
    first, second = start.state(P, 64), again.state(P, 64)
    assert np.array_equal(first.curve.theta, second.curve.theta)
    assert np.array_equal(first.bound_fraction, second.bound_fraction)


def test_state_is_checked_and_immutable():
    state = cc.PerturbedCircle().state(P, 64)
    with pytest.raises(ValueError, match="read-only"):
        state.bound_fraction[0] = 0.5
    with pytest.raises(cc.InputError, match="at node 3: it must be from 0 to 1"):
        cc.CellState(state.curve, np.where(np.arange(64) == 3, 1.01, 0.5), 900.0)
    with pytest.raises(cc.InputError, match="tension = nan"):
        cc.CellState(state.curve, state.bound_fraction, math.nan)
