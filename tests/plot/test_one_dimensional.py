"""Pictures of the cell on a line and of the flat edge."""

from __future__ import annotations

import io

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

import cellcrawl as cc
from cellcrawl.plot.two_edges import REGIME_COLOURS

od = cc.one_dimensional
P = cc.Parameters(r_on=25, zeta_1=600)


@pytest.fixture(scope="module")
def edges():
    return od.simulate_two_edges(P, 2.0, save_every=0.05)


@pytest.fixture(scope="module")
def flat():
    return od.simulate_flat_edge(P, 0.2, nodes=64, save_every=0.02, rtol=1e-3)


@pytest.fixture(scope="module")
def diagram():
    return od.phase_diagram(P, r_on=[10, 25, 60], zeta_1=[400, 600, 800], t_end=30.0)


def png(figure: Figure) -> bytes:
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=60)
    return file.getvalue()


def test_both_edges_and_the_tension_are_drawn_as_they_are(edges):
    figure = cc.plot.two_edges(edges)
    place, linked, pulled = figure.axes
    front, rear = place.lines
    np.testing.assert_array_equal(front.get_ydata(), edges.position.sel(edge="front"))
    np.testing.assert_array_equal(rear.get_ydata(), edges.position.sel(edge="rear"))
    assert [text.get_text() for text in linked.get_legend().get_texts()] == ["front", "rear"]
    np.testing.assert_array_equal(pulled.lines[0].get_ydata(), edges.tension)
    assert png(figure)


def test_a_part_of_a_run_is_drawn_on_the_axes_given_and_leaves_the_settings(edges):
    before = dict(mpl.rcParams)
    mine = Figure()
    axes = mine.subplots(3, 1)
    assert cc.plot.two_edges(edges.sel(time=slice(1.0, 2.0)), axes=axes) is mine
    assert axes[0].get_xlim() == pytest.approx((1.0, 2.0))
    assert dict(mpl.rcParams) == before


def test_each_cell_of_a_diagram_has_the_colour_of_its_regime(diagram):
    figure = cc.plot.regimes(diagram)
    assert len(figure.axes) == 3
    png(figure)
    for ax, start in zip(figure.axes, diagram.start.values, strict=True):
        (mesh,) = ax.collections
        faces = mesh.get_facecolor().reshape(3, 3, 4)
        for i, r_on in enumerate(diagram.r_on.values):
            for j, zeta_1 in enumerate(diagram.zeta_1.values):
                code = int(diagram.regime.sel(start=start, r_on=r_on, zeta_1=zeta_1))
                assert tuple(faces[j, i]) == pytest.approx(
                    to_rgba(REGIME_COLOURS[od.REGIMES[code]])
                )
    assert len(set(diagram.regime.values.ravel())) >= 3


def test_lines_of_theory_can_be_left_out_and_one_start_drawn(diagram):
    bare = cc.plot.regimes(diagram, lines=False)
    assert not [line for line in bare.axes[0].lines if line.get_marker() != "."]
    lined = cc.plot.regimes(diagram.sel(start=["large"]))
    (ax,) = lined.axes
    assert len([line for line in ax.lines if line.get_marker() != "."]) >= 3
    assert png(lined)


@pytest.mark.parametrize(
    "field", ["bound_fraction", "off_rate", "friction", "curvature", "velocity"]
)
def test_a_kymograph_holds_the_field_over_time_and_place(flat, field):
    ax = cc.plot.flat_edge(flat, field)
    (image,) = ax.images
    np.testing.assert_array_equal(image.get_array(), flat[field].values.T)
    assert ax.get_xlim() == pytest.approx((0.0, 0.2))
    assert png(ax.figure)


def test_mistakes_are_one_line(edges, flat):
    for make, said in (
        (lambda: cc.plot.two_edges(flat), "no run of two edges"),
        (lambda: cc.plot.two_edges(edges.isel(time=slice(0))), "no records"),
        (lambda: cc.plot.flat_edge(edges), "no run of a flat edge"),
        (lambda: cc.plot.flat_edge(flat, "n"), "field = 'n'"),
        (lambda: cc.plot.flat_edge(flat.isel(time=slice(1))), "fewer than two records"),
        (lambda: cc.plot.flat_edge(flat.isel(time=[0, 1, 5])), "even times"),
        (lambda: cc.plot.regimes(edges), "no phase diagram"),
    ):
        with pytest.raises(cc.InputError, match=said) as mistake:
            make()
        assert "\n" not in str(mistake.value)
