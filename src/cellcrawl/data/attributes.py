"""The attributes of a run: as text in files, and what has to be in them."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, Final

import numpy as np
import xarray as xr

from cellcrawl.data.schema import SCHEMA_VERSION, STATUSES
from cellcrawl.errors import InputError, StorageError
from cellcrawl.validation import shown

TABLES: Final = ("parameters", "schedule", "start", "solver_options", "diagnostics")
"""Attributes that are tables, stored as JSON text."""
_SHORTEST: Final = 1e-300  # between two records: any time above zero
_ANY_SEED: Final = -1  # that of a start that is not random


def encode_attributes(attributes: Mapping[str, Any]) -> dict[str, Any]:
    """Return attributes as netCDF can hold them: tables and lists become JSON text."""
    return {
        name: json.dumps(value) if isinstance(value, (dict, list)) else value
        for name, value in attributes.items()
    }


def decode_attribute(dataset: xr.Dataset, name: str) -> Any:
    """Return an attribute that is stored as JSON text; raises `InputError` if there is none."""
    try:
        return json.loads(dataset.attrs[name])
    except KeyError:
        raise InputError(
            f"this dataset has no attribute {name!r}: is it a cellcrawl run?"
        ) from None
    except (TypeError, ValueError):
        raise InputError(f"the attribute {name!r} of this dataset is not valid JSON") from None


def checked_attributes(attributes: Mapping[str, Any], where: Any) -> None:
    """Raise unless these are the attributes of a run that this version reads.

    Parameters
    ----------
    attributes : mapping
        Those of a file's Dataset.
    where : str or Path
        The file, for the message.

    Raises
    ------
    InputError
        If it is no run of ours.
    StorageError
        If it is one of a newer version, or an attribute is missing or cannot be.
    """
    if "schema_version" not in attributes:
        raise InputError(f"{where} is not a cellcrawl run: it has no schema_version")
    version = _whole(attributes["schema_version"])
    if version is not None and version > SCHEMA_VERSION:
        raise StorageError(
            f"{where} was written by a newer cellcrawl (schema {version}, this one reads up to "
            f"{SCHEMA_VERSION}): update cellcrawl"
        )
    for name, allowed, is_right in _ALLOWED:
        if name not in attributes:
            raise StorageError(
                f"{where} has no attribute {name!r}: it was damaged or edited; restore it from a "
                "copy, or make the run again"
            )
        if not is_right(attributes[name]):
            raise StorageError(
                f"{where} says {name} = {shown(attributes[name])}, which must be {allowed}: it was "
                "damaged or edited; restore it from a copy, or make the run again"
            )


def _is_text(value: Any) -> bool:
    return isinstance(value, str)


def _is_status(value: Any) -> bool:
    return _is_text(value) and value in STATUSES


def _is_table(value: Any) -> bool:
    try:
        return isinstance(json.loads(value), dict)
    except (TypeError, ValueError):
        return False


def _is_number(value: Any) -> bool:
    real = isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool)
    return real and math.isfinite(value)


def _whole(value: Any) -> int | None:
    return int(value) if _is_number(value) and int(value) == value else None


def _is_from(low: float, value: Any) -> bool:
    return _is_number(value) and value >= low


def _is_whole_from(low: int, value: Any) -> bool:
    return _whole(value) is not None and value >= low


_ALLOWED: Final[tuple[tuple[str, str, Callable[[Any], bool]], ...]] = (
    ("schema_version", "a whole number from 1 on", partial(_is_whole_from, 1)),
    ("status", f"one of {', '.join(STATUSES)}", _is_status),
    ("status_message", "text", _is_text),
    ("end_time", "a time from 0 on", partial(_is_from, 0.0)),
    ("save_every", "a time above 0", partial(_is_from, _SHORTEST)),
    ("records_on_grid", "a whole number from 0 on", partial(_is_whole_from, 0)),
    ("seed", "a whole number", partial(_is_whole_from, _ANY_SEED)),
    ("solver", "the name of a solver", _is_text),
    ("cellcrawl_version", "text", _is_text),
    *((name, "a table as JSON text", _is_table) for name in TABLES),
)
