"""Frozen dataclasses whose misspelt fields are answered with the nearest name."""

from __future__ import annotations

import dataclasses
import tomllib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Self

import tomli_w

from cellcrawl.errors import InputError
from cellcrawl.validation import known_names, table


class NamedFields:
    """Base of the parameter classes: unknown names are refused, tables and TOML go in and out."""

    def __new__(cls, *args: Any, **fields: Any) -> Self:
        """Refuse positional values and unknown names before the dataclass sees them."""
        if args:
            raise InputError(f"{cls.__name__} takes its values by name, as in r_on=26")
        cls.check_names(fields)
        return super().__new__(cls)

    @classmethod
    def field_names(cls) -> list[str]:
        """Return the names of the fields, in order."""
        if not dataclasses.is_dataclass(cls):
            return []
        return [field.name for field in dataclasses.fields(cls)]

    @classmethod
    def check_names(cls, names: Iterable[str]) -> None:
        """Raise `InputError` for a name that is no field of this class."""
        known_names(cls.__name__, names, cls.field_names())

    def to_dict(self) -> dict[str, Any]:
        """Return the fields as a plain dict."""
        return {name: getattr(self, name) for name in self.field_names()}

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Self:
        """Build from a mapping of field names to values."""
        return cls(**{str(name): value for name, value in table(cls.__name__, values).items()})

    def to_toml(self, path: str | Path | None = None) -> str:
        """Return the fields as TOML; with ``path``, write them there too."""
        text = tomli_w.dumps(self.to_dict())
        if path is not None:
            Path(path).write_text(text, encoding="utf-8")
        return text

    @classmethod
    def from_toml(cls, source: str | Path) -> Self:
        """Read from a TOML file (a `Path`, or a string ending in ``.toml``) or from TOML text."""
        return cls.from_dict(read_toml(source))


def read_toml(source: str | Path) -> dict[str, Any]:
    """Parse a TOML file (a `Path`, or a string ending in ``.toml``) or TOML text."""
    is_file = isinstance(source, Path) or source.strip().endswith(".toml")
    name = f"{source}: " if is_file else "TOML: "
    try:
        return tomllib.loads(Path(source).read_text("utf-8") if is_file else str(source))
    except OSError as error:
        raise InputError(f"cannot read {source}: {error.strerror or error}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{name}not valid TOML: {error}") from None
