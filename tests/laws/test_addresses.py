"""Kernels called by address: the bits of a direct call, and one compilation for all laws."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from typing import Any, NamedTuple

import numba
import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.laws import CatchSlip
from cellcrawl.laws.addresses import NUMBER, ROWS, address, called_by_address
from cellcrawl.laws.functions import LawType, off_rate, velocity
from cellcrawl.laws.law import PAPER
from cellcrawl.solvers.adaptive.follow import follow
from cellcrawl.solvers.adaptive.frame import fill_frame
from cellcrawl.solvers.conditions import edge_column

CELL = cc.Parameters(r_on=26, zeta_1=600)
EDITED = """
import cellcrawl as cc
from cellcrawl.laws.force_balance import bond_force
from cellcrawl.solvers.conditions import edge_column

class Mine(cc.laws.Law):
    def contraction(self, phi, r, p):
        return {times} * p.sigma_c

cell = cc.Parameters(r_on=26, zeta_1=600)
edge = edge_column(cell, Mine()).copy()
print(bond_force(Mine().compiled, 1.0, 0.5, 200.0, 1.0, edge, 0))
"""


class Addresses(NamedTuple):
    """What the caller is given in place of a law."""

    speed: int


@called_by_address(NUMBER, NUMBER, ROWS)
def speed(laws: Any, phi: float, edge: np.ndarray) -> float:
    return velocity(laws, phi, off_rate(laws, phi, edge, 0), 100.0, 1.0, edge, 0)


@numba.njit
def caller(laws: Any, phi: float, edge: np.ndarray) -> float:
    return 2.0 * speed(laws, phi, edge)


@numba.njit
def careless(laws: Any, phi: int, edge: np.ndarray) -> float:
    return speed(laws, phi, edge)


def test_a_call_by_address_has_the_bits_of_a_direct_one_and_one_caller_serves_all_laws():
    for law in (PAPER, CatchSlip(catch=5.0)):
        edge, compiled = edge_column(CELL, law).copy(), law.compiled
        addresses = Addresses(address(speed, compiled, None))
        for phi in (0.3, 2.5):
            assert caller(addresses, phi, edge) == caller(compiled, phi, edge)
            assert caller(addresses, phi, edge) == 2.0 * speed(compiled, phi, edge)
    by_address = [kinds for kinds in caller.signatures if not isinstance(kinds[0], LawType)]
    assert len(by_address) == 1
    assert len(caller.signatures) == 3


def test_an_argument_of_another_type_than_the_kernel_takes_is_refused():
    addresses = Addresses(address(speed, PAPER.compiled, None))
    with pytest.raises(numba.TypingError, match="a kernel takes float64, not int64"):
        careless(addresses, 1, edge_column(CELL, PAPER).copy())


@pytest.mark.parametrize("kernel", [follow, fill_frame])
def test_the_solver_compiles_for_no_law_and_no_surroundings_in_particular(kernel):
    stripes = cc.surroundings.Stripes(period=3.0, between=0.4, edge=0.2)
    cc.simulate(CELL, 0.1, laws=CatchSlip(catch=5.0))
    cc.simulate(CELL, 0.1, surroundings=stripes)
    before = set(kernel.signatures)
    assert not [kinds for kinds in before if "surroundings_" in str(kinds)]
    assert not [kinds for kinds in before if isinstance(kinds[0], LawType)]
    cc.simulate(CELL, 0.1, laws=cc.laws.Stiffness(chi=0.5))
    cc.simulate(CELL, 0.1, surroundings=cc.surroundings.UniformForce(x=0.5))
    assert set(kernel.signatures) == before


def test_an_edited_law_meets_no_code_of_before(tmp_path):
    file = tmp_path / "mine.py"
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    for times in (1.0, 2.0):
        file.write_text(EDITED.format(times=times), encoding="utf-8")
        done = subprocess.run(
            [sys.executable, file], env=environment, capture_output=True, text=True, check=True
        )
        phi = float(done.stdout)
        pull = times * CELL.sigma_c + 200.0 * (1.0 + CELL.h)
        assert phi * (math.exp(phi) + CELL.zeta_1 * 0.5) == pytest.approx(pull, rel=1e-12)
