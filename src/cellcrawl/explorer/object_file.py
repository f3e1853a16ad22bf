"""LLVM's relocatable WebAssembly object made a module that can be instantiated.

Its relocation sites already hold the values for data at address 0 and its own function indices: all
that lacks is what it exports, and that the linker's sections go.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

_HEADER = b"\0asm\1\0\0\0"
_CUSTOM, _IMPORT, _EXPORT, _SYMBOLS = 0, 2, 7, 8
_BEFORE_EXPORTS = (1, 2, 3, 4, 5, 6)
_FUNCTION, _DATA, _SECTION = 0, 1, 3
_UNDEFINED, _EXPLICIT_NAME = 0x10, 0x40


class _Reader:
    def __init__(self, content: bytes) -> None:
        self.content, self.at = content, 0

    def number(self) -> int:
        value = shift = 0
        while True:
            byte = self.content[self.at]
            self.at += 1
            value |= (byte & 127) << shift
            if byte < 128:
                return value
            shift += 7

    def bytes(self, count: int) -> bytes:
        self.at += count
        return self.content[self.at - count : self.at]

    def text(self) -> str:
        return self.bytes(self.number()).decode()


def _number(value: int) -> bytes:
    found = bytearray()
    while True:
        found.append((value & 127) | (128 if value > 127 else 0))
        value >>= 7
        if not value:
            return bytes(found)


def _text(text: str) -> bytes:
    return _number(len(text.encode())) + text.encode()


def sections(content: bytes) -> Iterator[tuple[int, bytes]]:
    """Yield kind and content of every section."""
    if content[:8] != _HEADER:
        raise ValueError("this is no WebAssembly module of version 1")
    reader = _Reader(content)
    reader.at = 8
    while reader.at < len(content):
        kind = reader.number()
        yield kind, reader.bytes(reader.number())


def imports(content: bytes) -> list[str]:
    """Return the names of what a module imports."""
    found = []
    for kind, body in sections(content):
        if kind != _IMPORT:
            continue
        reader = _Reader(body)
        for _ in range(reader.number()):
            home, name = reader.text(), reader.text()
            found.append(f"{home}.{name}")
            what = reader.number()
            if what == 0:
                reader.number()
            elif what == 3:
                reader.bytes(2)
            else:
                if what == 1:
                    reader.bytes(1)
                limits = reader.number()
                reader.number()
                if limits & 1:
                    reader.number()
    return found


def _functions(linking: bytes) -> dict[str, int]:
    """Return the indices of the functions that the linker's section names."""
    found: dict[str, int] = {}
    whole = _Reader(linking)
    whole.number()
    while whole.at < len(linking):
        part, length = whole.number(), whole.number()
        reader = _Reader(whole.bytes(length))
        if part != _SYMBOLS:
            continue
        for _ in range(reader.number()):
            kind, flags = reader.number(), reader.number()
            defined = not flags & _UNDEFINED
            if kind == _DATA:
                reader.text()
                if defined:
                    [reader.number() for _ in range(3)]
            elif kind == _SECTION:
                reader.number()
            else:
                index = reader.number()
                name = reader.text() if defined or flags & _EXPLICIT_NAME else ""
                if kind == _FUNCTION and defined:
                    found[name] = index
    return found


def with_exports(content: bytes, names: Sequence[str]) -> bytes:
    """Return an object file as a module that exports functions by their names."""
    kept, linking = [], b""
    for kind, body in sections(content):
        if kind != _CUSTOM:
            kept.append((kind, body))
            continue
        reader = _Reader(body)
        if reader.text() == "linking":
            linking = body[reader.at :]
    found = _functions(linking)
    body = _number(len(names))
    for name in names:
        body += _text(name) + b"\0" + _number(found[name])
    first = next(k for k, (kind, _) in enumerate(kept) if kind not in _BEFORE_EXPORTS)
    kept.insert(first, (_EXPORT, body))
    return _HEADER + b"".join(
        _number(kind) + _number(len(content)) + content for kind, content in kept
    )
