"""Fourier waves of fields on the nodes: how large they are, and the same on another grid."""

from __future__ import annotations

import math

import numpy as np

from cellcrawl.numerics.elementary import cosine, hypotenuse, sine
from cellcrawl.numerics.kernels import kernel

_ROUNDING = 3e-13  # waves smaller than this are what rounding leaves of none


@kernel
def transform(values: np.ndarray, sign: float) -> np.ndarray:
    """Discrete Fourier transform of complex values, without a factor: -1 there, +1 back.

    Any count whose prime factors are small; values and transform are in their natural order.
    """
    count = values.size
    turns = np.empty(count, np.complex128)
    for k in range(count):
        angle = sign * 2.0 * math.pi * k / count
        turns[k] = complex(cosine(angle), sine(angle))
    now, then = values.copy(), np.empty(count, np.complex128)
    done = 1  # each run of this many entries is the transform of a comb of the values
    while done < count:
        left = count // done
        radix = 2
        while left % radix != 0:
            radix += 1
        combs = left // radix
        for comb in range(combs):
            for part in range(radix):
                for k in range(done):
                    wave = k + done * part
                    value = now[comb * done + k]
                    for other in range(1, radix):
                        turn = turns[(wave * other * combs) % count]
                        value += turn * now[(comb + other * combs) * done + k]
                    then[(comb * radix + part) * done + k] = value
        now, then = then, now
        done *= radix
    return now


@kernel
def resample(
    first: np.ndarray, second: np.ndarray, ahead: float, out1: np.ndarray, out2: np.ndarray
) -> None:
    """Read two periodic fields at as many equal steps as ``out1`` and ``out2`` have.

    The first place is ``ahead`` of the first sample, of a period of 2 pi. Counts are even and not
    the same.
    """
    old, new = first.size, out1.size
    values = np.empty(old, np.complex128)
    for i in range(old):
        values[i] = complex(first[i], second[i])
    waves = transform(values, -1.0)
    moved = np.zeros(new, np.complex128)
    half = min(old, new) // 2
    for k in range(half):
        turn = complex(cosine(ahead * k), sine(ahead * k)) / old
        moved[k] = waves[k] * turn
        if k > 0:
            moved[new - k] = waves[old - k] * turn.conjugate()
    turn = complex(cosine(ahead * half), sine(ahead * half)) / old
    if old < new:  # the shortest wave of the old nodes is half of each direction
        moved[half] = 0.5 * waves[half] * turn
        moved[new - half] = 0.5 * waves[half] * turn.conjugate()
    else:
        moved[half] = waves[half] * turn + waves[old - half] * turn.conjugate()
    values = transform(moved, 1.0)
    for i in range(new):
        out1[i], out2[i] = values[i].real, values[i].imag


@kernel
def slopes(w: np.ndarray, n: np.ndarray, g: np.ndarray) -> np.ndarray:
    """Size of every wave in the slopes of three fields on the nodes, shape (nodes // 2 + 1,).

    The fields are the tangent angle less its winding, the bound fraction and the density of the
    nodes. The squares sum to the mean square.
    """
    nodes = w.size
    values = np.empty(nodes, np.complex128)
    for i in range(nodes):
        values[i] = complex(w[i], n[i])
    two = transform(values, -1.0)
    for i in range(nodes):
        values[i] = complex(g[i], 0.0)
    one = transform(values, -1.0)
    sizes = np.empty(nodes // 2 + 1)
    for k in range(sizes.size):
        forth, back = two[k], two[(nodes - k) % nodes].conjugate()
        square = 0.0
        for wave in (0.5 * (forth + back), 0.5 * (forth - back), one[k]):
            size = hypotenuse(wave.real, wave.imag) / nodes
            square += size * size if size >= _ROUNDING else 0.0
        sizes[k] = k * math.sqrt(2.0 * square)
    return sizes
