"""What a file is, told by its content and not by its name."""

from __future__ import annotations

import json
import re
import zipfile
from pathlib import Path

from cellcrawl.errors import InputError
from cellcrawl.microscopy.tables import decoded
from cellcrawl.microscopy.tiff_labels import CTC_TABLES

_HEAD = 1 << 15
_TIFF = (b"II*\x00", b"MM\x00*", b"II+\x00", b"MM\x00+")
_LONG_LINE = 150
_COORDINATES = re.compile(r"(-?\d+(\.\d+)?,){20,}")


def form_of_file(path: Path) -> str:
    """Return the form of a file or folder: a word that the readers know.

    Raises
    ------
    InputError
        If there is nothing there, or nothing that is known.
    """
    if not path.exists():
        raise InputError(f"cannot read {path}: there is no such file")
    if path.is_dir():
        return _folder(path)
    try:
        with path.open("rb") as stream:
            head = stream.read(_HEAD)
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from None
    if not head.strip():
        raise InputError(f"{path} is empty")
    return _binary(path, head) or _text(path, head)


def is_geff(path: Path) -> bool:
    """Whether a folder is a graph of tracks in the Graph Exchange File Format."""
    for name in ("zarr.json", ".zattrs"):
        try:
            content = json.loads((path / name).read_text("utf-8"))
        except (OSError, ValueError):
            continue
        attributes = content.get("attributes", content) if isinstance(content, dict) else {}
        if isinstance(attributes, dict) and "geff" in attributes:
            return True
    return False


def _folder(path: Path) -> str:
    if is_geff(path):
        return "geff"
    inner = [child for child in path.iterdir() if child.is_dir() and is_geff(child)]
    if len(inner) == 1:
        return "folder of geff"
    if any((path / name).is_file() for name in CTC_TABLES):
        return "cell tracking challenge"
    return "folder"


def _binary(path: Path, head: bytes) -> str:
    if head.startswith(_TIFF):
        return "tiff"
    if head.startswith(b"Iout"):
        return "imagej roi"
    if head.startswith(b"\x93NUMPY"):
        return "cellpose masks" if b"'|O'" in head[:200] else "numpy array"
    if head.startswith(b"\x89HDF"):
        raise InputError(f"{path} is an HDF5 file: runs end in .nc; btrack's is read as its .csv")
    if head.startswith(b"PK"):
        try:
            with zipfile.ZipFile(path) as archive:
                names = archive.namelist()
        except (zipfile.BadZipFile, OSError) as error:
            raise InputError(
                f"{path} is not whole: the archive cannot be opened ({error})"
            ) from None
        if any(name.lower().endswith(".roi") for name in names):
            return "imagej roi"
        if any(name.startswith("xl/") for name in names):
            raise InputError(f"{path} is a spreadsheet: save it as CSV and give that")
        raise InputError(f"{path} is an archive without ImageJ regions: unpack it first")
    if head.startswith(b"PAR1"):
        raise InputError(f"{path} is a Parquet table: write it as CSV and give that")
    if head.startswith((b"RDX", b"\x1f\x8b", b"BZh", b"\xfd7zXZ")):
        raise InputError(f"{path} is packed (R's .rda, gzip, ...): write it as CSV and give that")
    return ""


def _text(path: Path, head: bytes) -> str:
    text = decoded(head).lstrip("\ufeff \r\n\t")
    if text.startswith("<"):
        for word, form in (("<TrackMate", "trackmate"), ("<Tracks", "trackmate tracks")):
            if word in text:
                return form
        if any(word in text for word in ("<particle", "TrackContest", "<trackgroup")):
            return "trackmate tracks"
        raise InputError(f"{path} is XML that is not known: TrackMate's and Icy's are read")
    if text.startswith(("{", "[")) and re.search(r'"(type|features|coordinates)"', text):
        return "geojson"
    if re.search(r"^cls\s*=\s*\(?['\"]celltool|^points\s*=[\\\s]*array\(", text, re.MULTILINE):
        return "celltool"
    lines = [line for line in text.splitlines() if line.strip()]
    # A table without names has as many cells in each row, and few; outlines are long and differ.
    if len(lines[0]) > _LONG_LINE and _COORDINATES.match(lines[0][:200] + ","):
        return "cellpose outlines"
    return "table"
