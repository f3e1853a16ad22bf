"""Rows as Parquet files, each written under a temporary name and renamed.

The name of a file ends in the checksum of its content: ``sweep-0a1b2c3d4e5f.crc-89abcdef.parquet``.
Files without were written by 0.1.0.
"""

from __future__ import annotations

import contextlib
import os
import re
import zlib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, Final

from cellcrawl.errors import StorageError, what_would_help
from cellcrawl.parameters import DESCRIPTIONS
from cellcrawl.sweeps.measures import MEASURES

if TYPE_CHECKING:
    import pyarrow as pa

_TEXT: Final = (
    "elasticity",
    "start",
    "schedule",
    "solver",
    "options",
    "laws",
    "surroundings",
    "mode",
    "status",
    "message",
)
_WHOLE: Final = ("seed", "nodes", "steps")
COLUMNS: Final = (
    "key",
    *DESCRIPTIONS,
    "elasticity",
    "seed",
    "start",
    "schedule",
    "solver",
    "nodes",
    "options",
    "laws",
    "surroundings",
    "t_end",
    "save_every",
    "mode",
    *MEASURES,
    "end_time",
    "status",
    "message",
    "steps",
    "wall_time",
    "part",
    "code",
)
SUFFIX: Final = ".parquet"
_SUM: Final = re.compile(r"\.crc-([0-9a-f]{8})\.parquet$")
FAILED: Final = "failed"
KILLED: Final = "killed"
NOT_RUN: Final = (FAILED, KILLED)
"""Statuses of rows without a result: the run raised an error, or killed its worker."""


def schema() -> pa.Schema:
    """Return names and types of a row's columns."""
    import pyarrow as pa

    types = dict.fromkeys(COLUMNS, pa.float64())
    types.update(dict.fromkeys(("key", "part", "code", *_TEXT), pa.string()))
    types.update(dict.fromkeys(_WHOLE, pa.int64()))
    return pa.schema(list(types.items()))


def write_part(path: Path, rows: Sequence[dict[str, Any]]) -> None:
    """Write rows as one file, all or nothing.

    Raises
    ------
    StorageError
        If the disk is full or cannot be written; nothing is left behind then.
    """
    import pyarrow as pa
    import pyarrow.parquet as parquet

    columns = {name: [row.get(name) for row in rows] for name in COLUMNS}
    with _replacing(path) as file:
        parquet.write_table(pa.table(columns, schema()), file)


def merge_parts(path: Path, parts: Sequence[Path]) -> None:
    """Write the rows of several files as one, a file at a time in memory."""
    import pyarrow.parquet as parquet

    with _replacing(path) as file, parquet.ParquetWriter(file, schema()) as writer:
        for part in parts:
            writer.write_table(read_part(part).cast(schema()))


@contextlib.contextmanager
def _replacing(path: Path) -> Iterator[BinaryIO]:
    """Give a file that gets its name when all is written; nothing is left of one that fails."""
    temporary = path.with_name(f".{path.name}.tmp")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with temporary.open("wb") as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        found = zlib.crc32(temporary.read_bytes())
        temporary.replace(path.with_name(f"{path.stem}.crc-{found:08x}{SUFFIX}"))
    except BaseException as error:
        with contextlib.suppress(OSError):
            temporary.unlink(missing_ok=True)
        if isinstance(error, OSError) and not isinstance(error, StorageError):
            raise cannot_write(path, error) from None
        raise


def find_part(path: Path) -> Path | None:
    """Return the file written as ``path``, its checksum in its name; None if there is none.

    A chunk that was made twice, as after a kill, may have left two that hold the same runs.
    """
    found = sorted(path.parent.glob(f"{path.stem}.crc-*{SUFFIX}"))
    return found[0] if found else (path if path.exists() else None)


def read_part(path: Path, columns: Sequence[str] | None = None) -> pa.Table:
    """Read a file of rows, or raise `StorageError` if it is damaged.

    Raises
    ------
    FileNotFoundError
        If it has gone: its rows are in a merged file now.
    """
    import pyarrow as pa
    import pyarrow.parquet as parquet

    try:
        content = path.read_bytes()
        wanted = _SUM.search(path.name)
        if wanted is not None and zlib.crc32(content) != int(wanted.group(1), 16):
            raise _damaged(path, "its content is not what its checksum says")
        with parquet.ParquetFile(pa.BufferReader(content)) as file:
            table = file.read(columns=None if columns is None else list(columns))
    except (FileNotFoundError, StorageError):
        raise
    except (OSError, KeyError, pa.ArrowException) as error:
        raise _damaged(path, " ".join(str(error).split())[:150]) from None
    for field in schema():  # columns that an older version did not write
        if field.name not in table.column_names and (columns is None or field.name in columns):
            table = table.append_column(field, pa.nulls(len(table), field.type))
    return table if columns is None else table.select(list(columns))


def _damaged(path: Path, reason: str) -> StorageError:
    return StorageError(
        f"{path} is damaged ({reason}): delete it, and the sweep makes its runs again"
    )


def cannot_write(path: Path, error: OSError) -> StorageError:
    """Return the error for a file of a sweep that could not be written."""
    reason = error.strerror or str(error).splitlines()[0]
    return StorageError(
        f"cannot write {path}: {reason}; the rows saved before stay, and the same command goes on "
        f"{what_would_help(error, reason)}"
    )
