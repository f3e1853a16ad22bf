"""What surroundings are: fields in space and time that change the parameters of the edge there."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import Any, ClassVar, Final

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.laws.expressions import Expression, body, call, number, symbol
from cellcrawl.laws.functions import Compiled, register
from cellcrawl.laws.law import Described, Law
from cellcrawl.surroundings.lookup import disc_depth, image_value, polygon_depth
from cellcrawl.validation import shown

_LOOKUPS: Final = {
    "disc_depth": disc_depth,
    "image_value": image_value,
    "polygon_depth": polygon_depth,
}
_AT: Final = ("x", "y", "time", "normal_x", "normal_y")


class Place:
    """Where a node is, for `Surrounding.change`: ``x``, ``y``, ``time`` and the outward normal."""

    x: Any
    y: Any
    time: Any
    normal_x: Any
    normal_y: Any

    def __init__(self, **values: Any) -> None:
        self.__dict__.update(values)


class Surrounding(Described):
    """A field that changes local parameters where the edge is; the base of all others.

    A subclass says in `change` what becomes of the parameters. Its own numbers are `Parameter`
    fields, which may be changed without anything being compiled anew.
    """

    source: ClassVar[str] = ""

    def change(self, at: Place, p: Any) -> Mapping[str, Any]:
        """Return new values of local parameters by name, from those before (``p.r_on``, …).

        ``at.x`` and ``at.y`` are in cell radii, ``at.time`` in 1/k_off0; ``at.normal_x`` and
        ``at.normal_y`` point out of the cell. A ``p.pressure`` pushes the edge inwards.
        """
        raise NotImplementedError

    def table(self) -> np.ndarray:
        """Return numbers that `change` looks up by `look_up`: an image, the corners of a wall."""
        return np.empty(0)

    def look_up(self, function: str, at: Place) -> Any:
        """Return what a function of `cellcrawl.surroundings.lookup` makes of the table there."""
        looked_up = np.vectorize(_LOOKUPS[function], excluded=(0, 1), otypes=[float])
        return looked_up(self.table(), 0.0, at.x, at.y)


class CompiledSurroundings(Compiled):
    """Surroundings as an argument of kernels, with their numbers."""

    def __init__(self, digest: str, source: str, data: np.ndarray) -> None:
        self.digest, self.source, self.data = digest, source, data
        super().__init__(f"surroundings_{digest}")
        register(self.key, source, _LOOKUPS)

    def __reduce__(self) -> Any:
        raise TypeError("compiled surroundings are made anew where they are needed")


class Surroundings:
    """Some surroundings together, each of which sees what the earlier have made of the parameters.

    Parameters
    ----------
    parts : sequence of Surrounding
    """

    def __init__(self, parts: Sequence[Surrounding]) -> None:
        for part in parts:
            if not isinstance(part, Surrounding):
                raise InputError(
                    f"surroundings must be of cellcrawl.surroundings, not {shown(part)}"
                )
        self.parts = tuple(parts)

    def describe(self) -> list[dict[str, Any]]:
        """Return the parts as plain values."""
        return [part.describe() for part in self.parts]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Surroundings) and self.parts == other.parts

    def __hash__(self) -> int:
        return hash(self.parts)

    def __repr__(self) -> str:
        return f"Surroundings({list(self.parts)!r})"

    def values(self, p: Mapping[str, Any], at: Place) -> dict[str, Any]:
        """Return the local parameters at places, from those far from all by name."""
        now = dict(p)
        for part in self.parts:
            now |= part.change(at, SimpleNamespace(**now))
        return now

    def compiled(self, law: Law) -> CompiledSurroundings:
        """Return them for kernels under a law."""
        source, data = _source(self.parts, law.rows)
        digest = hashlib.sha256(source.encode()).hexdigest()[:16]
        return CompiledSurroundings(digest, source, data)


class _Local:
    """Local parameters as symbols, or as what earlier surroundings made of them."""

    def __init__(self, rows: Sequence[str]) -> None:
        self._rows = rows
        self._now: dict[str, Expression] = {}

    def __getattr__(self, name: str) -> Expression:
        if name.startswith("_"):
            raise AttributeError(name)
        if name not in self._rows:
            raise InputError(
                f"there is no local parameter {name!r} under these laws: there are "
                f"{', '.join(self._rows)}"
            )
        return self._now.get(name, symbol(f"p.{name}"))


def _symbolic(part: Surrounding, first: int, table: int) -> Surrounding:
    """Return a surrounding whose numbers are symbols of entries of the data."""
    made = object.__new__(type(part))
    made.__dict__.update(part.__dict__)
    made.values = {name: symbol(f"data.{first + k}") for k, name in enumerate(part.values)}  # type: ignore[misc]

    def look_up(function: str, at: Place) -> Expression:
        return call(function, symbol("data"), number(table), at.x, at.y)

    made.look_up = look_up  # type: ignore[method-assign]
    return made


def _source(parts: Sequence[Surrounding], rows: Sequence[str]) -> tuple[str, np.ndarray]:
    at = Place(**{name: symbol(name) for name in _AT})
    p = _Local(rows)
    data: list[float] = []
    changed: dict[str, Expression] = {}
    for part in parts:
        first, numbers = len(data), list(part.values.values())
        data += [*numbers, *map(float, part.table())]
        made = _symbolic(part, first, first + len(numbers)).change(at, p)
        for name, value in made.items():
            if name not in rows:
                raise InputError(
                    f"{type(part).__name__} changes {name!r}, which these laws do not have: they "
                    f"have {', '.join(rows)}"
                )
            changed[name] = value if isinstance(value, Expression) else number(float(value))
        p._now = dict(changed)
    names = {symbol(name): name for name in _AT}
    names |= {symbol(f"p.{row}"): f"edge[{k}, i]" for k, row in enumerate(rows)}
    names |= {symbol(f"data.{k}"): f"data[{k}]" for k in range(len(data))}
    names[symbol("data")] = "data"
    lines, results = body(list(changed.values()), names)
    lines += [
        f"    local[{rows.index(name)}, i] = {code}"
        for name, code in zip(changed, results, strict=True)
    ]
    head = (
        f"def surround(around, data, {', '.join((*_AT[2:3], *_AT[:2], *_AT[3:]))}, edge, local, i):"
    )
    return "\n".join([head, *lines, "    return 0"]), np.array(data or [0.0])
