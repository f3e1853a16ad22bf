"""Every picture: what it returns, its labels, its images, and what it leaves untouched."""

from __future__ import annotations

import io
import subprocess
import sys

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

import cellcrawl as cc
from tests.conftest import settings
from tests.runs import circle_on_track, circling, straight

RUN = circling(0.3, records=101)
ON_ONE_AXES = {
    "path": lambda **options: cc.plot.path(RUN, **options),
    "cell": lambda **options: cc.plot.cell(RUN, 3.0, **options),
    "kymograph": lambda **options: cc.plot.kymograph(RUN, "off_rate", **options),
}
PAGES = {
    "kymographs": lambda: cc.plot.kymographs(RUN),
    "snapshots": lambda: cc.plot.snapshots(RUN, [0.0, 5.0, 10.0]),
    "time_series": lambda: cc.plot.time_series(RUN),
    "summary": lambda: cc.plot.summary(RUN),
}


def png(figure: Figure) -> bytes:
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=60)
    return file.getvalue()


@pytest.mark.parametrize("name", ON_ONE_AXES)
def test_pictures_on_one_axes_draw_on_the_axes_given(name):
    figure = Figure()
    ax = figure.add_subplot()
    assert ON_ONE_AXES[name](ax=ax) is ax
    assert png(figure)


def drawn(name: str) -> Figure:
    if name in PAGES:
        return PAGES[name]()
    ax = ON_ONE_AXES[name]()
    assert isinstance(ax, Axes)
    return ax.figure


@pytest.mark.parametrize("name", [*ON_ONE_AXES, *PAGES])
def test_pictures_are_figures_of_their_own_and_leave_the_users_settings(name):
    before = settings()
    figure = drawn(name)
    assert isinstance(figure, Figure)
    for suffix in ("pdf", "svg"):
        figure.savefig(io.BytesIO(), format=suffix)
    assert settings() == before


@pytest.mark.parametrize("name", ["kymographs", "snapshots"])
def test_settings_made_after_a_page_do_not_change_it(name):
    plain, page = png(PAGES[name]()), PAGES[name]()
    with mpl.rc_context({"font.size": 25.0, "lines.linewidth": 9.0, "xtick.labelsize": 30.0}):
        assert png(page) == plain


