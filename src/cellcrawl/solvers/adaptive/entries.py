"""Entries of a state after its fields, and of the parameters along the edge."""

from __future__ import annotations

from typing import Final

LENGTH, TENSION, AREA, ORIGIN_X, ORIGIN_Y = range(5)  # scalars, after the fields
SCALARS: Final = 8  # room kept for them
FIELDS: Final = 3
TENSION_RATE: Final = -1  # row of `edge`, after the law's own
