"""What pictures look like: the house's style, the user's, and where they appear."""

from __future__ import annotations

import os
import subprocess
import sys

import matplotlib as mpl
import matplotlib.style
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import cellcrawl as cc
from tests.conftest import settings
from tests.runs import circling

RUN = circling(0.3, records=61)


def test_users_settings_win_over_the_house_and_are_left_as_they_were():
    before = settings()
    with mpl.rc_context({"font.size": 15.0, "axes.linewidth": 3.0}):
        figure = cc.plot.time_series(RUN, ["speed"])
    axes = figure.axes[0]
    assert axes.xaxis.label.get_size() == pytest.approx(15.0)
    assert axes.spines["left"].get_linewidth() == 3.0
    assert settings() == before


def test_ticks_made_after_the_users_settings_are_gone_keep_them():
    with mpl.rc_context({"font.size": 15.0}):
        figure = cc.plot.time_series(RUN, ["speed"])
    figure.axes[0].set_xlim(0.0, 60.0)
    figure.canvas.draw()
    sizes = [tick.label1.get_size() for tick in figure.axes[0].xaxis.get_major_ticks()]
    assert sizes == pytest.approx([14.0] * len(sizes))  # of 7.5 and 7.0, both doubled


def test_width_font_size_colour_map_and_settings_hold_for_all_pictures_within():
    with cc.plot.styled({"lines.linewidth": 3.0}, width=5.0, font_size=15.0, colormap="magma"):
        drawn = [cc.plot.kymograph(RUN).figure, cc.plot.summary(RUN), cc.plot.time_series(RUN)]
        path = cc.plot.path(RUN)
    for figure in drawn:
        assert figure.get_figwidth() == 5.0
        assert max(ax.yaxis.label.get_size() for ax in figure.axes) == pytest.approx(15.0)
    assert drawn[0].axes[0].images[0].get_cmap().name == "magma"
    assert path.collections[-1].get_cmap().name == "magma"
    assert drawn[2].axes[0].lines[0].get_linewidth() == 3.0
    assert cc.plot.kymograph(RUN).figure.get_figwidth() == 3.4


def test_a_colour_map_given_to_a_picture_wins():
    with cc.plot.styled(colormap="magma"):
        ax = cc.plot.kymograph(RUN, colormap="cividis")
    assert ax.images[0].get_cmap().name == "cividis"


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"colormap": "vridis"}, "did you mean 'viridis'"),
        ({"colormap": 3}, "colormap must be text, not 3"),
        ({"width": 0.1}, "width = 0.1 is out of range"),
        ({"font_size": "big"}, "font_size must be a number, not 'big'"),
        ({"rc": {"font.sise": 3}}, "did you mean 'font.size'"),
        ({"rc": {"font.size": "vast"}}, "font.size = 'vast'"),
        ({"rc": 7}, "rc must be a table"),
    ],
)
def test_looks_that_do_not_exist_are_refused_in_one_line(options, said):
    with pytest.raises(cc.InputError, match=said) as error, cc.plot.styled(**options):
        pass
    assert "\n" not in str(error.value)


def test_nothing_of_ours_is_dark_on_a_dark_background():
    with matplotlib.style.context("dark_background"):
        figure = cc.plot.snapshots(RUN, [0.0, 3.0])
        ax = figure.axes[0]
        ours = Figure()
        given = cc.plot.path(RUN, ax=ours.add_subplot())
    bar = next(child for child in ax.get_children() if hasattr(child, "size_bar"))
    dots = [mpl.colors.to_rgb(line.get_color()) for line in ax.lines]
    texts = [mpl.colors.to_rgb(t.get_color()) for t in (ax.title, *given.texts)]
    assert bar.size_bar.get_children()[0].get_edgecolor()[0] > 0.6
    assert all(sum(colour) > 1.2 for colour in dots + texts)
    assert sum(mpl.colors.to_rgb(ax.patches[0].get_facecolor() if ax.patches else "k")) < 1.5


def test_panels_given_keep_their_shape_and_show_the_whole_path():
    figure = Figure(figsize=(6.0, 2.0), layout="constrained")
    FigureCanvasAgg(figure)
    panels = figure.add_subfigure(figure.add_gridspec(1, 1)[0]).subplots(1, 2)
    shapes = [RUN, RUN.assign(x=3.0 * RUN["x"], centroid_x=3.0 * RUN["centroid_x"])]
    for panel, run in zip(panels, shapes, strict=True):
        cc.plot.path(run, ax=panel, colorbar=False)
    for size in ((6.0, 2.0), (3.0, 5.0)):
        figure.set_size_inches(size)
        figure.canvas.draw()
        boxes = [panel.get_window_extent() for panel in panels]
        assert boxes[0].height == pytest.approx(boxes[1].height)
        assert boxes[0].y0 == pytest.approx(boxes[1].y0)
        for panel, run in zip(panels, shapes, strict=True):
            (low, high), (bottom, top) = panel.get_xlim(), panel.get_ylim()
            box = panel.get_window_extent()
            assert (high - low) / box.width == pytest.approx((top - bottom) / box.height)
            assert low < run["x"].values.min()
            assert top > run["y"].values.max()


