"""Formulas as expressions: what a law's methods make of symbols, with exact derivatives.

A law is written once, as plain formulas. Called with numbers or arrays they give values; called
with symbols they give an `Expression`, from which derivatives and compiled code are made. An
expression has no ``if``: use `where`, `maximum` or `minimum`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, ClassVar, Final

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError

_FUNCTIONS: Final[dict[str, Any]] = {
    "exp": np.exp,
    "log": np.log,
    "sqrt": np.sqrt,
    "sin": np.sin,
    "cos": np.cos,
    "tanh": np.tanh,
}
_COMPARISONS: Final = ("<", "<=", ">", ">=")


class Expression:
    """A formula: an operation and what it works on. Equal ones are one object."""

    __slots__ = ("operands", "operation")
    _made: ClassVar[dict[tuple[Any, ...], Expression]] = {}
    operation: str
    operands: tuple[Any, ...]

    def __new__(cls, operation: str, *operands: Any) -> Expression:
        key = (operation, *(id(o) if isinstance(o, Expression) else o for o in operands))
        found = cls._made.get(key)
        if found is None:
            found = object.__new__(cls)
            found.operation, found.operands = operation, operands
            cls._made[key] = found
        return found

    __array_ufunc__ = None  # NumPy leaves mixed operations to this class

    def __add__(self, other: Any) -> Expression:
        return _sum(self, _expression(other))

    def __radd__(self, other: Any) -> Expression:
        return _sum(_expression(other), self)

    def __sub__(self, other: Any) -> Expression:
        return _difference(self, _expression(other))

    def __rsub__(self, other: Any) -> Expression:
        return _difference(_expression(other), self)

    def __mul__(self, other: Any) -> Expression:
        return _product(self, _expression(other))

    def __rmul__(self, other: Any) -> Expression:
        return _product(_expression(other), self)

    def __truediv__(self, other: Any) -> Expression:
        return _quotient(self, _expression(other))

    def __rtruediv__(self, other: Any) -> Expression:
        return _quotient(_expression(other), self)

    def __pow__(self, other: Any) -> Expression:
        return _power(self, _expression(other))

    def __rpow__(self, other: Any) -> Expression:
        return _power(_expression(other), self)

    def __neg__(self) -> Expression:
        return _product(number(-1.0), self)

    def __lt__(self, other: Any) -> Expression:
        return Expression("<", self, _expression(other))

    def __le__(self, other: Any) -> Expression:
        return Expression("<=", self, _expression(other))

    def __gt__(self, other: Any) -> Expression:
        return Expression(">", self, _expression(other))

    def __ge__(self, other: Any) -> Expression:
        return Expression(">=", self, _expression(other))

    def __bool__(self) -> bool:
        raise InputError("a formula cannot choose by `if`, `and` or `or`: use cellcrawl.laws.where")

    def __float__(self) -> float:
        raise InputError(
            "a formula can only use +, -, *, /, ** and the functions of cellcrawl.laws "
            "(exp, log, sqrt, sin, cos, tanh, maximum, minimum, where), not those of math"
        )

    __hash__ = object.__hash__

    def derivative(self, name: str) -> Expression:
        """Return the derivative with respect to the symbol ``name``."""
        return _derivative(self, symbol(name), {})


def symbol(name: str) -> Expression:
    """Return the symbol ``name``."""
    return Expression("symbol", name)


def number(value: float) -> Expression:
    """Return a number as an expression."""
    return Expression("number", float(value))


@checked
def exp(x: Any) -> Any:
    """Exponential of a number, an array or an expression."""
    return _function("exp", x)


@checked
def log(x: Any) -> Any:
    """Natural logarithm of a number, an array or an expression."""
    return _function("log", x)


@checked
def sqrt(x: Any) -> Any:
    """Square root of a number, an array or an expression."""
    return _function("sqrt", x)


@checked
def sin(x: Any) -> Any:
    """Sine of a number, an array or an expression."""
    return _function("sin", x)


@checked
def cos(x: Any) -> Any:
    """Cosine of a number, an array or an expression."""
    return _function("cos", x)


@checked
def tanh(x: Any) -> Any:
    """Hyperbolic tangent of a number, an array or an expression."""
    return _function("tanh", x)


@checked
def where(condition: Any, if_true: Any, if_false: Any) -> Any:
    """Choose between two values, node by node, by a comparison such as ``x > 0``."""
    if isinstance(condition, Expression):
        if condition.operation not in _COMPARISONS:
            raise InputError("where chooses by a comparison, such as phi > 1")
        return Expression("where", condition, _expression(if_true), _expression(if_false))
    if isinstance(if_true, Expression) or isinstance(if_false, Expression):
        return if_true if condition else if_false
    return np.where(condition, if_true, if_false)


@checked
def maximum(a: Any, b: Any) -> Any:
    """Return the larger of two values."""
    if isinstance(a, Expression) or isinstance(b, Expression):
        first, second = _expression(a), _expression(b)
        return where(first > second, first, second)
    return np.maximum(a, b)


@checked
def minimum(a: Any, b: Any) -> Any:
    """Return the smaller of two values."""
    if isinstance(a, Expression) or isinstance(b, Expression):
        first, second = _expression(a), _expression(b)
        return where(first < second, first, second)
    return np.minimum(a, b)


def call(name: str, *arguments: Any) -> Expression:
    """Return a call of a compiled function that is known by ``name`` and has no derivative."""
    return Expression("call", name, *(_expression(argument) for argument in arguments))


def symbols_of(expressions: Iterable[Expression]) -> set[str]:
    """Return the names of all symbols in some expressions."""
    return {node.operands[0] for node in _ordered(expressions) if node.operation == "symbol"}


def body(
    expressions: Iterable[Expression], names: Mapping[Expression, str], indent: str = "    "
) -> tuple[list[str], list[str]]:
    """Return lines of Python that evaluate some expressions, and what holds their values.

    ``names`` gives the code of symbols, and of whole expressions that are at hand already.
    """
    wanted = list(expressions)
    known = dict(names)
    lines: list[str] = []
    for node in _ordered(wanted, known):
        if node in known or node.operation in _COMPARISONS:
            continue
        if node.operation == "number":
            known[node] = repr(node.operands[0])
            continue
        if node.operation == "symbol":
            raise InputError(f"the formula has no parameter or variable {node.operands[0]!r}")
        name = f"v{len(lines)}"
        lines.append(f"{indent}{name} = {_code(node, known)}")
        known[node] = name
    return lines, [known[node] for node in wanted]


def _code(node: Expression, known: Mapping[Expression, str]) -> str:
    operation, operands = node.operation, node.operands
    if operation in "+-*/":
        return f"{known[operands[0]]} {operation} {known[operands[1]]}"
    if operation == "**":
        return f"power({known[operands[0]]}, {known[operands[1]]})"
    if operation == "where":
        condition, if_true, if_false = operands
        left, right = (known[side] for side in condition.operands)
        chosen = f"{known[if_true]}, {known[if_false]}"
        return f"choose({left} {condition.operation} {right}, {chosen})"
    if operation == "call":
        return f"{operands[0]}({', '.join(known[operand] for operand in operands[1:])})"
    return f"{operation}({known[operands[0]]})"


def _ordered(
    expressions: Iterable[Expression], known: Mapping[Expression, str] | None = None
) -> list[Expression]:
    """Return all parts of some expressions, each after what it works on."""
    found: dict[Expression, None] = {}
    stack = [(node, False) for node in reversed(list(expressions))]
    while stack:
        node, ready = stack.pop()
        if node in found:
            continue
        if ready or (known is not None and node in known):
            found[node] = None
            continue
        stack.append((node, True))
        stack += [(o, False) for o in reversed(node.operands) if isinstance(o, Expression)]
    return list(found)


def _expression(value: Any) -> Expression:
    if isinstance(value, Expression):
        return value
    if isinstance(value, (bool, str)) or not np.isscalar(value):
        raise InputError(f"a formula is made of numbers and symbols, not {type(value).__name__}")
    return number(float(value))  # type: ignore[arg-type]


def _value(node: Expression) -> float | None:
    return node.operands[0] if node.operation == "number" else None


def _sum(a: Expression, b: Expression) -> Expression:
    x, y = _value(a), _value(b)
    if x is not None and y is not None:
        return number(x + y)
    if x == 0.0:
        return b
    return a if y == 0.0 else Expression("+", a, b)


def _difference(a: Expression, b: Expression) -> Expression:
    x, y = _value(a), _value(b)
    if x is not None and y is not None:
        return number(x - y)
    if a is b:
        return number(0.0)
    return a if y == 0.0 else Expression("-", a, b)


def _product(a: Expression, b: Expression) -> Expression:
    x, y = _value(a), _value(b)
    if x is not None and y is not None:
        return number(x * y)
    if x == 0.0 or y == 0.0:
        return number(0.0)
    if x == 1.0:
        return b
    return a if y == 1.0 else Expression("*", a, b)


def _quotient(a: Expression, b: Expression) -> Expression:
    x, y = _value(a), _value(b)
    if y == 0.0:
        raise InputError("a formula divides by zero")
    if x is not None and y is not None:
        return number(x / y)
    if x == 0.0:
        return number(0.0)
    return a if y == 1.0 else Expression("/", a, b)


def _power(a: Expression, b: Expression) -> Expression:
    x, y = _value(a), _value(b)
    if x is not None and y is not None:
        return number(x**y)
    if y is not None and y.is_integer() and 0 <= y <= 4:
        product = number(1.0)
        for _ in range(int(y)):
            product = _product(product, a)
        return product
    return Expression("**", a, b)


def _function(name: str, x: Any) -> Any:
    if not isinstance(x, Expression):
        return _FUNCTIONS[name](x)
    value = _value(x)
    return Expression(name, x) if value is None else number(float(_FUNCTIONS[name](value)))


def _derivative(
    node: Expression, by: Expression, known: dict[Expression, Expression]
) -> Expression:
    if node not in known:
        known[node] = _made_derivative(node, by, known)
    return known[node]


def _made_derivative(
    node: Expression, by: Expression, known: dict[Expression, Expression]
) -> Expression:
    operation, operands = node.operation, node.operands
    if node is by:
        return number(1.0)
    if operation in ("symbol", "number", "call"):
        return number(0.0)
    if operation == "where":
        condition, *chosen = operands
        if_true, if_false = (_derivative(part, by, known) for part in chosen)
        same = if_true is if_false
        return if_true if same else Expression("where", condition, if_true, if_false)
    slopes = [_derivative(operand, by, known) for operand in operands]
    a: Expression = operands[0]
    da: Expression = slopes[0]
    if operation == "+":
        return _sum(da, slopes[1])
    if operation == "-":
        return _difference(da, slopes[1])
    if operation == "*":
        return _sum(_product(da, operands[1]), _product(a, slopes[1]))
    if operation == "/":
        return _quotient(da - node * slopes[1], operands[1])
    if operation == "**":
        b: Expression = operands[1]
        db = slopes[1]
        moving = b * a ** (b - 1.0) * da
        return moving if _value(db) == 0.0 else _sum(moving, node * log(a) * db)
    outer: Expression = _OUTER[operation](a, node)
    return outer * da


_OUTER: Final[dict[str, Any]] = {
    "exp": lambda a, node: node,
    "log": lambda a, node: 1.0 / a,
    "sqrt": lambda a, node: 0.5 / node,
    "sin": lambda a, node: cos(a),
    "cos": lambda a, node: -sin(a),
    "tanh": lambda a, node: 1.0 - node * node,
}
