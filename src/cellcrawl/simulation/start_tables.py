"""Starts from plain tables, as config files and saved descriptions have them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from cellcrawl.errors import InputError
from cellcrawl.simulation.from_run import FromRun
from cellcrawl.starts import Eigenmode, FromOutline, PerturbedCircle, RandomPerturbation, Start
from cellcrawl.validation import known_names, table

_STARTS: dict[str, Callable[..., Start]] = {
    kind.__name__: kind
    for kind in (RandomPerturbation, PerturbedCircle, Eigenmode, FromOutline, FromRun)
}


def start_from_table(values: Mapping[str, Any]) -> Start:
    """Return the start that a table such as ``{kind = "Eigenmode", k = 3}`` describes."""
    values = dict(table("[start]", values))
    kind = values.pop("kind", "RandomPerturbation")
    known_names("[start] kind", [kind], _STARTS)
    try:
        return _STARTS[kind](**values)
    except TypeError as error:
        raise InputError(f"[start] {kind}: {error}") from None
