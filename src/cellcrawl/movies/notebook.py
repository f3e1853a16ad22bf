"""A movie's path, which a notebook shows as the movie."""

from __future__ import annotations

import base64
import sys
from html import escape
from pathlib import Path

if sys.platform == "win32":
    from pathlib import WindowsPath as _Path
else:
    from pathlib import PosixPath as _Path

_LARGEST = 50_000_000  # bytes: a larger movie would burden the notebook that holds it


class MovieFile(_Path):
    """Where a movie is; a Path like any other."""

    def _repr_html_(self) -> str | None:
        kind = {".mp4": "video/mp4", ".gif": "image/gif"}.get(self.suffix.lower())
        try:
            if kind is None or self.stat().st_size > _LARGEST:
                return None
            content = base64.b64encode(self.read_bytes()).decode("ascii")
        except OSError:
            return None
        source = f'src="data:{kind};base64,{content}"'
        if kind == "image/gif":
            return f'<img {source} alt="{escape(self.name)}">'
        return f"<video {source} controls loop>{escape(self.name)}</video>"

    def __reduce__(self) -> tuple[type[Path], tuple[str, ...]]:
        return Path, self.parts
