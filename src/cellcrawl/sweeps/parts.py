"""Rows as Parquet files, each written under a temporary name and renamed."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, Final

from cellcrawl.errors import StorageError, what_would_help
from cellcrawl.parameters import DESCRIPTIONS
from cellcrawl.sweeps.measures import MEASURES

if TYPE_CHECKING:
    import pyarrow as pa

_TEXT: Final = ("elasticity", "start", "schedule", "solver", "options", "mode", "status", "message")
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
        temporary.replace(path)
    except BaseException as error:
        with contextlib.suppress(OSError):
            temporary.unlink(missing_ok=True)
        if isinstance(error, OSError) and not isinstance(error, StorageError):
            raise cannot_write(path, error) from None
        raise


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
        with parquet.ParquetFile(path) as file:
            return file.read(columns=None if columns is None else list(columns))
    except FileNotFoundError:
        raise
    except (OSError, pa.ArrowException) as error:
        reason = " ".join(str(error).split())[:150]
        raise StorageError(
            f"{path} is damaged ({reason}): delete it, and the sweep makes its runs again"
        ) from None


def cannot_write(path: Path, error: OSError) -> StorageError:
    """Return the error for a file of a sweep that could not be written."""
    reason = error.strerror or str(error).splitlines()[0]
    return StorageError(
        f"cannot write {path}: {reason}; the rows saved before stay, and the same command goes on "
        f"{what_would_help(error, reason)}"
    )
