"""Formulas of symbols: exact derivatives, code that gives the formula's values, clear refusals."""

from __future__ import annotations

import math

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.laws import cos, exp, log, maximum, minimum, sin, sqrt, tanh, where
from cellcrawl.laws.expressions import body, number, symbol

X, Y = symbol("x"), symbol("y")
FORMULAS = [
    lambda x, y: x * exp(-0.8 * y) + 0.6 * exp(1.1 * x * y),
    lambda x, y: (x + y) ** 3 / (1.0 + x * x) - y / x,
    lambda x, y: log(1.0 + x * y) * sqrt(x) + 2.0**x,
    lambda x, y: sin(x) * cos(y) + tanh(x - y) + x**1.7,
    lambda x, y: maximum(x, y) * minimum(x * x, y) + where(x > y, x * y, y / x),
    lambda x, y: -x + (y - x) - 3 / y,
]
AT = [(0.7, 1.3), (1.9, 0.4), (1.1, 2.2)]


def evaluated(expression, x, y):
    lines, (result,) = body([expression], {X: "x", Y: "y"})
    space = {
        **{name: getattr(math, name) for name in ("exp", "log", "sqrt", "sin", "cos", "tanh")},
        "choose": lambda condition, a, b: a if condition else b,
        "power": lambda a, b: a**b,
    }
    exec("\n".join(["def f(x, y):", *lines, f"    return {result}"]), space)
    return space["f"](x, y)


@pytest.mark.parametrize("formula", FORMULAS)
@pytest.mark.parametrize("at", AT)
def test_code_gives_the_values_of_the_formula(formula, at):
    assert evaluated(formula(X, Y), *at) == pytest.approx(float(formula(*at)), rel=1e-14)


@pytest.mark.parametrize("formula", FORMULAS)
@pytest.mark.parametrize("at", AT)
def test_derivatives_are_those_of_differences(formula, at):
    x, y = at
    h = 1e-5
    for name, dx, dy in (("x", h, 0.0), ("y", 0.0, h)):
        slope = (formula(x + dx, y + dy) - formula(x - dx, y - dy)) / (2.0 * h)
        made = evaluated(formula(X, Y).derivative(name), x, y)
        assert made == pytest.approx(float(slope), rel=1e-7, abs=1e-8)


def test_equal_formulas_are_one_object_and_numbers_fold():
    assert X * Y + 1.0 is symbol("x") * symbol("y") + 1.0
    assert (X * 0.0 + 2.0) is number(2.0)
    assert exp(number(0.0)) is number(1.0)
    assert 1.0 * X is X


def test_formulas_of_arrays_are_arrays():
    x = np.linspace(0.1, 2.0, 7)
    assert where(x > 1.0, x, -x) == pytest.approx(np.where(x > 1.0, x, -x))
    assert maximum(x, 1.0) == pytest.approx(np.maximum(x, 1.0))


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        (lambda: bool(X > 1.0), "where"),
        (lambda: math.exp(X), "cellcrawl.laws"),
        (lambda: X + "1", "numbers and symbols"),
        (lambda: X / 0.0, "divides by zero"),
        (lambda: where(X, 1.0, 2.0), "comparison"),
        (lambda: X + np.ones(3), "numbers and symbols"),
    ],
)
def test_what_no_formula_can_hold_is_refused_in_one_line(wrong, told):
    with pytest.raises(cc.InputError, match=told) as refused:
        wrong()
    assert "\n" not in str(refused.value)
