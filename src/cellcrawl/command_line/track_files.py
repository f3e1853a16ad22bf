"""Options of every command that reads tracks, and the one way such files are read."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from cellcrawl.command_line.options import say

if TYPE_CHECKING:
    from cellcrawl.microscopy import Tracks

F = TypeVar("F", bound=Callable[..., Any])

_OPTIONS = (
    click.option(
        "--columns",
        metavar="ROLES",
        help="Which column is what, as id=Cell,t=Time,x=X,y=Y (names or numbers; id=none for one "
        "cell; group=Movie keeps movies apart), or id,t,x,y in the order of the file.",
    ),
    click.option(
        "--frame-interval",
        metavar="TIME",
        help="Time from frame to frame, as 60 or '60 s'.",
    ),
    click.option(
        "--pixel-size",
        metavar="LENGTH",
        help="Size of a pixel, as 0.65 or '0.65 um', for positions in pixels.",
    ),
    click.option(
        "--image-coordinates/--y-up",
        default=None,
        help="Whether y points down, as in an image; left and right are then those seen on the "
        "screen.  [default: down for what image programs write, up for plain tables]",
    ),
)


def reading_options(function: F) -> F:
    """Add the options of a reader of tracks: pass them on to `read_tracks_of` by keyword."""
    for option in reversed(_OPTIONS):
        function = option(function)
    return function


def read_tracks_of(
    file: Path,
    *,
    columns: str | None = None,
    frame_interval: str | None = None,
    pixel_size: str | None = None,
    image_coordinates: bool | None = None,
) -> Tracks:
    """Read a file of tracks with the options of the command line."""
    import cellcrawl as cc

    return cc.read_tracks(
        file,
        columns=columns,
        frame_interval=frame_interval,
        pixel_size=pixel_size,
        image_coordinates=image_coordinates,
    )


def told_of_drift(tracks: Tracks, remove: bool) -> Tracks:
    """Say whether all tracks share motion, and return them without it if asked to."""
    import cellcrawl as cc

    drift = cc.observables.shared_drift(tracks)
    if drift.noticed:
        say(f"{drift}" + ("" if remove else "; --remove-drift takes it off"))
    if not remove:
        return tracks
    tracks = cc.observables.without_drift(tracks, drift)
    say(tracks.source.notes[-1])
    if not drift.noticed:
        say(
            f"but {drift}: what was taken off is the cells' own, 1/{len(tracks)} of the motion of "
            "each"
        )
    return tracks
