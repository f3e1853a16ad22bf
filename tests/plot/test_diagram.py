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
from cellcrawl.plot.spacing import is_logarithmic
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
    point = cc.sweep({"r_on": [20], "seed": [1, 2]}, tmp_path / "point", InProcess())
    with pytest.raises(cc.InputError, match="needs two parameters that differ; here nothing"):
        cc.plot.diagram(point)
    with pytest.raises(cc.InputError, match="no run has a value of tension"):
        cc.plot.measure_map(swept, "tension")
    with pytest.raises(cc.InputError, match="size = 0 is out of range"):
        cc.plot.diagram(swept, size=0)
    with pytest.raises(cc.InputError, match="did you mean 'speed'"):
        cc.plot.measure_map(swept, "sped")
    with pytest.raises(cc.InputError, match="sweep must be a Sweep"):
        cc.plot.diagram(tmp_path)


def test_a_sweep_along_one_parameter_has_a_row_for_each_mode(tmp_path, pretending):
    axes = {"r_on": [20.0, 30.0, 40.0], "seed": [1, 2, 3, 4]}
    line = cc.sweep(axes, tmp_path / "line", InProcess())
    assert line.can_be_drawn()
    ax = cc.plot.diagram(line)
    names = [label.get_text() for label in ax.get_yticklabels()]
    assert names == ["gliding (4)", "rotational (1)", "zigzag (3)", "other (1)", "fragmented (3)"]
    sizes = [collection.get_sizes().tolist() for collection in ax.collections]
    assert sizes[0] == pytest.approx([4.0 * sizes[1][0]])  # four of four runs, and one
    assert ax.get_xticks().tolist() == [20.0, 30.0, 40.0]
    measured = cc.plot.measure_map(line, "speed")
    assert measured.lines[0].get_ydata() == pytest.approx([0.2, 0.3, 0.4])  # without torn cells
    assert sum(len(c.get_offsets()) for c in measured.collections) == 12
    assert drawn(ax.figure)
    assert drawn(measured.figure)


def test_runs_that_ended_well_without_a_mode_are_too_short_not_failed(tmp_path, monkeypatch):
    def pretend(run, keep):
        short = run.parameters.r_on < 30.0
        status = "completed" if short else "unresolved"
        return Outcome({"status": status, "mode": None, "confidence": None})

    monkeypatch.setattr(worker, "execute", pretend)
    swept = cc.sweep({"r_on": [20, 30], "zeta_1": [500, 600]}, tmp_path / "out", InProcess())
    found = plane(swept.table())
    assert {name: count.tolist() for name, count in found.counts.items()} == {
        "too short": [1, 1, 0, 0],
        "failed": [0, 0, 1, 1],
    }
    labels = [text.get_text() for text in cc.plot.diagram(swept).get_legend().get_texts()]
    assert labels == ["too short (2)", "failed (2)"]


def test_points_spaced_in_their_logarithm_make_a_logarithmic_axis_with_ticks_at_the_points(
    tmp_path, pretending
):
    values = [2.0, 6.0, 18.0, 54.0]
    swept = cc.sweep(
        {"r_on": values, "zeta_1": [400.0, 500.0], "seed": [1]}, tmp_path / "out", InProcess()
    )
    for ax in (cc.plot.diagram(swept), cc.plot.measure_map(swept, "speed")):
        assert (ax.get_xscale(), ax.get_yscale()) == ("log", "linear")
        assert ax.get_xticks().tolist() == values
        assert ax.get_yticks().tolist() == [400.0, 500.0]
        assert ax.get_xticks(minor=True).size == 0
    sides = ax.collections[0].get_coordinates()[0, :, 0]
    np.testing.assert_allclose(sides, [values[0] / np.sqrt(3), *np.multiply(values, np.sqrt(3))])


@pytest.mark.parametrize(
    ("values", "logarithmic"),
    [
        ([0.01, 0.03, 0.1], True),
        ([1, 2, 5, 10], True),
        ([10, 20, 40], True),
        ([10, 20, 30], False),
        ([20, 26, 32, 40], False),
        ([10, 11.25, 12.5, 15, 20, 40, 60], False),
        ([0, 1, 10], False),
        ([1, 10], False),
    ],
)
def test_points_as_people_write_them_are_seen_to_be_logarithmic(values, logarithmic):
    assert is_logarithmic(np.array(values, dtype=float)) is logarithmic


@pytest.mark.parametrize("size", [2.5, 6.0])
def test_symbols_have_the_size_that_is_asked_for(swept, size):
    ax = cc.plot.diagram(swept, size=size)
    assert np.sqrt(ax.collections[0].get_sizes()[0]) == pytest.approx(size)
