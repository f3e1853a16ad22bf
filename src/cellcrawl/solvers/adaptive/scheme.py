"""The coefficients of the stabilised steps, read from the table beside this file."""

from __future__ import annotations

import functools
from importlib import resources
from typing import NamedTuple

import numpy as np

_TABLE = "stabilised_coefficients.txt"


class Scheme(NamedTuple):
    """A family of explicit methods, one for each degree.

    ``limits``: longest step times decay rate that is stable, shape (degrees,). ``degrees``: stages.
    ``first``: where each degree begins in ``recurrence``, whose rows are ``(mu, nu, kappa, c)``.
    ``finish``: the last four stages and the error estimate, shape (degrees, 19).
    """

    limits: np.ndarray
    degrees: np.ndarray
    first: np.ndarray
    recurrence: np.ndarray
    finish: np.ndarray


@functools.cache
def fourth_order_scheme() -> Scheme:
    """Return the fourth-order family, derived by ``tools/stabilised_scheme.py``."""
    lines = resources.files(__package__).joinpath(_TABLE).read_text("ascii").splitlines()
    limits: list[float] = []
    degrees: list[int] = []
    first: list[int] = []
    recurrence: list[list[float]] = []
    finish: list[list[float]] = []
    for line in lines:
        words = line.split()
        if words[0] == "degree":
            degrees.append(int(words[1]))
            limits.append(float(words[2]))
            first.append(len(recurrence))
        elif words[0] != "#":
            (recurrence if len(words) == 4 else finish).append([float(word) for word in words])
    return Scheme(
        np.array(limits),
        np.array(degrees),
        np.array(first),
        np.array(recurrence),
        np.array(finish),
    )
