"""TrackMate's model file, written."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from itertools import pairwise
from typing import Any


def shown(value: float) -> str:
    """Return a number as text that is read back to twelve digits."""
    return format(float(value), ".12g")


def trackmate_model(
    spots: list[dict[str, Any]], links: dict[str, list[int]], length: str, time: str
) -> str:
    """Return a TrackMate model file.

    Parameters
    ----------
    spots : list of dict
        With x, y, t, frame, and as text the points of the outline around (x, y).
    links : dict
        Places of the spots of each track, in the order of time.
    length, time : str
        Units.
    """
    root = ElementTree.Element("TrackMate", version="7.11.1")
    units = {"spatialunits": length or "pixel", "timeunits": time or "frame"}
    model = ElementTree.SubElement(root, "Model", units)
    every = ElementTree.SubElement(model, "AllSpots", nspots=str(len(spots)))
    by_frame: dict[int, list[int]] = {}
    for place, spot in enumerate(spots):
        by_frame.setdefault(int(spot["frame"]), []).append(place)
    for frame in sorted(by_frame):
        inside = ElementTree.SubElement(every, "SpotsInFrame", frame=str(frame))
        for place in by_frame[frame]:
            spot = spots[place]
            told = {
                "ID": str(place),
                "name": f"ID{place}",
                "QUALITY": "1.0",
                "POSITION_T": shown(spot["t"]),
                "FRAME": str(frame),
                "VISIBILITY": "1",
                "RADIUS": shown(spot.get("radius", 1.0)),
                "POSITION_X": shown(spot["x"]),
                "POSITION_Y": shown(spot["y"]),
                "POSITION_Z": "0.0",
            }
            if spot["text"]:
                told["ROI_N_POINTS"] = str(len(spot["text"].split()) // 2)
            ElementTree.SubElement(inside, "Spot", told).text = spot["text"] or None
    tracks = ElementTree.SubElement(model, "AllTracks")
    kept = ElementTree.SubElement(model, "FilteredTracks")
    for name, places in links.items():
        track = ElementTree.SubElement(tracks, "Track", name=f"Track_{name}", TRACK_ID=name)
        for one, other in pairwise(places):
            ElementTree.SubElement(
                track, "Edge", SPOT_SOURCE_ID=str(one), SPOT_TARGET_ID=str(other)
            )
        ElementTree.SubElement(kept, "TrackID", TRACK_ID=name)
    ElementTree.indent(root)
    text = ElementTree.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}\n'
