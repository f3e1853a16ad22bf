"""What a law set is: the model's pointwise formulas, each of which a subclass may replace."""

from __future__ import annotations

import functools
import importlib
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Final, Self

from cellcrawl.errors import InputError
from cellcrawl.laws.expressions import exp
from cellcrawl.validation import known_names, real_number, shown

if TYPE_CHECKING:
    from cellcrawl.laws.compiled import CompiledLaw

LOCAL: Final = ("r_on", "zeta_1", "D", "epsilon", "h", "sigma_c", "v_p", "pressure")
"""What every law may use, with a value at each node; ``pressure`` is what surroundings add."""


class Parameter:
    """A number of a law or a surrounding: its usual value, its range and what it means.

    Parameters
    ----------
    default, low, high : float
        The value unless given, and the values allowed.
    meaning : str
        One line, with the unit if it is not dimensionless.
    """

    def __init__(self, default: float, low: float, high: float, meaning: str) -> None:
        self.default, self.low, self.high, self.meaning = default, low, high, meaning

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def __get__(self, instance: Any, owner: type | None = None) -> Any:
        return self if instance is None else instance.values[self.name]

    def __set__(self, instance: Any, value: Any) -> None:
        raise AttributeError(f"{type(instance).__name__} is immutable: make a new one")


class Described:
    """Something frozen that its class, with a few numbers, describes; equal by content."""

    parameters: ClassVar[Mapping[str, Parameter]] = {}
    values: Mapping[str, float]

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        own = {name: value for name, value in vars(cls).items() if isinstance(value, Parameter)}
        cls.parameters = {**cls.parameters, **own}

    def __init__(self, **values: float) -> None:
        name = type(self).__name__
        known_names(name, values, self.parameters)
        self.values = {
            key: real_number(f"{name} {key}", values.get(key, p.default), p.low, p.high)
            for key, p in self.parameters.items()
        }

    def describe(self) -> dict[str, Any]:
        """Return the class and its numbers as plain values, from which `described` makes it."""
        kind = type(self)
        return {"kind": f"{_home(kind)}:{kind.__qualname__}", "values": dict(self.values)}

    def replace(self, **values: float) -> Self:
        """Return the same with other numbers."""
        return type(self)(**{**self.values, **values})

    def __getstate__(self) -> dict[str, Any]:
        return {
            name: value
            for name, value in self.__dict__.items()
            if name not in ("compiled", "_hash")
        }

    def __eq__(self, other: object) -> bool:
        if self is other:
            return True
        return isinstance(other, Described) and self.describe() == other.describe()

    @functools.cached_property
    def _hash(self) -> int:
        return hash(repr(self.describe()))

    def __hash__(self) -> int:
        return self._hash

    def __repr__(self) -> str:
        given = ", ".join(f"{name}={value:g}" for name, value in self.values.items())
        return f"{type(self).__name__}({given})"


