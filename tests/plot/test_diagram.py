"""Diagrams of sweeps: what is drawn where, and what cannot be drawn."""

from __future__ import annotations

import io
import itertools

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

import cellcrawl as cc
from cellcrawl import sweeps
from cellcrawl.modes import MODES
from cellcrawl.plot.mode_symbols import MODE_SYMBOLS
from cellcrawl.plot.symbols import MEASURE_LABELS
from cellcrawl.sweeps import worker
from cellcrawl.sweeps.executors import InProcess
from cellcrawl.sweeps.measures import MEASURES
from cellcrawl.sweeps.planes import majority, means, plane
from cellcrawl.sweeps.worker import Outcome

# modes of seeds 1 to 4 at each r_on; all alike in zeta_1
PLANNED = {
    20.0: ["gliding"] * 4,
    30.0: ["zigzag", "zigzag", "zigzag", "other"],
    40.0: ["fragmented", "fragmented", "fragmented", "rotational"],
}
AXES = {"r_on": list(PLANNED), "zeta_1": [500.0, 600.0], "seed": [1, 2, 3, 4]}


@pytest.fixture
def pretending(monkeypatch):
    def pretend(run, keep):
        p = run.parameters
        mode = PLANNED.get(p.r_on, ["other"] * 4)[run.start.seed - 1]
        speed = p.r_on / 100.0 + (50.0 if mode == "fragmented" else 0.0)
        return Outcome({"status": "completed", "mode": mode, "confidence": 1.0, "speed": speed})

    monkeypatch.setattr(worker, "execute", pretend)


@pytest.fixture
def swept(tmp_path, pretending) -> cc.Sweep:
    return cc.sweep(AXES, tmp_path / "out", InProcess())


def drawn(figure: Figure) -> bytes:
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=50)
    return file.getvalue()


def test_seeds_are_counted_at_each_point(swept):
    found = plane(swept.table())
    assert (found.x_name, found.y_name) == ("r_on", "zeta_1")
    assert found.runs.tolist() == [4] * 6
    at_30 = found.x == 30.0
    assert found.counts["zigzag"][at_30].tolist() == [3, 3]
    assert found.counts["other"][at_30].tolist() == [1, 1]


def test_torn_cells_do_not_decide_and_are_not_averaged(swept):
    found = plane(swept.table())
    modes = dict(zip(found.x.tolist(), majority(found), strict=True))
    assert modes == {20.0: "gliding", 30.0: "zigzag", 40.0: "rotational"}
    speeds = means(swept.table(), "speed")
    assert speeds.tolist() == pytest.approx([0.2, 0.2, 0.3, 0.3, 0.4, 0.4])


def test_points_that_agree_have_the_modes_colour_and_others_are_pies(swept):
    axes = cc.plot.diagram(swept)
    at = {}
    for collection in axes.collections:
        for x, _ in np.asarray(collection.get_offsets()):
            at.setdefault(float(x), set()).add(tuple(collection.get_facecolor()[0][:3]))
    colour = {mode: to_rgb(symbol.colour) for mode, symbol in MODE_SYMBOLS.items()}
    assert at[20.0] == {colour["gliding"]}
    assert at[30.0] == {colour["zigzag"], colour["other"]}
    assert at[40.0] == {colour["fragmented"], colour["rotational"]}
    said = [text.get_text() for text in axes.get_legend().get_texts()]
    assert "gliding (8)" in said
    assert "fragmented (6)" in said
    assert drawn(axes.figure)


def test_slices_of_a_pie_fill_it(swept):
    from cellcrawl.plot.diagram import _slice

    for parts in ([0.0, 0.75, 1.0], [0.0, 0.2, 0.6, 1.0]):
        area = 0.0
        for first, last in itertools.pairwise(parts):
            outline, _ = _slice(first, last)
            x, y = outline.vertices.T
            area += 0.5 * abs(np.dot(x[:-1], y[1:]) - np.dot(y[:-1], x[1:]))
        assert area == pytest.approx(np.pi, rel=0.03)


def test_a_diagram_can_lie_on_a_stability_map(swept):
    stability = cc.linear.stability_map(cc.Parameters(), r_on=[15.0, 45.0], zeta_1=[450.0, 650.0])
    axes = cc.plot.stability(stability)
    assert cc.plot.diagram(swept, ax=axes) is axes
    assert axes.get_xlim() == (15.0, 45.0)
    assert drawn(axes.figure)


def test_a_map_shows_the_mean_at_each_point(swept):
    axes = cc.plot.measure_map(swept, "speed")
    assert axes.collections[0].get_array().reshape(2, 3)[0].tolist() == pytest.approx(
        [0.2, 0.3, 0.4]
    )
    assert drawn(axes.figure)


def test_refined_diagrams_are_regions(tmp_path, pretending):
    axes = {"r_on": [20.0, 30.0, 50.0, 60.0], "zeta_1": [500.0, 600.0], "seed": [1]}
    refined = sweeps.refine(axes, tmp_path / "out", InProcess(), levels=1)
    drawn_axes = cc.plot.diagram(refined)
    tiles = drawn_axes.collections[0].get_array()
    assert tiles.shape == (3, 6, 3)  # 55 is not run: 50 and 60 are of one mode
    assert drawn(drawn_axes.figure)
    assert drawn(cc.plot.measure_map(refined, "speed").figure)


def test_every_mode_has_a_symbol_of_its_own():
    assert set(MODES) < set(MODE_SYMBOLS)
    assert len(set(MODE_SYMBOLS.values())) == len(MODE_SYMBOLS)


def test_every_measure_has_a_label():
    assert set(MEASURE_LABELS) == set(MEASURES)


def test_what_cannot_be_drawn_is_told_in_one_line(swept, tmp_path, pretending):
    line = cc.sweep({"r_on": [20, 30], "seed": [1]}, tmp_path / "line", InProcess())
    with pytest.raises(cc.InputError, match="needs two parameters that differ; here r_on differs"):
        cc.plot.diagram(line)
    with pytest.raises(cc.InputError, match="did you mean 'speed'"):
        cc.plot.measure_map(swept, "sped")
    with pytest.raises(cc.InputError, match="needs a Sweep"):
        cc.plot.diagram(tmp_path)
