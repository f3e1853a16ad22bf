import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cellcrawl.laws import PAPER
from cellcrawl.laws.force_balance import SOLVED, bond_force, bond_force_near, solve_bonds
from tests.strategies import parameters

NODES = 40


def edge(nodes=1, **rows):
    """Local parameters of the paper's law: 0 but for those given."""
    made = np.zeros((len(PAPER.rows), nodes))
    for name, values in rows.items():
        made[PAPER.rows.index(name)] = values
    return made


def balance(y, n, zeta_1, force):
    """Solve one edge whose pull is the contraction alone, by the search and from the guess."""
    column = edge(zeta_1=zeta_1, sigma_c=force)
    found = bond_force(PAPER.compiled, y, n, 0.0, 0.0, column, 0)
    near = bond_force_near(PAPER.compiled, y, n, 0.0, 0.0, column, 0)
    assert near == pytest.approx(found, rel=1e-12, abs=1e-13, nan_ok=True)
    return found


def friction(y, n, zeta_1):
    """Equation 8, written out again."""
    return y * np.exp(y) + zeta_1 * n * y


def solve(y, n, force, zeta_1):
    """Solve with the pull given by the contraction alone; return the code and ``y``."""
    y = np.array(y, dtype=float)
    zero = np.zeros_like(y)
    rows = edge(y.size, zeta_1=zeta_1, sigma_c=force)
    code = solve_bonds(PAPER.compiled, y, n, 0.0, zero, rows)
    return code, y


fractions = st.lists(st.floats(0.0, 1.0), min_size=NODES, max_size=NODES).map(np.array)
pulls = st.lists(st.floats(0.0, 3000.0), min_size=NODES, max_size=NODES).map(np.array)
guesses = st.one_of(
    st.just(np.zeros(NODES)),
    st.just(np.full(NODES, math.log(50.0))),
    st.just(np.full(NODES, 600.0)),
    st.lists(st.floats(-5.0, 50.0), min_size=NODES, max_size=NODES).map(np.array),
)


@given(guesses, fractions, pulls, st.floats(0.0, 2000.0))
def test_residual_is_below_1e_10_from_any_guess(guess, n, force, zeta_1):
    code, y = solve(guess, n, force, zeta_1)
    assert code == SOLVED
    assert np.all(y >= 0.0)
    assert np.abs(friction(y, n, zeta_1) - force).max() < 1e-10


@given(guesses, fractions, st.floats(-2.0, 8.0), st.floats(0.0, 2000.0))
def test_residual_of_huge_pulls_is_rounding(guess, n, power, zeta_1):
    force = np.full(NODES, 10.0**power)
    code, y = solve(guess, n, force, zeta_1)
    assert code == SOLVED
    assert np.abs(friction(y, n, zeta_1) / force - 1.0).max() < 1e-12


@given(guesses, fractions, pulls, st.floats(0.0, 2000.0))
def test_root_does_not_depend_on_the_guess(guess, n, force, zeta_1):
    _, y = solve(guess, n, force, zeta_1)
    for i in range(0, NODES, 7):
        for start in (0.0, 1.0, 100.0, math.nan):
            assert balance(start, n[i], zeta_1, force[i]) == pytest.approx(
                y[i], rel=1e-10, abs=1e-14
            )


@given(st.floats(0.0, 1.0), st.floats(0.0, 2000.0), st.floats(0.0, 15.0))
def test_the_root_that_made_the_pull_is_found(n, zeta_1, y):
    found = balance(0.0, n, zeta_1, friction(y, n, zeta_1))
    assert found == pytest.approx(y, rel=1e-13, abs=1e-14)


@given(st.floats(0.0, 1.0), st.floats(0.0, 2000.0), st.floats(0.0, 1e4))
def test_root_rises_with_the_pull_and_falls_with_adhesion(n, zeta_1, force):
    y = balance(0.0, n, zeta_1, force)
    assert balance(0.0, n, zeta_1, force + 1.0) > y
    assert balance(0.0, n, zeta_1 + 1.0, force) <= y


@given(parameters)
def test_resting_circle_has_the_off_rate_it_is_named_for(p):
    pull = p.sigma_c + p.sigma_bar * (1.0 + p.h)
    assert balance(0.0, p.n_bar, p.zeta_1, pull) == pytest.approx(math.log(p.r_p), rel=1e-12)


@given(parameters, st.floats(-20.0, 60.0))
@settings(max_examples=200)
def test_each_node_has_a_root_exactly_where_the_pull_is_not_negative(p, kappa):
    y = np.full(NODES, math.log(p.r_p))
    n, bent = np.full(NODES, p.n_bar), np.ones(NODES)
    bent[17] = kappa
    rows = edge(NODES, zeta_1=p.zeta_1, sigma_c=p.sigma_c, h=p.h)
    code = solve_bonds(PAPER.compiled, y, n, p.sigma_bar, bent, rows)
    pull = p.sigma_c + p.sigma_bar * (1.0 + p.h * kappa)
    resting = p.sigma_c + p.sigma_bar * (1.0 + p.h)
    if min(pull, resting) > 1e-9:
        assert code == SOLVED
        assert np.isfinite(y).all()
    elif resting > 1e-9 and pull < -1e-9:
        assert code == 17


@pytest.mark.parametrize(
    ("n", "zeta_1", "force"),
    [
        (0.3, 600.0, -1e-300),
        (0.3, 600.0, -5.0),
        (math.nan, 600.0, 1.0),
        (0.3, math.nan, 1.0),
        (0.3, 600.0, math.nan),
        (0.3, 600.0, math.inf),
        (-0.3, 600.0, 1.0),
    ],
)
def test_no_root_and_not_a_number_are_flagged_never_returned(n, zeta_1, force):
    assert math.isnan(balance(1.0, n, zeta_1, force))
    good = np.full(NODES, 0.3)
    pull = np.full(NODES, 10.0)
    code, _ = solve(np.ones(NODES), good, pull, 600.0)
    assert code == SOLVED
    friction_at = np.full(NODES, 600.0)
    good[5], pull[5], friction_at[5] = n, force, zeta_1
    code, _ = solve(np.ones(NODES), good, pull, friction_at)
    assert code == 5


def test_no_pull_is_no_extension():
    assert balance(3.0, 0.5, 600.0, 0.0) == 0.0
    code, y = solve(np.full(NODES, 3.0), np.full(NODES, 0.5), np.zeros(NODES), 600.0)
    assert code == SOLVED
    assert np.abs(y).max() < 1e-15


def test_a_guess_that_is_not_a_number_is_recovered_from():
    guess = np.full(NODES, math.nan)
    code, y = solve(guess, np.full(NODES, 0.3), np.full(NODES, 900.0), 600.0)
    assert code == SOLVED
    assert np.abs(friction(y, 0.3, 600.0) - 900.0).max() < 1e-10
