"""Frozen dataclasses whose misspelt fields are answered with the nearest name."""

from __future__ import annotations

import dataclasses
import tomllib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Self

import tomli_w

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError, StorageError
from cellcrawl.validation import known_names, shown, table


class NamedFields:
    """Base of the parameter classes: unknown names are refused, tables and TOML go in and out."""

    def __new__(cls, /, *args: Any, **fields: Any) -> Self:
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

    def replace(self, /, **changes: Any) -> Self:
        """Return a copy with some values changed; the copy is validated."""
        return type(self)(**{**self.to_dict(), **changes})

    def to_dict(self) -> dict[str, Any]:
        """Return the fields as a plain dict."""
        return {name: getattr(self, name) for name in self.field_names()}

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Self:
        """Build from a mapping of field names to values."""
        return cls(**{str(name): value for name, value in table(cls.__name__, values).items()})

    @checked
    def to_toml(self, path: str | Path | None = None) -> str:
        """Return the fields as TOML; with ``path``, write them there too."""
        text = tomli_w.dumps(self.to_dict())
        if path is not None:
            try:
                Path(path).write_text(text, encoding="utf-8")
            except OSError as error:
                reason = error.strerror or error
                raise StorageError(f"cannot write {shown(str(path), 300)}: {reason}") from None
        return text

    @classmethod
    def from_toml(cls, source: str | Path) -> Self:
        """Read from a TOML file (a `Path`, or a name ending in ``.toml``) or from TOML text."""
        return cls.from_dict(read_toml(source))


def read_toml(source: str | Path) -> dict[str, Any]:
    """Parse a TOML file (a `Path`, or a name ending in ``.toml``) or TOML text."""
    if not isinstance(source, (str, Path)):
        raise InputError(f"TOML comes from a path or text, not {shown(source)}")
    is_file = isinstance(source, Path) or (source.endswith(".toml") and "\n" not in source)
    name = shown(str(source), 300) if is_file else "this text (a file's name ends in .toml)"
    try:
        text = Path(source).read_text("utf-8-sig") if is_file else str(source)
        return tomllib.loads(text)
    except OSError as error:
        raise InputError(f"cannot read {name}: {error.strerror or error}") from None
    except (ValueError, RecursionError) as error:
        reason = " ".join(str(error).split())
        raise InputError(f"{name} is not valid TOML: {reason[:200]}") from None
