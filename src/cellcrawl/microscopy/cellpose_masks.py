"""Cellpose's ``_seg.npy``: a pickled dictionary, of which only plain arrays are let in."""

from __future__ import annotations

import io
import pickle
from pathlib import Path
from typing import Any

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.microscopy.label_images import outlines_of_labels
from cellcrawl.microscopy.options import Reading
from cellcrawl.microscopy.outlines import Outlines
from cellcrawl.microscopy.source import Source

# What a dictionary of arrays, numbers and text is pickled of; anything else could run code.
_HARMLESS = {
    ("numpy", "ndarray"),
    ("numpy", "dtype"),
    ("numpy.core.multiarray", "_reconstruct"),
    ("numpy._core.multiarray", "_reconstruct"),
    ("numpy.core.multiarray", "scalar"),
    ("numpy._core.multiarray", "scalar"),
    ("numpy._core.numeric", "_frombuffer"),
    ("numpy.core.numeric", "_frombuffer"),
    ("_codecs", "encode"),
    ("collections", "OrderedDict"),
    ("builtins", "set"),
    ("builtins", "slice"),
    ("builtins", "complex"),
}


class _PlainUnpickler(pickle.Unpickler):
    def find_class(self, module: str, name: str) -> Any:
        if (module, name) not in _HARMLESS:
            raise pickle.UnpicklingError(f"it asks for {module}.{name}")
        return super().find_class(module, name)


def read_cellpose_masks(path: Path, reading: Reading) -> Outlines:
    """Read the masks of a ``_seg.npy`` without running anything that it may hold."""
    masks = _plain_dictionary(path).get("masks")
    if not isinstance(masks, np.ndarray) or masks.ndim not in (2, 3):
        raise InputError(f"{path} holds no masks of cellpose")
    frames = list(masks[None] if masks.ndim == 2 else masks)
    source = Source(str(path), "cellpose masks", {}, "pixel", "", True)
    return outlines_of_labels(frames, source, reading)


def _plain_dictionary(path: Path) -> dict[str, Any]:
    data = path.read_bytes()
    stream = io.BytesIO(data)
    try:
        version = np.lib.format.read_magic(stream)
        header = np.lib.format.read_array_header_1_0
        if version != (1, 0):
            header = np.lib.format.read_array_header_2_0
        shape, _, dtype = header(stream)
        if not dtype.hasobject or shape != ():
            raise InputError(f"{path} holds an array, not the dictionary that cellpose writes")
        content = _PlainUnpickler(stream).load()
    except (pickle.UnpicklingError, EOFError, ValueError, ImportError, AttributeError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"{path} is not read: {error}, and only plain arrays are let in") from None
    if isinstance(content, np.ndarray) and content.shape == ():
        content = content.item()
    if not isinstance(content, dict):
        raise InputError(f"{path} holds no dictionary as cellpose writes it")
    return content