def test_several_paths_are_at_one_scale():
    small = RUN.assign(x=RUN["x"] * 1.0)
    figure = cc.plot.paths({"long": circling(0.05, radius=20.0), "short": small})
    figure.canvas.draw()
    scales = [
        panel.get_window_extent().width / np.ptp(panel.get_xlim()) for panel in figure.axes[:2]
    ]
    assert scales[0] == pytest.approx(scales[1], rel=1e-3)
    assert [panel.get_title() for panel in figure.axes[:2]] == ["long", "short"]


@pytest.mark.parametrize("size", [(4.0, 6.0), (9.0, 3.5)])
def test_the_summary_follows_its_size(size):
    figure = cc.plot.summary(RUN)
    figure.set_size_inches(size)
    figure.canvas.draw()
    renderer, page = figure.canvas.get_renderer(), figure.bbox
    for axes in figure.axes:
        box = axes.get_tightbbox(renderer)
        assert page.x0 <= box.x0 < box.x1 <= page.x1
        assert page.y0 <= box.y0 < box.y1 <= page.y1


def test_path_and_kymograph_of_the_summary_share_the_scale_of_their_bar():
    run = RUN.copy()
    field = RUN["bound_fraction"].values.copy()
    field[7] = 0.95  # between two contours
    run["bound_fraction"] = RUN["bound_fraction"].copy(data=field)
    figure = cc.plot.summary(run)
    edge, image = figure.axes[0].collections[-1], figure.axes[1].images[0]
    assert (edge.norm.vmin, edge.norm.vmax) == (image.norm.vmin, image.norm.vmax) == (0.0, 1.0)


def test_the_title_tells_of_a_schedule():
    import json

    run = RUN.assign_attrs(
        parameters=json.dumps(cc.Parameters(r_on=16, zeta_1=580).to_dict()),
        schedule=json.dumps(cc.Schedule({"r_on": [(2.0, 16.0), (2.0, 30.0)]}).to_dict()),
    )
    title = cc.plot.summary(run).get_suptitle()
    assert r"$r_\mathrm{on}$ = 16 $\to$ 30" in title
    assert r"$\zeta_1$ = 580" in title


def test_kymographs_can_share_a_figure_without_bars():
    figure = Figure()
    panels = figure.subplots(2, 2)
    cc.plot.kymographs(RUN, axes=panels, colorbar=False, limits={"off_rate": (10.0, 90.0)})
    assert len(figure.axes) == 4
    assert panels[0, 1].images[0].norm.vmax == 90.0


@pytest.mark.parametrize(
    "draw",
    [
        lambda axes: cc.plot.kymographs(RUN, axes=axes),
        lambda axes: cc.plot.snapshots(RUN, [0.0, 1.0, 2.0, 3.0], axes=axes),
        lambda axes: cc.plot.time_series(RUN, ["speed", "area", "length", "tension"], axes=axes),
    ],
)
def test_arrays_of_axes_are_taken_and_others_refused(draw):
    figure = Figure()
    draw(figure.subplots(2, 2))
    for wrong in (figure.subplots(1, 2), figure, 3, [1, 2, 3, 4], "abcd", figure.add_subplot()):
        with pytest.raises(cc.InputError, match="axes"):
            draw(wrong)


@pytest.mark.parametrize("wrong", [3, "ax", Figure(), [1]])
def test_axes_of_a_wrong_kind_are_refused(wrong):
    for draw in (cc.plot.path, cc.plot.cell, cc.plot.kymograph):
        with pytest.raises(cc.InputError, match="ax must be matplotlib's Axes"):
            draw(RUN, ax=wrong)


@pytest.mark.parametrize("projection", ["polar", "3d"])
def test_axes_of_other_coordinates_are_refused(projection):
    with pytest.raises(cc.InputError, match=f"not {projection} ones"):
        cc.plot.path(RUN, ax=Figure().add_subplot(projection=projection))


def test_pictures_show_themselves_in_a_notebook():
    for drawn in (cc.plot.path(RUN), cc.plot.time_series(RUN)):
        assert drawn._repr_png_()[:8] == b"\x89PNG\r\n\x1a\n"
    with pytest.raises(NotImplementedError):  # so that the notebook goes on to the picture
        cc.plot.time_series(RUN)._ipython_display_()


def test_pyplot_knows_the_figures_once_it_is_loaded_and_shows_them_once():
    code = (
        "import matplotlib; matplotlib.use('agg')\n"
        "import matplotlib.pyplot as plt, cellcrawl as cc\n"
        "from tests.runs import circling\n"
        "run = circling(0.3, records=11)\n"
        "ax = cc.plot.path(run)\n"
        "assert plt.gcf() is ax.figure and plt.gca() is ax\n"
        "figure = cc.plot.summary(run)\n"
        "assert plt.get_fignums() == [1, 2]\n"
        "assert figure._repr_png_(), 'agg shows nothing itself'\n"
        "plt.ion()\n"
        "assert figure._repr_png_() is None and ax._repr_png_() is None\n"
        "plt.close('all')\n"
        "assert figure._repr_png_() and ax._repr_png_()\n"
    )
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code],
        check=False,
        capture_output=True,
        text=True,
        env={**os.environ, "MPLBACKEND": "agg"},
    )
    assert done.returncode == 0, done.stderr
