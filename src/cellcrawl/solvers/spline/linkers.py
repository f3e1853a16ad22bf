"""Diffusion of bound linkers along unevenly spaced markers, implicit and of fourth order.

The second derivative along the arclength, ``w = n_ss``, is a compact one: three neighbours of ``w``
are tied to three of ``n`` by ``P w = Q n`` with the actual arclengths between the markers (Lele,
J. Comput. Phys. 103, 16, 1992; uneven form by Gamet et al., Int. J. Numer. Meth. Fluids 29, 159,
1999). It is third order on any spacing and fourth where the spacing changes smoothly. A marker
moves along the normal only, so that nothing is carried along the edge.
"""

from __future__ import annotations

import numpy as np

from cellcrawl.numerics.cyclic import solve_cyclic_tridiagonal
from cellcrawl.numerics.kernels import kernel
from cellcrawl.solvers.spline.outline import SEGMENT, N

LINKER_ROWS = 5
DIFFUSIVITY = 2  # row of `edge`


@kernel
def second_derivative_after(
    fields: np.ndarray,
    edge: np.ndarray,
    step: float,
    shape: np.ndarray,
    w: np.ndarray,
    work: np.ndarray,
) -> None:
    """``w = n_ss`` of the ``n`` that an implicit step of diffusion leads to.

    The stepped field is ``n + step D w``; with ``step = 0`` this is the plain second derivative.
    From ``P w = Q (n + step D w)`` follows the cyclic tridiagonal system
    ``(P - step Q D) w = Q n``. ``w`` has shape (markers,), ``work``
    (LINKER_ROWS, markers).
    """
    n, diffusivity, segment = fields[N], edge[DIFFUSIVITY], shape[SEGMENT]
    markers = n.size
    lower, diagonal, upper = work[0], work[1], work[2]
    for i in range(markers):
        j = i - 1 if i > 0 else markers - 1
        k = i + 1 if i < markers - 1 else 0
        behind, ahead = segment[j], segment[i]
        both = behind + ahead
        product = behind * ahead
        form = 1.0 / (both * (both * both + product))
        from_before = 12.0 * ahead * form
        from_after = 12.0 * behind * form
        tie_before = ahead * (behind * behind + product - ahead * ahead) * form
        tie_after = behind * (ahead * ahead + product - behind * behind) * form
        here = from_before + from_after
        w[i] = from_before * (n[j] - n[i]) + from_after * (n[k] - n[i])
        lower[i] = tie_before - step * from_before * diffusivity[j]
        diagonal[i] = 1.0 + step * here * diffusivity[i]
        upper[i] = tie_after - step * from_after * diffusivity[k]
    solve_cyclic_tridiagonal(lower, diagonal, upper, w, work[3:5])
