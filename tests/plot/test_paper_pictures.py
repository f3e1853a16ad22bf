"""Pictures of one period, of growth beside theory, and of several runs together."""

from __future__ import annotations

import io

import numpy as np
import pytest
from matplotlib.figure import Figure

import cellcrawl as cc
from tests.runs import circling, straight

RUN = circling(0.3, records=101)  # t = 0 to 10


@pytest.fixture(scope="module")
def short_run():
    start = cc.RandomPerturbation(seed=1, amplitude=1e-6)
    return cc.simulate(cc.Parameters(r_on=25), 0.2, save_every=0.02, start=start)


def png(figure: Figure) -> bytes:
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=50)
    return file.getvalue()


def test_a_cycle_marks_the_times_of_its_cells():
    figure = cc.plot.cycle(RUN, 2.0, 4.0, shapes=4)
    above, below = figure.axes[:2]
    curve, dots = above.lines
    np.testing.assert_allclose(curve.get_xdata()[[0, -1]], [2.0, 6.0])
    np.testing.assert_allclose(dots.get_xdata(), [2.5, 3.5, 4.5, 5.5])
    np.testing.assert_allclose(dots.get_ydata(), 900.0 + dots.get_xdata())
    edges = [part for part in below.collections if len(part.get_segments()) == 64]
    middles = [np.mean([piece[1] for piece in edge.get_segments()], axis=0) for edge in edges]
    assert np.all(np.diff([middle[0] for middle in middles]) > 2.0)  # unit circles, side by side
    assert png(figure)


def test_a_cycle_draws_on_the_axes_given():
    figure = Figure(layout="constrained")
    axes = figure.subplots(2, 1).tolist()
    assert cc.plot.cycle(RUN, 2.0, 4.0, axes=axes) is figure


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ((8.0, 4.0), "outside the run"),
        ((2.0, 0.3), "too few records"),
        ((2.0, -1.0), "duration"),
    ],
)
def test_a_cycle_outside_the_run_is_refused(arguments, says):
    with pytest.raises(cc.InputError, match=says):
        cc.plot.cycle(RUN, *arguments)


def test_growth_draws_each_wave_beside_its_theory(short_run):
    ax = cc.plot.growth(short_run, [1, 2, 5])
    simulated, theory = ax.lines[0::2], ax.lines[1::2]
    assert len(simulated) == len(theory) == 3
    for line, dashed in zip(simulated, theory, strict=True):
        np.testing.assert_allclose(line.get_ydata(), dashed.get_ydata(), rtol=0.02)
    assert cc.plot.growth(short_run, [3], field="radius", ax=ax) is ax
    assert png(ax.figure)


def test_growth_refuses_what_has_no_linear_theory(short_run):
    with pytest.raises(cc.InputError, match="field"):
        cc.plot.growth(short_run, field="off_rate")
    with pytest.raises(cc.InputError, match="from 1"):
        cc.plot.growth(short_run, [0, 1])
    changing = cc.simulate(cc.Parameters(), 0.1, schedule=cc.Schedule({"D": [(0.05, 0.1)]}))
    with pytest.raises(cc.InputError, match="parameters of this run change"):
        cc.plot.growth(changing)


def test_runs_by_name_share_their_axes_and_a_legend():
    longer = straight(records=21)
    figure = cc.plot.time_series({"one": RUN, "other": longer}, ["tension", "speed"])
    top, bottom = figure.axes
    assert [text.get_text() for text in top.get_legend().get_texts()] == ["one", "other"]
    assert bottom.get_legend() is None
    assert top.get_xlim() == (0.0, 20.0)
    assert top.lines[0].get_color() is not top.lines[1].get_color()
    with pytest.raises(cc.InputError, match="no runs"):
        cc.plot.time_series({})
    with pytest.raises(cc.InputError, match="1 axes for 2"):
        cc.plot.time_series(RUN, ["tension", "speed"], axes=[top])


def test_pages_draw_on_axes_given():
    figure = Figure(layout="constrained")
    axes = figure.subplots(1, 7).ravel().tolist()
    assert cc.plot.snapshots(RUN, [0.0, 5.0, 10.0], axes=axes[:3]) is figure
    assert cc.plot.kymographs(RUN, axes=axes[3:]) is figure
    with pytest.raises(cc.InputError, match="2 axes for 1: one for each time"):
        cc.plot.snapshots(RUN, [1.0], axes=axes[:2])
    with pytest.raises(cc.InputError, match="3 axes for 4: one for each field"):
        cc.plot.kymographs(RUN, axes=axes[:3])


def test_times_along_a_path_stand_apart():
    slow = straight((0.1, 0.0), records=41)  # 4 long: a contour each 0.1
    ax = cc.plot.path(slow, every=1.0, times=True)
    places = [text.get_position()[0] for text in ax.texts if text.get_text().isdigit()]
    assert len(places) > 5
    assert np.all(np.diff(places) > 0.4)
