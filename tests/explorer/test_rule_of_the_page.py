from __future__ import annotations

import math

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.explorer.content import content
from cellcrawl.modes.synthetic import RECIPES, synthetic_tracks
from tests.explorer import node

CODE = """
return given.map(({t, x, y, radius, since}) =>
  $rule.classify(Float64Array.from(t), Float64Array.from(x), Float64Array.from(y), radius, since));
"""


@node.needs_node
def test_the_page_names_modes_as_the_package_does(tmp_path):
    given, wanted = [], []
    for point in ((26, 600), (44, 560)):
        p = cc.Parameters(r_on=point[0], zeta_1=point[1])
        run = cc.simulate(p, t_end=100.0, start=cc.RandomPerturbation(seed=2))
        for records in (15, 40, 120, 600, 1001):
            part = run.isel(time=slice(0, records))
            t, x, y = (part[k].values for k in ("time", "centroid_x", "centroid_y"))
            radius = math.sqrt(float(np.median(part["area"])) / math.pi)
            given.append(
                {"t": t.tolist(), "x": x.tolist(), "y": y.tolist(), "radius": radius, "since": 0}
            )
            wanted.append(cc.classify(part))
    for track in synthetic_tracks(45, 5, tuple(RECIPES)):  # with noise, pauses, uneven times
        radius = 1e-6 * float(np.ptp(track.x) + np.ptp(track.y) + 1e-9)
        given.append(
            {
                "t": track.t.tolist(),
                "x": track.x.tolist(),
                "y": track.y.tolist(),
                "radius": radius,
                "since": -1e12,
            }
        )
        wanted.append(cc.classify_track(track.t, track.x, track.y, cell_radius=radius))
    found = node.run("rule", content(), CODE, given, tmp_path)
    for seen, known in zip(found, wanted, strict=True):
        assert (seen["mode"], seen["detail"]) == (known.mode, known.detail)
        assert seen["confidence"] == pytest.approx(known.confidence, abs=1e-6)
    assert [seen["words"] for seen in found[:10]] == [known.summary() for known in wanted[:10]]
