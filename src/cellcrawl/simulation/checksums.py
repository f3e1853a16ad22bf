"""Checksums over all that a file holds, so that a flipped bit never passes for data.

Records are covered chunk by chunk, by the format's own checksum, when they are read. All else, the
attributes, names and shapes of a run and the state to go on from, is covered by one digest.
"""

from __future__ import annotations

import hashlib
import json
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np

from cellcrawl.data import SCHEMA_VERSION, checked_attributes
from cellcrawl.errors import StorageError

_MAGIC: Final = b"cellcrawl block\x01"
_SUM_BYTES: Final = 4
CHECKPOINT: Final = "checkpoint"
"""The group of a file that holds the state to go on from."""
SEAL: Final = "seal"
"""The attribute of that group that holds the digest."""

Layout = dict[str, tuple[tuple[str, ...], tuple[int, ...], dict[str, str]]]
"""For each variable of a run: its dimensions, its shape, its attributes."""


def digest(attributes: Mapping[str, Any], layout: Layout, arrays: Mapping[str, np.ndarray]) -> str:
    """Return a hash of attributes, of what variables there are and of small arrays' content."""
    content = [
        sorted((name, _plain(value)) for name, value in attributes.items()),
        sorted(
            (name, list(dims), list(shape), sorted(described.items()))
            for name, (dims, shape, described) in layout.items()
        ),
        sorted((name, *_array_sum(array)) for name, array in arrays.items()),
    ]
    return hashlib.blake2b(json.dumps(content).encode(), digest_size=16).hexdigest()


def seal(
    attributes: Mapping[str, Any], layout: Layout, checkpoint: Mapping[str, np.ndarray]
) -> str:
    """Return the digest of what a file holds besides its records, with what it covers."""
    names = sorted(attributes)
    return json.dumps({"attributes": names, "digest": digest(attributes, layout, checkpoint)})


def check_seal(
    path: Path,
    told: Any,
    attributes: Mapping[str, Any],
    layout: Layout,
    checkpoint: Mapping[str, np.ndarray],
) -> None:
    """Refuse a file that is not as it was written; what the user has added does not count."""
    if told is None:
        checked_attributes(attributes, path)
        if attributes["schema_version"] < SCHEMA_VERSION:
            return  # written by 0.1.0
    try:
        found = json.loads(told)
        own = {name: attributes[name] for name in found["attributes"]}
        held = found["digest"] == digest(own, layout, checkpoint)
    except (KeyError, TypeError, ValueError):
        held = False
    if not held:
        checked_attributes(attributes, path)  # says more, if it is one of these
        raise damaged(path, "its attributes, variables or state were changed since")


def sealed(data: bytes) -> bytes:
    """Return ``data`` as a file that says when it is damaged."""
    return _MAGIC + zlib.crc32(data).to_bytes(_SUM_BYTES, "big") + data


def unsealed(content: bytes, path: Path) -> bytes:
    """Return the data in the content of a `sealed` file, or raise `StorageError`."""
    head = len(_MAGIC) + _SUM_BYTES
    data = content[head:]
    if content[:head] != _MAGIC + zlib.crc32(data).to_bytes(_SUM_BYTES, "big"):
        raise damaged(path)
    return data


def damaged(path: Path, what: str = "its content is not what its checksum says") -> StorageError:
    """Return the error for a file that is not as it was written."""
    return StorageError(f"{path} is damaged: {what}; restore it from a copy, or make the run again")


def _array_sum(array: np.ndarray) -> tuple[str, list[int], str]:
    """Return type, shape and checksum of an array, the same on machines of either byte order."""
    little = np.ascontiguousarray(array, dtype=array.dtype.newbyteorder("<"))
    return little.dtype.str, list(array.shape), hashlib.blake2b(little.tobytes()).hexdigest()


def _plain(value: Any) -> list[Any]:
    """Return an attribute as JSON that is the same for the same value, read or to be written."""
    if isinstance(value, np.generic | np.ndarray):
        value = value.item() if np.ndim(value) == 0 else np.asarray(value).tolist()
    if isinstance(value, bytes):
        value = value.decode(errors="replace")
    if isinstance(value, float):
        value = value.hex()
        return ["float", value]
    return [type(value).__name__, value if isinstance(value, (str, int, list)) else repr(value)]
