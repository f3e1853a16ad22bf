"""What a reader recognised in a file, and what it left out and why."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

_LISTED = 5  # reasons spelt out in a summary; the rest is counted


@dataclass(frozen=True)
class LeftOut:
    """A track, an outline or rows of a file that were not taken.

    Attributes
    ----------
    what : str
        The track's id, or the place in the file ("rows 12, 40").
    reason : str
        Why, in a few words.
    records : int
        How many records it had.
    """

    what: str
    reason: str
    records: int = 1

    def __str__(self) -> str:
        return f"{self.what}: {self.reason}"


@dataclass(frozen=True)
class Source:
    """Where tracks or outlines came from and how their file was understood.

    Attributes
    ----------
    path : str
        The file; "" for what was made in memory.
    format : str
        The form recognised by content, such as "TrackMate XML".
    columns : mapping of str to str
        Which column was taken for which role (id, t, x, y, z, ...); empty for forms without.
    length_units, time_units : str
        Units as the file or the caller gives them; "" where nobody said.
    y_down : bool
        Whether y points down, as in an image. Coordinates stay those of the file; words such as
        left and right, and pictures, are those of the screen.
    notes : tuple of str
        What else was noticed, a sentence each.
    """

    path: str = ""
    format: str = ""
    columns: Mapping[str, str] = field(default_factory=dict)
    length_units: str = ""
    time_units: str = ""
    y_down: bool = False
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "columns", MappingProxyType(dict(self.columns)))

    def __reduce__(self) -> tuple[object, ...]:  # a mapping proxy cannot be pickled
        return Source, (
            self.path,
            self.format,
            dict(self.columns),
            self.length_units,
            self.time_units,
            self.y_down,
            self.notes,
        )

    def __str__(self) -> str:
        return "\n".join(self.lines())

    def lines(self) -> list[str]:
        """Return what was recognised, a line each: form and columns, units, what was noticed."""
        taken = ", ".join(f"{role} = {column}" for role, column in self.columns.items())
        first = f"read as {self.format}" + (f": {taken}" if taken else "")
        return [first, self._units(), *self.notes]

    def _units(self) -> str:
        length = self.length_units or "unknown (give the pixel size)"
        time = self.time_units or "unknown (give the frame interval)"
        way = "down, as in an image" if self.y_down else "up"
        return f"units: length {length}, time {time}; y points {way}"


UNTOLD = Source()
"""The source of what was made in memory."""


def listed(left_out: tuple[LeftOut, ...]) -> list[str]:
    """Return what was left out, the same reasons together, a line each."""
    by_reason: dict[str, list[LeftOut]] = {}
    for one in left_out:
        by_reason.setdefault(one.reason, []).append(one)
    lines = []
    for reason, those in by_reason.items():
        names = ", ".join(one.what for one in those[:_LISTED])
        more = f" and {len(those) - _LISTED} more" if len(those) > _LISTED else ""
        lines.append(f"left out {names}{more}: {reason}")
    if len(lines) > 2 * _LISTED:
        rest = len(lines) - 2 * _LISTED
        lines = [*lines[: 2 * _LISTED], f"and {rest} more kinds: see .left_out"]
    return lines
