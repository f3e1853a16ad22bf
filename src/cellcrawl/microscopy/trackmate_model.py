"""TrackMate's model file, written."""

from __future__ import annotations

from itertools import pairwise
from typing import Any
from xml.sax.saxutils import quoteattr


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
    by_frame: dict[int, list[int]] = {}
    for place, spot in enumerate(spots):
        by_frame.setdefault(int(spot["frame"]), []).append(place)
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        '<TrackMate version="7.11.1">',
        f"  <Model spatialunits={quoteattr(length or 'pixel')} "
        f"timeunits={quoteattr(time or 'frame')}>",
        f'    <AllSpots nspots="{len(spots)}">',
    ]
    for frame in sorted(by_frame):
        lines.append(f'      <SpotsInFrame frame="{frame}">')
        lines += [_spot(place, spots[place]) for place in by_frame[frame]]
        lines.append("      </SpotsInFrame>")
    lines += ["    </AllSpots>", "    <AllTracks>"]
    for name, places in links.items():
        lines.append(f"      <Track name={quoteattr(f'Track_{name}')} TRACK_ID={quoteattr(name)}>")
        lines += [
            f'        <Edge SPOT_SOURCE_ID="{one}" SPOT_TARGET_ID="{other}" />'
            for one, other in pairwise(places)
        ]
        lines.append("      </Track>")
    lines += ["    </AllTracks>", "    <FilteredTracks>"]
    lines += [f"      <TrackID TRACK_ID={quoteattr(name)} />" for name in links]
    lines += ["    </FilteredTracks>", "  </Model>", "</TrackMate>", ""]
    return "\n".join(lines)


def _spot(place: int, spot: dict[str, Any]) -> str:
    told = (
        f'        <Spot ID="{place}" name="ID{place}" QUALITY="1.0" '
        f'POSITION_T="{shown(spot["t"])}" '
        f'FRAME="{int(spot["frame"])}" VISIBILITY="1" RADIUS="{shown(spot.get("radius", 1.0))}" '
        f'POSITION_X="{shown(spot["x"])}" POSITION_Y="{shown(spot["y"])}" POSITION_Z="0.0"'
    )
    if not spot["text"]:
        return told + " />"
    return f'{told} ROI_N_POINTS="{len(spot["text"].split()) // 2}">{spot["text"]}</Spot>'
