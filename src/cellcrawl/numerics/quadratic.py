"""Roots of a real quadratic on arrays, without cancellation and in a fixed order."""

from __future__ import annotations

import numpy as np


def ordered_roots(half: np.ndarray, product: np.ndarray, square: np.ndarray) -> np.ndarray:
    """Return both roots of ``lam**2 + 2 half lam + product``, shape (..., 2).

    The larger comes first; of a complex pair the one with the positive imaginary part. ``square``
    is ``half**2 - product``, which the caller may know with less cancellation.
    """
    root = np.sqrt(np.abs(square))
    far = -half - np.copysign(root, half)  # no cancellation; the other root from the product
    near = np.divide(product, far, out=np.zeros_like(far), where=far != 0.0)
    oscillates = square < 0.0
    rates = np.empty((*half.shape, 2), complex)
    for index, (larger, sign) in enumerate(((np.maximum, 1.0), (np.minimum, -1.0))):
        rates[..., index].real = np.where(oscillates, -half, larger(far, near))
        rates[..., index].imag = np.where(oscillates, sign * root, 0.0)
    rates += 0.0  # no minus zeros
    return rates