def test_pyplot_is_never_imported():
    code = (
        "import sys; from tests.runs import straight; import cellcrawl as cc;"
        "cc.plot.summary(straight()).savefig('/dev/null', format='png');"
        "sys.exit('matplotlib.pyplot' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_axes_carry_symbol_and_unit():
    ax = cc.plot.kymograph(RUN, "off_rate")
    assert ax.get_xlabel() == r"time $t$ ($1/k_\mathrm{off}^0$)"
    assert "s/L" in ax.get_ylabel()
    labels = [panel.get_ylabel() for panel in ax.figure.axes]
    assert any("$r$" in label and "k_" in label for label in labels)
    cell = cc.plot.cell(RUN)
    assert (cell.get_xlabel(), cell.get_ylabel()) == ("$x$ ($R_0$)", "$y$ ($R_0$)")
    series = cc.plot.time_series(RUN).axes
    assert all(panel.get_ylabel() for panel in series)
    assert series[-1].get_xlabel().startswith("time")


def test_kymographs_have_one_image_a_panel_and_its_orientation():
    figure = cc.plot.kymographs(RUN, origin="front")
    assert [len(panel.images) for panel in figure.axes[:4]] == [1, 1, 1, 1]
    image = figure.axes[0].images[0]
    shown = cc.observables.kymograph(RUN, "bound_fraction", origin="front")
    np.testing.assert_array_equal(image.get_array(), shown.values.T)
    low, high = image.get_extent()[2:]
    assert (low + high) / 2.0 == pytest.approx(shown["arclength"].values.mean())
    assert image.origin == "lower"


def test_a_last_record_off_the_grid_does_not_stretch_the_kymograph():
    run = straight(records=11)
    run = run.assign_coords(time=np.append(np.arange(10.0), 9.25))
    run["off_rate"][:] = run["time"].values[:, None] * np.ones(run.sizes["node"])
    image = cc.plot.kymograph(run, "off_rate", origin="material").images[0]
    np.testing.assert_allclose(image.get_array()[0], np.linspace(0.0, 9.25, 11))


def test_shapes_keep_their_aspect():
    for ax in (cc.plot.path(RUN), cc.plot.cell(RUN), cc.plot.snapshots(RUN, [1.0]).axes[0]):
        assert ax.get_aspect() == 1.0


def test_a_field_has_one_colour_scale_in_every_picture():
    path = next(c for c in cc.plot.path(RUN).collections if isinstance(c, LineCollection))
    image = cc.plot.kymograph(RUN, "bound_fraction").images[0]
    page = cc.plot.kymographs(RUN).axes[0].images[0]
    for shown in (path, page):
        assert shown.get_cmap().name == image.get_cmap().name
        assert (shown.norm.vmin, shown.norm.vmax) == (image.norm.vmin, image.norm.vmax)


def test_corners_do_not_drown_the_curvature():
    run = straight(records=50).copy(deep=True)
    run["curvature"][20, 3] = 1e4
    ax = cc.plot.kymograph(run, "curvature", origin="material")
    norm = ax.images[0].norm
    assert norm.vmax == -norm.vmin <= 100.0
    assert norm(1.0) - norm(0.0) > 0.2
    assert ax.images[0].colorbar.extend == "max"


def test_given_limits_are_taken():
    ax = cc.plot.kymograph(RUN, "bound_fraction", limits=(0.4, 0.6))
    assert (ax.images[0].norm.vmin, ax.images[0].norm.vmax) == (0.4, 0.6)
    assert ax.images[0].colorbar.extend == "both"


def test_a_cell_that_never_moves_and_a_single_record_can_be_drawn():
    still = circle_on_track(np.arange(3.0), lambda t: ((0.0, 0.0), (0.0, 0.0)))
    for run in (still, RUN.isel(time=[0])):
        assert png(cc.plot.summary(run))


def test_panels_of_the_summary_share_their_sides_and_their_labels_stay_clear():
    run = RUN.copy()
    values = 1240.45 + 0.02 * np.sin(run["time"].values)  # long tick labels
    run["tension"] = run["tension"].copy(data=values)
    figure = cc.plot.summary(run)
    png(figure)
    path, top, _, *series = figure.axes
    for panel in series:
        assert panel.get_position().intervalx == pytest.approx(top.get_position().intervalx)
    renderer = figure.canvas.get_renderer()
    page = figure.bbox
    assert path.get_window_extent().x1 < min(
        panel.yaxis.get_tightbbox(renderer).x0 for panel in series
    )
    for axes in figure.axes:
        box = axes.get_tightbbox(renderer)
        assert page.x0 <= box.x0
        assert box.x1 <= page.x1
        assert page.y0 <= box.y0
        assert box.y1 <= page.y1


@pytest.mark.parametrize(
    ("draw", "said"),
    [
        (lambda: cc.plot.path(RUN, field="n"), "no field 'n' on the edge"),
        (lambda: cc.plot.path(RUN, every=0), "every = 0 is out of range"),
        (lambda: cc.plot.path(RUN, every=1e-9), "more than 1000 contours"),
        (lambda: cc.plot.path(RUN.isel(time=[])), "no records"),
        (lambda: cc.plot.path(RUN.drop_vars("x")), "no 'x'"),
        (lambda: cc.plot.cell(RUN, 11.0), "outside the run, which goes from 0 to 10"),
        (lambda: cc.plot.cell(RUN, float("nan")), "time = nan"),
        (lambda: cc.plot.cell(RUN, limits=(1, 0)), "must be below"),
        (lambda: cc.plot.cell(RUN, field="off_rate", limits=(0, 9)), "logarithmic"),
        (lambda: cc.plot.snapshots(RUN, []), "times is empty"),
        (lambda: cc.plot.snapshots(RUN, [-1.0]), "outside the run"),
        (lambda: cc.plot.kymograph(RUN, "frction"), "did you mean 'friction'"),
        (lambda: cc.plot.kymographs(RUN, origin="rear"), "must be one of 'front', 'material'"),
        (lambda: cc.plot.time_series(RUN, ["tensoin"]), "did you mean 'tension'"),
        (lambda: cc.plot.time_series(RUN, []), "quantities is empty"),
        (lambda: cc.plot.summary(7), "dataset must be xarray.s Dataset, not 7"),
    ],
)
def test_mistakes_are_refused_in_one_line(draw, said):
    with pytest.raises(cc.InputError, match=said) as error:
        draw()
    assert "\n" not in str(error.value)
