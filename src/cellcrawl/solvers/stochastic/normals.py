"""Normal numbers that a seed, a step and a node give: nothing to carry from step to step.

A run that is resumed, or stepped again from a checkpoint, meets the same noise because the number
of its step is in its state; numbers of different steps, nodes or seeds are independent.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from cellcrawl.numerics.kernels import inlined_kernel, kernel

_FIRST: Final = np.uint64(0xD2511F53)
_SECOND: Final = np.uint64(0xCD9E8D57)
_GOLDEN: Final = np.uint64(0x9E3779B9)
_SQUARE: Final = np.uint64(0xBB67AE85)
_LOW: Final = np.uint64(0xFFFFFFFF)
_HALF: Final = np.uint64(32)
_UP: Final = np.uint64(21)
_DOWN: Final = np.uint64(11)
_ROUNDS = 10
_UNIT: Final = 2.0**-53


@inlined_kernel
def philox(
    a: np.uint64, b: np.uint64, c: np.uint64, d: np.uint64, key: np.uint64, other: np.uint64
) -> tuple[np.uint64, np.uint64, np.uint64, np.uint64]:
    """Philox-4x32-10 of Salmon et al. (SC'11): four random words of 32 bits from a counter."""
    for _ in range(_ROUNDS):
        one, two = _FIRST * a, _SECOND * c
        a, b, c, d = (two >> _HALF) ^ b ^ key, two & _LOW, (one >> _HALF) ^ d ^ other, one & _LOW
        key, other = (key + _GOLDEN) & _LOW, (other + _SQUARE) & _LOW
    return a, b, c, d


@kernel
def words(seed: int, step: int, pair: int) -> tuple[np.uint64, np.uint64, np.uint64, np.uint64]:
    """Four random words for the ``pair``-th two nodes of a step."""
    chosen, now = np.uint64(seed), np.uint64(step)
    return philox(
        np.uint64(pair),
        np.uint64(0),
        now & _LOW,
        now >> _HALF,
        chosen & _LOW,
        chosen >> _HALF,
    )


@kernel
def fill_normals(seed: int, step: int, out: np.ndarray) -> None:
    """Fill ``out``, shape (nodes,), with the normal numbers of a step (Box & Muller 1958)."""
    for pair in range((out.size + 1) // 2):
        a, b, c, d = words(seed, step, pair)
        radius = math.sqrt(-2.0 * math.log(_UNIT * (np.float64((a << _UP) | (b >> _DOWN)) + 0.5)))
        angle = 2.0 * math.pi * _UNIT * np.float64((c << _UP) | (d >> _DOWN))
        out[2 * pair] = radius * math.cos(angle)
        if 2 * pair + 1 < out.size:
            out[2 * pair + 1] = radius * math.sin(angle)
