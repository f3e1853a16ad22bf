"""A TrackMate file.

Four tracks saved by TrackMate, read with their units, named, and drawn on one sheet. Left and
right are those of the screen.
"""

from pathlib import Path

import numpy as np

import cellcrawl as cc

tracks = cc.read_tracks(Path(__file__).parents[1] / "cells.xml")
print(tracks.summary())
modes = [cc.classify_track(t.t, t.x, t.y, cell_radius=10.0) for t in tracks]
cc.plot.tracks(tracks, results=modes).savefig("04_trackmate.png", dpi=110)

# The cells were filmed from the model: its modes come back, and the speed of its glider.
for track, found in zip(tracks, modes, strict=True):
    path = np.hypot(np.diff(track.x), np.diff(track.y)).sum() / track.duration
    print(track.id, found.mode, f"{found.confidence:.2f}", f"{path:.3f} µm/s")
assert [found.mode for found in modes] == ["gliding", "rotational", "zigzag", "other"]
chord = np.hypot(tracks[0].x[-1] - tracks[0].x[40], tracks[0].y[-1] - tracks[0].y[40])
speed = chord / (tracks[0].t[-1] - tracks[0].t[40])
assert abs(speed - 0.186) < 0.01  # the exact glider of (16, 600): 0.1863 R0 k_off0
