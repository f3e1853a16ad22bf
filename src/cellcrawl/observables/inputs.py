"""What the observables ask of a Dataset: the checks of `cellcrawl.data`."""

from cellcrawl.data import EDGE_FIELDS, edge_field, records_with

__all__ = ["EDGE_FIELDS", "edge_field", "records_with"]
