"""What surroundings are: fields in space and time that change the parameters of the edge there."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import Any, ClassVar, Final

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.laws.expressions import Expression, body, call, number, symbol, symbols_of
from cellcrawl.laws.functions import Compiled, register
from cellcrawl.laws.law import Described, Law
from cellcrawl.surroundings.lookup import (
    angle_from_front,
    disc_depth,
    disc_presence,
    image_value,
    polygon_depth,
)
from cellcrawl.validation import shown

_LOOKUPS: Final[dict[str, Any]] = {
    "disc_depth": disc_depth,
    "disc_presence": disc_presence,
    "image_value": image_value,
    "polygon_depth": polygon_depth,
    "angle_from_front": angle_from_front,
}
_MOTION: Final = ("arm_x", "arm_y", "velocity_x", "velocity_y")
_AT: Final = ("time", "x", "y", "normal_x", "normal_y", "curvature", *_MOTION)


class Place:
    """Where a node is, for `Surrounding.change`.

    ``x``, ``y`` and ``time``; the outward normal ``normal_x``, ``normal_y``; the ``curvature`` of
    the edge; ``arm_x``, ``arm_y`` from the cell's centroid; and the velocity of that,
    ``velocity_x``, ``velocity_y``, which the forces on the whole edge make together.
    """

    time: Any
    x: Any
    y: Any
    normal_x: Any
    normal_y: Any
    curvature: Any
    arm_x: Any
    arm_y: Any
    velocity_x: Any
    velocity_y: Any

    def __init__(self, **values: Any) -> None:
        self.__dict__.update(dict.fromkeys(_AT[5:], 0.0), **values)

    @property
    def angle(self) -> Any:
        """Angle at the centroid from the direction of motion, positive to the left, to +-pi."""
        arguments = (self.velocity_x, self.velocity_y, self.arm_x, self.arm_y)
        if any(isinstance(value, Expression) for value in arguments):
            return call("angle_from_front", *arguments)
        ahead = self.velocity_x * self.arm_x + self.velocity_y * self.arm_y
        return np.arctan2(self.velocity_x * self.arm_y - self.velocity_y * self.arm_x, ahead)


class Surrounding(Described):
    """A field that changes local parameters where the edge is; the base of all others.

    A subclass says in `change` what becomes of the parameters. Its own numbers are `Parameter`
    fields, which may be changed without anything being compiled anew.
    """

    source: ClassVar[str] = ""

    def change(self, at: Place, p: Any) -> Mapping[str, Any]:
        """Return new values of local parameters by name, from those before (``p.r_on``, …).

        ``at`` is a `Place`, in cell radii and 1/k_off0. A ``p.pressure`` pushes the edge inwards.
        """
        raise NotImplementedError

    def conflict(self, points: np.ndarray) -> str | None:
        """Return why a cell with this outline, shape (nodes, 2), cannot start here, or None."""
        return None

    def table(self) -> np.ndarray:
        """Return numbers that `change` looks up by `look_up`: an image, the corners of a wall."""
        return np.empty(0)

    def look_up(self, function: str, at: Place, *more: Any) -> Any:
        """Return what a function of `cellcrawl.surroundings.lookup` makes of the table there."""
        looked_up = np.vectorize(_LOOKUPS[function], excluded=(0, 1), otypes=[float])
        return looked_up(self.table(), 0.0, at.x, at.y, *more)


class CompiledSurroundings(Compiled):
    """Surroundings as an argument of kernels, with their numbers.

    ``bends`` and ``moves`` say whether they ask for the curvature and for the motion of the cell.
    """

    def __init__(self, digest: str, source: str, data: np.ndarray, uses: set[str]) -> None:
        self.digest, self.source, self.data = digest, source, data
        self.bends = "curvature" in uses
        self.moves = not uses.isdisjoint(_MOTION)
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
            now |= self.after(part, now, at)
        return now

    def after(self, part: Surrounding, p: Mapping[str, Any], at: Place) -> Mapping[str, Any]:
        """Return what one part changes of the local parameters at places."""
        return part.change(at, SimpleNamespace(**p))

    def compiled(self, law: Law) -> CompiledSurroundings:
        """Return them for kernels under a law."""
        source, data, uses = _source(self.parts, law.rows)
        digest = hashlib.sha256(source.encode()).hexdigest()[:16]
        return CompiledSurroundings(digest, source, data, uses)


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

    def look_up(function: str, at: Place, *more: Any) -> Expression:
        return call(function, symbol("data"), number(table), at.x, at.y, *more)

    made.look_up = look_up  # type: ignore[method-assign]
    return made


def _source(parts: Sequence[Surrounding], rows: Sequence[str]) -> tuple[str, np.ndarray, set[str]]:
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
            if name == "D" and not symbols_of([changed[name]]).isdisjoint(_MOTION):
                raise InputError(
                    f"{type(part).__name__} makes D depend on the motion of the cell: only what "
                    "the forces and the kinetics ask for may"
                )
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
    head = f"def surround(around, data, {', '.join(_AT)}, edge, local, i):"
    source = "\n".join([head, *lines, "    return 0"])
    return source, np.array(data or [0.0]), symbols_of(changed.values())
