"""Tracks from graphs in the Graph Exchange File Format, by the reader of its authors."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.microscopy.columns import length_unit, time_unit
from cellcrawl.microscopy.extras import reader
from cellcrawl.microscopy.grouping import tracks_of_records
from cellcrawl.microscopy.options import Reading
from cellcrawl.microscopy.source import Source
from cellcrawl.microscopy.track import Tracks


def read_geff(path: Path, reading: Reading) -> Tracks:
    """Read a GEFF graph: a track from each birth to the next division, named by its first node.

    Where the graph names its tracklets, these names are taken.
    """
    reading.without_columns(str(path))
    core = reader("geff.core_io", "GEFF graphs")
    try:
        graph = core.read_to_memory(path)
    except Exception as error:  # its reader raises many kinds, of Zarr's, pydantic's and its own
        told = " ".join(str(error).split())[:160]
        raise InputError(f"{path} cannot be read as a GEFF graph: {told}") from None
    metadata, properties = graph["metadata"], graph["node_props"]
    axes = list(metadata.axes or [])
    t, time = _axis(path, axes, properties, "time", ("t", "time", "frame"))
    x, length = _axis(path, axes, properties, "space", ("x", "POSITION_X"), last=True)
    y, _ = _axis(path, axes, properties, "space", ("y", "POSITION_Y"), last=True, before=1)
    nodes, edges = np.asarray(graph["node_ids"]), np.asarray(graph["edge_ids"]).reshape(-1, 2)
    codes, ids, parents = _tracklets(nodes, edges)
    named = getattr(metadata, "track_node_props", None) or {}
    given = named.get("tracklet") if isinstance(named, dict) else None
    if given in properties:
        ids, codes = _names_given(properties[given]["values"], codes, ids)
        parents = {}
    source = Source(str(path), "GEFF graph", {}, length or "pixel", time, True)
    if reading.frame_interval is not None or not time:
        source, t = reading.timed(source, t)
    source, x, y = reading.scaled(source, x, y)
    return tracks_of_records(codes, ids, t, x, y, source, (), parents)


def _axis(
    path: Path,
    axes: list[Any],
    properties: dict[str, Any],
    kind: str,
    names: tuple[str, ...],
    *,
    last: bool = False,
    before: int = 0,
) -> tuple[np.ndarray, str]:
    """Return a coordinate of the nodes and its unit: by its name, else by its place."""
    named = {axis.name: axis for axis in axes}
    found = next((name for name in names if name in properties), None)
    if found is None:
        of_kind = [axis.name for axis in axes if axis.type == kind]
        place = len(of_kind) - 1 - before if last else 0
        if not 0 <= place < len(of_kind):
            raise InputError(f"{path} has no axis of {kind} named {names[0]}")
        found = of_kind[place]
    values = np.asarray(properties[found]["values"], float)
    missing = properties[found].get("missing")
    if missing is not None:
        values = np.where(np.asarray(missing, bool), np.nan, values)
    axis = named.get(found)
    unit = getattr(axis, "unit", None) or ""
    if axis is not None and getattr(axis, "scale", None):
        values = axis.scale * values + (axis.offset or 0.0)
        unit = axis.scaled_unit or unit
    return values, (time_unit if kind == "time" else length_unit)(unit)


def _tracklets(
    nodes: np.ndarray, edges: np.ndarray
) -> tuple[np.ndarray, list[str], dict[str, str]]:
    """Return the track of each node: paths of nodes with one edge in and one edge out."""
    order = np.argsort(nodes)
    ends = order[np.searchsorted(nodes, edges, sorter=order)] if edges.size else edges
    ends = ends.astype(np.int64).reshape(-1, 2)
    into = np.bincount(ends[:, 1], minlength=nodes.size)
    out = np.bincount(ends[:, 0], minlength=nodes.size)
    plain = (out[ends[:, 0]] == 1) & (into[ends[:, 1]] == 1)
    before = np.full(nodes.size, -1)
    before[ends[plain, 1]] = ends[plain, 0]
    first = np.arange(nodes.size)
    # Each round doubles how far back a node looks for the beginning of its path.
    root = np.where(before >= 0, before, first)
    for _ in range(64):
        further = root[root]
        if np.array_equal(further, root):
            break
        root = further
    roots, codes = np.unique(root, return_inverse=True)
    ids = [str(nodes[place]) for place in roots]
    forks = ends[~plain]
    parents = {ids[codes[child]]: ids[codes[parent]] for parent, child in forks}
    return codes.astype(np.int64), ids, parents


def _names_given(
    values: np.ndarray, codes: np.ndarray, ids: list[str]
) -> tuple[list[str], np.ndarray]:
    names, own = np.unique(np.asarray(values), return_inverse=True)
    # A name that is on two paths would merge two cells: then the paths keep their own names.
    pairs = {(int(a), int(b)) for a, b in zip(own, codes, strict=True)}
    if len(pairs) != len(names) or len(pairs) != len(ids):
        return ids, codes
    return [str(name) for name in names], own.astype(np.int64)
