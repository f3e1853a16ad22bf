"""The truth that errors are measured against, and how sure it is.

Computed by the adaptive solver at its tightest where it is not recorded. The record has beside each
cell what another program makes of it: CVODE on a uniform grid (`bench.uniform_grid`), which shares
with our solvers the pointwise laws only.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from cellcrawl.bench import rivals
from cellcrawl.bench.cases import LAWS, LONG, POINTS, Case, errors, sampled
from cellcrawl.bench.uniform_grid import UniformGrid
from cellcrawl.errors import InputError
from cellcrawl.solvers import SOLVERS

RTOL: Final = 1e-9
CHECK_NODES: Final = 768
CHECK_RTOL: Final = 1e-9
_QUANTITIES: Final = ("length", "tension", "area", "centroid_x", "centroid_y")
_CELL: Final = ("r_on", "zeta_1", "elasticity", "D", "random")


class Reference(NamedTuple):
    """One cell at one end time: how far the two programs are apart, over its times."""

    case: str
    t_end: float
    length: float
    tension: float
    area: float
    centroid: float


class References:
    """True values of cases: recorded ones, others computed once.

    Parameters
    ----------
    path : Path, optional
        What ``cellcrawl bench references --output`` wrote.

    Raises
    ------
    InputError
        If ``path`` is no such file.
    """

    def __init__(self, path: Path | None = None) -> None:
        self._known: dict[Case, np.ndarray] = {}
        if path is not None:
            self._read(path)

    def of(self, case: Case) -> np.ndarray:
        """Return length, tension, area and centroid at the times of a case, shape (times, 5)."""
        if case not in self._known:
            self._known[case] = computed(case)
        return self._known[case]

    def _read(self, path: Path) -> None:
        try:
            content = json.loads(path.read_text("utf-8"))
            for row in content["references"]:
                case = Case(**{name: row[name] for name in (*_CELL, "t_end")})
                values = np.array([row[name] for name in _QUANTITIES], dtype=float).T
                if tuple(row["times"]) != case.times or not np.isfinite(values).all():
                    raise ValueError(f"the values of {case.label} are not at its times")
                self._known[case] = values
        except OSError as error:
            raise InputError(f"cannot read the references {path}: {error.strerror}") from None
        except (ValueError, KeyError, TypeError) as error:
            raise InputError(
                f"{path} holds no references ({error}): `cellcrawl bench references` writes them"
            ) from None


def computed(case: Case) -> np.ndarray:
    """Return the converged values of a case, by the adaptive solver at its tightest."""
    scheme = SOLVERS["adaptive"]
    start = case.start(scheme.start_nodes(256, rtol=RTOL))
    found = sampled(scheme(start, case.conditions, nodes=256, rtol=RTOL), case.times)
    if not np.isfinite(found).all():
        raise RuntimeError(f"no reference for {case.label}: the run at rtol = {RTOL:g} broke down")
    return found


def checked(case: Case, nodes: int = CHECK_NODES, rtol: float = CHECK_RTOL) -> np.ndarray:
    """Return the same values by CVODE on a uniform grid."""
    system = UniformGrid(case.start(2 * nodes), case.conditions, nodes)
    return rivals.solved(rivals.cvode, system, case.times, rtol)


def measure(quick: bool = False) -> Iterator[tuple[Reference, dict[str, Any]]]:
    """Compute the references of all cells, each with its check; a row and what to record."""
    for t_end in (5.0, 20.0) if quick else (2.0, 5.0, 2.0 * LONG):
        for point in POINTS[:1] if quick else POINTS:
            for law in LAWS:
                case = Case(*point, law, t_end=t_end)
                truth = computed(case)
                other = checked(case, 256, 1e-8) if quick else checked(case)
                apart = errors(other, truth)
                recorded = {name: getattr(case, name) for name in (*_CELL, "t_end")}
                values = dict(zip(_QUANTITIES, truth.T.tolist(), strict=True))
                yield (
                    Reference(case.label, t_end, *apart),
                    {**recorded, "times": list(case.times), **values, "apart": apart._asdict()},
                )
