"""A chunk's journal: what a worker began and what it finished, line by line while it goes.

A worker killed at any instant leaves complete lines behind, so that no finished run is lost and
the run that was under way is known. Each line begins with the checksum of the rest; one that is cut
short or damaged counts as not written, and its run is made again.
"""

from __future__ import annotations

import contextlib
import json
import zlib
from collections import Counter
from pathlib import Path
from types import TracebackType
from typing import Any, NamedTuple, Self

Row = dict[str, Any]


class Entries(NamedTuple):
    """What a journal holds."""

    rows: list[Row]
    unfinished: Counter[str]
    """Keys of runs begun and never finished, with how often they were begun."""


class Journal:
    """The journal of a chunk at work; a context that closes the file."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def __enter__(self) -> Self:
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self._file = self.path.open("ab", buffering=0)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._file.close()

    def begin(self, key: str) -> None:
        """Note that a run is begun."""
        self._write({"begin": key})

    def finish(self, row: Row) -> None:
        """Note a finished run."""
        self._write({"row": row})

    def _write(self, entry: dict[str, Any]) -> None:
        # The newline first: an entry cut short by a full disk or a kill spoils itself alone.
        text = json.dumps(entry).encode()
        data = b"\n%08x " % zlib.crc32(text) + text
        if self._file.write(data) != len(data):
            raise OSError(28, "No space left on device")


def read_journal(path: Path) -> Entries:
    """Return the complete lines of a journal; an absent one is empty."""
    rows: dict[str, Row] = {}
    begun: Counter[str] = Counter()
    try:
        lines = path.read_bytes().split(b"\n")
    except FileNotFoundError:
        lines = []
    for line in lines:
        with contextlib.suppress(ValueError, KeyError, TypeError):
            entry = json.loads(_checked(line))
            if "begin" in entry:
                begun[entry["begin"]] += 1
            else:
                rows[entry["row"]["key"]] = entry["row"]
    unfinished = Counter({key: times for key, times in begun.items() if key not in rows})
    return Entries(list(rows.values()), unfinished)


def _checked(line: bytes) -> bytes:
    """Return a line without its checksum, or raise `ValueError`; 0.1.0 wrote lines without."""
    if line.startswith(b"{"):
        return line
    found, _, text = line.partition(b" ")
    if len(found) != 8 or int(found, 16) != zlib.crc32(text):
        raise ValueError("not what its checksum says")
    return text
