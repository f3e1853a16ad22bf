"""A law set for kernels: its formulas and their derivatives as compiled functions.

All law sets are values of one Numba type whose name holds a hash of the formulas, so that a kernel
compiled for one is never taken for another's, from memory or from disk. A kernel takes the law
first and calls the functions of `cellcrawl.laws.functions` with it.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from typing import Any, Final, NamedTuple

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.laws.expressions import Expression, body, exp, number, symbol
from cellcrawl.laws.functions import Compiled, register
from cellcrawl.laws.law import Law

_STATE: Final = ("phi", "r", "n", "sigma", "kappa")


class _Symbols:
    """The local parameters of a law as symbols."""

    def __init__(self, law: Law) -> None:
        self._law = law

    def __getattr__(self, name: str) -> Expression:
        if name not in self._law.rows:
            raise InputError(
                f"{self._law.name} uses a parameter {name!r} that it does not have: it has "
                f"{', '.join(self._law.rows)}"
            )
        return symbol(f"p.{name}")


class Formulas(NamedTuple):
    """A law's formulas as expressions of `phi`, `n`, `sigma`, `kappa` and the parameters.

    ``r`` stands for the off-rate in all but the first.
    """

    off_rate: Expression
    velocity: Expression
    friction: Expression
    balance: Expression
    binding: Expression
    turnover: Expression


class CompiledLaw(Compiled):
    """A law set as an argument of kernels; has no data."""

    def __init__(
        self, name: str, digest: str, source: str, rows: tuple[str, ...], formulas: Formulas
    ) -> None:
        self.name, self.digest, self.source = name, digest, source
        self.rows, self.formulas = rows, formulas
        self._functions: dict[str, Any] = {}
        super().__init__(f"{name}_{digest}")
        register(self.key, self.source)

    def __reduce__(self) -> Any:
        raise TypeError("a compiled law is made anew where it is needed")

    def evaluate(self, what: str, values: Mapping[str, Any]) -> Any:
        """Return a formula, or ``"<formula>/<symbol>"`` for a derivative, on numbers or arrays.

        Derivatives are total in ``phi``: the off-rate goes with it.
        """
        if what not in self._functions:
            self._functions[what] = self._function(what)
        return self._functions[what](values)

    def _function(self, what: str) -> Any:
        name, _, by = what.partition("/")
        expression = getattr(self.formulas, name)
        rate = self.formulas.off_rate
        if by:
            expression = _total(expression, rate, by)
        names = {symbol(s): f"given[{s!r}]" for s in _STATE}
        names |= {symbol(f"p.{row}"): f"given[{row!r}]" for row in self.rows}
        lines, (result,) = body([expression], names)
        code = "\n".join(["def function(given):", *lines, f"    return {result}"])
        space: dict[str, Any] = dict(_ON_ARRAYS)
        exec(code, space)
        return space["function"]


_ON_ARRAYS: Final[dict[str, Any]] = {
    "exp": np.exp,
    "log": np.log,
    "sqrt": np.sqrt,
    "sin": np.sin,
    "cos": np.cos,
    "tanh": np.tanh,
    "choose": np.where,
    "power": lambda a, b: np.where(a > 0.0, np.abs(a) ** b, 0.0),
}


def compiled(law: Law) -> CompiledLaw:
    """Return a law for kernels: one object for all laws of the same formulas."""
    formulas = _traced(law)
    source = _source(formulas, law.rows)
    digest = hashlib.sha256(f"{law.rows}\n{source}".encode()).hexdigest()[:16]
    found = _made.get(digest)
    if found is None:
        found = _made[digest] = CompiledLaw(law.name, digest, source, law.rows, formulas)
    return found


_made: dict[str, CompiledLaw] = {}


def _traced(law: Law) -> Formulas:
    law = _symbolic(law)
    phi, r, n, sigma, kappa = (symbol(name) for name in _STATE)
    p: Any = _Symbols(law)
    off_rate = _formula(law, "off_rate", law.off_rate(phi, p))
    retrograde = _formula(law, "retrograde_velocity", law.retrograde_velocity(phi, r, p))
    friction = _formula(law, "friction", law.friction(phi, r, n, p))
    pull = _formula(law, "pull", law.pull(phi, r, sigma, kappa, p))
    polymerization = _formula(law, "polymerization", law.polymerization(sigma, kappa, p))
    binding = _formula(law, "binding", law.binding(phi, r, n, p))
    turnover = _formula(law, "turnover", law.turnover(phi, r, n, p))
    velocity = p.epsilon * (polymerization - retrograde)
    return Formulas(off_rate, velocity, friction, friction - pull, binding, turnover)


def _symbolic(law: Law) -> Law:
    """Return a law whose numbers are symbols, so that other numbers need no other code."""
    made = object.__new__(type(law))
    made.__dict__.update(law.__dict__)
    made.values = {name: symbol(f"p.{name}") for name in law.values}  # type: ignore[misc]
    return made


def _formula(law: Law, name: str, made: Any) -> Expression:
    if isinstance(made, Expression):
        return made
    if isinstance(made, (int, float)):
        return number(made)
    raise InputError(f"{law.name}.{name} returns {type(made).__name__}, not a formula")


def _total(expression: Expression, rate: Expression, by: str) -> Expression:
    """Derivative of a formula in which ``r`` stands for ``rate(phi)``."""
    direct = expression.derivative(by if by in _STATE else f"p.{by}")
    if by != "phi":
        return direct
    return direct + expression.derivative("r") * rate.derivative("phi")


def _source(formulas: Formulas, rows: tuple[str, ...]) -> str:
    """Code of the functions that kernels call, with local parameters in rows of ``edge``."""
    rate = formulas.off_rate
    balance = formulas.balance
    slope = _total(balance, rate, "phi")
    bend = _total(slope, rate, "phi")
    state = {symbol(name): name for name in _STATE}
    local = {symbol(f"p.{row}"): f"edge[{k}, i]" for k, row in enumerate(rows)}
    given = {**local, **state}
    at_hand = {**given, rate: "r"}  # the off-rate is known wherever phi is
    slip = rate is exp(symbol("phi"))

    def function(name: str, arguments: str, wanted: list[Expression], names: Any) -> str:
        lines, results = body(wanted, names)
        many = "(" + ", ".join(results) + ")" if len(results) > 1 else results[0]
        return "\n".join([f"def {name}(laws, {arguments}, edge, i):", *lines, f"    return {many}"])

    everything = "phi, r, n, sigma, kappa"
    partials = [_total(balance, rate, by) for by in ("phi", "n", "sigma", "kappa")]
    partials += [_total(formulas.velocity, rate, by) for by in ("phi", "sigma", "kappa")]
    partials += [_total(formulas.binding, rate, by) for by in ("phi", "n")]
    renewed = (
        "def renewed_rate(laws, r, phi, step, edge, i):\n    return r * growth(step)"
        if slip
        else function("renewed_rate", "r, phi, step", [rate], given)
    )
    nearly = (
        "def nearly_renewed_rate(laws, r, phi, step, edge, i):\n"
        "    return r * (1.0 + step * (1.0 + 0.5 * step))"
        if slip
        else function("nearly_renewed_rate", "r, phi, step", [rate], given)
    )
    return "\n\n".join(
        [
            function("off_rate", "phi", [rate], given),
            renewed,
            nearly,
            function("balance", everything, [balance, slope, bend], at_hand),
            function("velocity", "phi, r, sigma, kappa", [formulas.velocity], at_hand),
            function("friction", "phi, r, n", [formulas.friction], at_hand),
            function("binding", "phi, r, n", [formulas.binding], at_hand),
            function("turnover", "phi, r, n", [formulas.turnover], at_hand),
            function("partials", everything, partials, at_hand),
        ]
    )
