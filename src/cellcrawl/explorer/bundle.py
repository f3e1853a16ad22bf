"""The page as one file: modules joined, style, data and the compiled solver within it.

A page opened from disk may load nothing beside it, so that all has to be in it.
"""

from __future__ import annotations

import base64
import gzip
import json
import re
from importlib import resources
from typing import Any, Final

_IMPORT: Final = re.compile(r'^import \{([^}]*)\} from "\./(\w+)\.js";\n', re.M)
_EXPORT: Final = re.compile(r"^export ((?:async )?(?:function|class|const|let) (\w+))", re.M)
_LIST: Final = re.compile(r"^export \{([^}]*)\};\n", re.M)


def page(module: bytes, content: dict[str, Any]) -> str:
    """Return the page with a compiled solver and what `content` gives."""
    packed = base64.b64encode(gzip.compress(module, 9, mtime=0)).decode()
    data = json.dumps(content, separators=(",", ":")).replace("</", "<\\/")
    parts = {"STYLE": _source("style.css"), "DATA": data, "MODULE": packed, "SCRIPT": script()}
    text = _source("index.html")
    for name, part in parts.items():
        text = text.replace(f"/*{name}*/", part)
    return text


def script(first: str = "main") -> str:
    """Return a module of the page with all that it imports as one; ``$name`` is each by name."""
    order: list[str] = []
    _visit(first, order, ())
    return "\n".join(_wrapped(name) for name in order)


def _source(name: str) -> str:
    return resources.files("cellcrawl.explorer").joinpath("page", name).read_text("utf-8")


def _visit(name: str, order: list[str], on_the_way: tuple[str, ...]) -> None:
    if name in on_the_way:
        raise ValueError(f"modules import each other in a circle: {' -> '.join(on_the_way)}")
    for _, other in _IMPORT.findall(_source(f"{name}.js")):
        if other not in order:
            _visit(other, order, (*on_the_way, name))
    order.append(name)


def _wrapped(name: str) -> str:
    """Return a module as a function that is called once and returns what it exports."""
    text = _source(f"{name}.js")
    text = _IMPORT.sub(r"const {\1} = $\2;\n", text)
    names = [found[1] for found in _EXPORT.findall(text)]
    for found in _LIST.findall(text):
        names += [part.strip() for part in found.split(",") if part.strip()]
    text = _EXPORT.sub(r"\1", _LIST.sub("", text))
    return f"const ${name} = (() => {{\n{text}\nreturn {{ {', '.join(names)} }};\n}})();"
