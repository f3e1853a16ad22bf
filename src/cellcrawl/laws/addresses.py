"""Kernels of a law that others call by their address, so that these compile once for all laws.

Numba compiles a kernel with all that it calls, anew for every law. A caller that is given addresses
in place of the law has nothing of it: a new law compiles its own few kernels and no more.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, Final, TypeVar, cast

import numba
from numba.core import cgutils as _cgutils
from numba.core import types as _types
from numba.core import typing as _typing
from numba.extending import intrinsic, overload

from cellcrawl.laws.functions import LawType
from cellcrawl.numerics.kernels import INLINED, kernel

F = TypeVar("F", bound=Callable[..., Any])

# Numba's own modules, most of whose functions have no types
types: Any = _types
cgutils: Any = _cgutils
typing: Any = _typing
typeof: Any = numba.typeof

NUMBER: Final[Any] = types.float64
TRUTH: Final[Any] = types.boolean
NOTHING: Final[Any] = types.none
ROW: Final[Any] = types.Array(types.float64, 1, "C")
ROWS: Final[Any] = types.Array(types.float64, 2, "C")
AROUND: Final = object()
"""Surroundings at work, of any kind, or None."""


def called_by_address(returned: Any, *arguments: Any) -> Callable[[F], F]:
    """Compile a kernel that takes a law first, and lets kernels call it in two ways.

    With a compiled law as that argument it is called as any other kernel. With a named tuple of
    addresses from `address`, one under the kernel's name, whatever law it was compiled for is
    called. Surroundings are then given without what they compile to, see `without_code`.

    Parameters
    ----------
    returned, *arguments : Numba type
        Of the result and of all arguments but the law; `AROUND` for surroundings.
    """

    def decorate(function: F) -> F:
        name = function.__name__
        compiled: Any = kernel(function)
        call = _call(returned, arguments)

        @functools.wraps(function)
        def called(laws: Any, *given: Any) -> Any:
            return compiled(laws, *given)

        def directly(laws: Any, *given: Any) -> Any:
            return compiled(laws, *given)

        def chosen(laws: Any, *given: Any) -> Any:
            if isinstance(laws, LawType):
                return directly
            if not isinstance(laws, types.NamedUniTuple) or name not in laws.fields:
                return None
            which = laws.fields.index(name)

            def through(laws: Any, *given: Any) -> Any:
                return call(laws[which], given)

            return through

        overload(called, jit_options=INLINED, strict=False)(chosen)
        setattr(called, "compiled", compiled)  # noqa: B010, a function has no such attribute
        setattr(called, "arguments", arguments)  # noqa: B010
        return cast(F, called)

    return decorate


def address(called: Any, laws: Any, around: Any) -> int:
    """Return where the kernel lies that is compiled for a law and surroundings."""
    place = typeof(around)
    kinds = (typeof(laws), *(place if kind is AROUND else kind for kind in called.arguments))
    called.compiled.compile(kinds)
    made = called.compiled.overloads[kinds]
    found = int(made.library.get_pointer_to_function(made.fndesc.llvm_func_name))
    if found == 0:  # a call of it would end the program
        raise RuntimeError(f"numba has no code of {called.__name__}")
    return found


def without_code(around: Any) -> Any:
    """Return surroundings at work for a caller by address: of one type whatever they compile to.

    What they compile to has no data, and None takes its place among the arguments.
    """
    return None if around is None else around._replace(compiled=None)


def _call(returned: Any, arguments: tuple[Any, ...]) -> Any:
    """Return what calls a kernel at an address with its arguments but the law, in a tuple."""

    @intrinsic
    def call(context: Any, where: Any, given: Any) -> Any:
        for kind, declared in zip(given, arguments, strict=True):
            if declared is not AROUND and types.unliteral(kind) != declared:
                raise numba.TypingError(f"a kernel takes {declared}, not {kind}")

        def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            kinds = (types.none, *given)  # a law has no data and looks like None
            convention = context.call_conv
            kind = convention.get_function_type(returned, kinds)
            function = builder.inttoptr(values[0], kind.as_pointer())
            passed = [context.get_dummy_value(), *cgutils.unpack_tuple(builder, values[1])]
            status, result = convention.call_function(builder, function, returned, kinds, passed)
            with cgutils.if_unlikely(builder, status.is_error):
                convention.return_status_propagate(builder, status)
            return result

        return typing.signature(returned, where, given), generate

    return call
