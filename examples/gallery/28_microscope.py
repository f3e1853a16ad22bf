"""Through a microscope and back.

A run filmed with coarse pixels, an error of position and one frame in half a unit of time,
written as a label image, read again, and measured like data. What comes back is what went in.
"""

import tempfile
from pathlib import Path

import cellcrawl as cc

run = cc.simulate(cc.Parameters(r_on=26, zeta_1=600), t_end=60)
seen = cc.observe(run, pixel=0.1, error=0.05, frame=0.5, seed=1)
with tempfile.TemporaryDirectory() as folder:
    film = Path(folder) / "film.tif"
    seen.write(film)
    outlines = cc.read_outlines(film)
    tracks = cc.read_tracks(film)
figure = cc.plot.compare_tracks({"the run": run, "its film": tracks})
figure.savefig("28_microscope.png", dpi=110)

found = cc.classify_track(tracks[0].t, tracks[0].x, tracks[0].y, cell_radius=1.0)
edge = cc.observables.edge_series(outlines.of_track(outlines.track_ids[0]))
true, film_circularity = (cc.observables.circularity(one).median() for one in (run, edge))
walk = cc.observables.persistent_walk(tracks)
print(found.mode, found.confidence, float(true), float(film_circularity), walk.speed)
assert found.mode == cc.classify(run).mode == "zigzag"
assert abs(float(film_circularity - true)) < 0.03
assert walk.speed.low < 0.216 < walk.speed.high
