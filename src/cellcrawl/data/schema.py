"""The data contract: names, dimensions and units of a run's variables, and how a run can end."""

from __future__ import annotations

from typing import Final, NamedTuple

SCHEMA_VERSION: Final = 2
"""2: files carry checksums of all they hold. 1: version 0.1.0, which had none."""


class Field(NamedTuple):
    """A variable of the Dataset."""

    dims: tuple[str, ...]
    long_name: str
    units: str


_EDGE = ("time", "node")
FIELDS: Final[dict[str, Field]] = {
    "x": Field(_EDGE, "position of the edge, x", "R_0"),
    "y": Field(_EDGE, "position of the edge, y", "R_0"),
    "theta": Field(_EDGE, "tangent angle", "rad"),
    "curvature": Field(_EDGE, "curvature of the edge", "1/R_0"),
    "bound_fraction": Field(_EDGE, "fraction of bound linkers", "1"),
    "off_rate": Field(_EDGE, "off-rate of linkers", "k_off0"),
    "normal_velocity": Field(_EDGE, "outward normal velocity of the edge", "R_0 k_off0"),
    "friction": Field(_EDGE, "friction (traction) on the edge", "zeta_0 v_beta"),
    "tension": Field(("time",), "membrane tension", "zeta_0 v_beta / 2"),
    "length": Field(("time",), "length of the edge", "R_0"),
    "area": Field(("time",), "enclosed area, from the shape", "R_0^2"),
    "centroid_x": Field(("time",), "centroid of the area, x", "R_0"),
    "centroid_y": Field(("time",), "centroid of the area, y", "R_0"),
}
TIME: Final = Field(("time",), "time", "1/k_off0")
VARIABLES: Final = ("time", *FIELDS)
"""All variables of a run."""
EDGE_FIELDS: Final = tuple(name for name, field in FIELDS.items() if "node" in field.dims)
"""The fields that live on the edge, one value a node."""
TRACK_FIELDS: Final = tuple(name for name in FIELDS if name not in EDGE_FIELDS)
"""The cell as a whole, one value a record."""

DIMENSIONAL: Final[dict[str, tuple[str, str]]] = {
    "R_0": ("m", "um"),
    "R_0^2": ("m^2", "um^2"),
    "1/R_0": ("1/m", "1/um"),
    "1/k_off0": ("s", "s"),
    "k_off0": ("1/s", "1/s"),
    "R_0 k_off0": ("m/s", "um/s"),
    "zeta_0 v_beta": ("N/m", "pN/um"),
    "zeta_0 v_beta / 2": ("N/m", "pN/um"),
}
"""What stands in place of each unit of the model in SI (`cellcrawl.Scales.dataset`), and in
micrometres, in which pictures are drawn."""

STATUSES: Final[dict[str, str]] = {
    "completed": "reached t_end",
    "fragmented": "the edge crossed itself: the cell tears, and the model means nothing beyond",
    "out_of_range": "no off-rate r >= 1 balances the forces somewhere: outside the model",
    "not_finite": "a value was no longer finite: usually a step that is too long",
    "step_too_small": "the solver could not meet its tolerance with any reasonable step",
    "unresolved": "the shape needs more nodes than allowed",
    "inconsistent": "the shape has left the tension law, or come open: the result is wrong beyond",
    "interrupted": "stopped by the user; can be resumed",
    "running": "not ended: still going, or killed; can be resumed",
}
RESUMABLE: Final = ("completed", "interrupted", "running")
MODEL_ENDINGS: Final = ("completed", "fragmented")  # the run ended as the model allows
