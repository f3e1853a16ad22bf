"""What a run and a track are: names, units and attributes, and the checks on them.

Numpy and xarray alone: nothing here loads a solver.
"""

from cellcrawl.data.attributes import checked_attributes, decode_attribute, encode_attributes
from cellcrawl.data.runs import (
    SYSTEMS,
    check_run,
    checked_times,
    edge_field,
    records_with,
    systems_of,
)
from cellcrawl.data.schema import (
    EDGE_FIELDS,
    FIELDS,
    MODEL_ENDINGS,
    RESUMABLE,
    SCHEMA_VERSION,
    STATUSES,
    TIME,
    TRACK_FIELDS,
    VARIABLES,
    Field,
)

__all__ = [
    "EDGE_FIELDS",
    "FIELDS",
    "MODEL_ENDINGS",
    "RESUMABLE",
    "SCHEMA_VERSION",
    "STATUSES",
    "SYSTEMS",
    "TIME",
    "TRACK_FIELDS",
    "VARIABLES",
    "Field",
    "check_run",
    "checked_attributes",
    "checked_times",
    "decode_attribute",
    "edge_field",
    "encode_attributes",
    "records_with",
    "systems_of",
]