class Law(Described):
    """The laws of Chen, Saintillan & Rangamani (2023), and the base of all others.

    A subclass replaces what differs. The formulas take numbers, arrays or symbols; they are made of
    ``+ - * / **`` and the functions of `cellcrawl.laws`, and ``where`` in place of ``if``. Their
    derivatives and the compiled code are made from them. ``p`` holds the local parameters by name:
    those of the model (``p.r_on``, ``p.zeta_1``, ``p.D``, ``p.epsilon``, ``p.h``, ``p.sigma_c``,
    ``p.v_p``), the ``p.pressure`` of what surrounds the cell, and the law's own.

    ``phi`` is the force on a bond over its force scale; ``log r`` for a slip bond. ``n`` is the
    bound fraction, ``r`` the off-rate, ``sigma`` the membrane tension, ``kappa`` the curvature.
    All is dimensionless.
    """

    source: ClassVar[str] = "Chen, Saintillan & Rangamani, PRX Life 1, 023007 (2023)"

    def off_rate(self, phi: Any, p: Any) -> Any:
        """Off-rate ``r`` of a bond that bears ``phi``."""
        return exp(phi)

    def retrograde_velocity(self, phi: Any, r: Any, p: Any) -> Any:
        """Velocity ``v_r`` at which the network flows back, in units of v_beta."""
        return phi * r

    def friction(self, phi: Any, r: Any, n: Any, p: Any) -> Any:
        """Friction (traction) of the edge on the ground, which balances the `pull`."""
        return phi * (r + p.zeta_1 * n)

    def contraction(self, phi: Any, r: Any, p: Any) -> Any:
        """Contraction of the network by myosin, a part of the `pull`."""
        return p.sigma_c

    def membrane(self, sigma: Any, kappa: Any, p: Any) -> Any:
        """Pull of the membrane on a unit length of edge."""
        return sigma * (1.0 + kappa * p.h)

    def pull(self, phi: Any, r: Any, sigma: Any, kappa: Any, p: Any) -> Any:
        """Inward pull that the friction must balance."""
        return self.contraction(phi, r, p) + self.membrane(sigma, kappa, p) + p.pressure

    def polymerization(self, sigma: Any, kappa: Any, p: Any) -> Any:
        """Velocity at which actin grows against the membrane, in units of v_beta."""
        return p.v_p

    def binding(self, phi: Any, r: Any, n: Any, p: Any) -> Any:
        """Rate of change of ``n`` at a material point, without diffusion."""
        return p.r_on * (1.0 - n) - r * n

    def turnover(self, phi: Any, r: Any, n: Any, p: Any) -> Any:
        """Rates of binding and of unbinding together, from which the noise of few bonds comes."""
        return self.binding(phi, r, n, p) + 2.0 * r * n

    def check(self, parameters: Any) -> str | None:
        """Return why the law cannot be used with some `Parameters`, or None."""
        return None

    @property
    def name(self) -> str:
        """Name of the law set."""
        return type(self).__name__

    @property
    def rows(self) -> tuple[str, ...]:
        """Names of the local parameters, in the order of the rows of ``edge``."""
        return (*LOCAL, *self.parameters)

    @functools.cached_property
    def compiled(self) -> CompiledLaw:
        """The law for kernels, made on first use."""
        from cellcrawl.laws.compiled import compiled

        return compiled(self)

    def describe(self) -> dict[str, Any]:
        return {**super().describe(), "formulas": self.compiled.digest}


class Paper(Law):
    """The laws of Chen, Saintillan & Rangamani (2023), as they are."""


PAPER: Final = Paper()


def _script() -> str | None:
    """Return the name under which the script that runs could be imported."""
    file = getattr(sys.modules["__main__"], "__file__", None)
    return None if file is None else Path(file).stem


def _home(kind: type[Any]) -> str:
    """Return the module of a class; that of one in the script that runs is the script's name."""
    own = kind.__module__ in ("__main__", "__mp_main__")
    return (own and _script()) or kind.__module__


def _module(name: str) -> Any:
    if name == _script():
        return sys.modules["__main__"]
    return sys.modules.get(name) or importlib.import_module(name)


def described(content: Any, base: type[Any], what: str) -> Any:
    """Return what `Described.describe` described, or raise `InputError` in one line.

    A class of the user's must be importable here, and its formulas must be those of the run.
    """
    try:
        kind, values = content["kind"], dict(content.get("values", {}))
        module, _, name = kind.partition(":")
    except (TypeError, KeyError, AttributeError):
        raise InputError(f"{what} cannot be read: {shown(content)}") from None
    try:
        found = _module(module)
        for part in name.split("."):
            found = getattr(found, part)
        made = found(**values)
    except (ImportError, AttributeError, TypeError, ValueError) as error:
        raise InputError(
            f"the {what} {name} of this run is not on this machine: {module}.py must be importable "
            f"({error})"
        ) from None
    if not isinstance(made, base):
        raise InputError(f"{kind} is no {what} of cellcrawl")
    if "formulas" in content and made.describe()["formulas"] != content["formulas"]:
        raise InputError(
            f"the {what} {name} in {module} is not that of this run: its formulas have changed"
        )
    return made
