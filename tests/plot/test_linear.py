"""Dispersion relations and stability diagrams."""

from __future__ import annotations

import io
import math

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.patches import PathPatch
from matplotlib.path import Path

import cellcrawl as cc
from cellcrawl.plot.regions import region

P = cc.Parameters()
PLANE = {"r_on": np.linspace(5, 70, 30), "zeta_1": np.linspace(400, 640, 30)}
UNIT = (0.0, 2.0, 0.0, 1.0)


def png(figure: Figure) -> bytes:
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=60)
    return file.getvalue()


def marked(ax, marker):
    return [
        (float(line.get_xdata()[0]), float(line.get_ydata()[0]))
        for line in ax.lines
        if line.get_marker() == marker
    ]


def test_both_roots_are_drawn_and_meet_where_the_pair_is_born():
    figure = cc.plot.dispersion(P)
    real, imaginary = figure.axes
    solid, dashed = (
        [
            line
            for line in real.lines
            if line.get_linestyle() == style and line.get_marker() == "None"
        ]
        for style in ("-", "--")
    )
    larger, smaller = solid[0].get_xydata(), dashed[0].get_xydata()
    (onset,) = [point for point in marked(real, "o") if point[0] < 20]
    assert 7 < onset[0] < 8
    met = smaller[np.isfinite(smaller[:, 1])][-1]
    assert met == pytest.approx(onset, rel=1e-6)
    assert larger[larger[:, 0] == onset[0]][0] == pytest.approx(onset)
    assert larger[0] == pytest.approx([1.0, 12.74], abs=5e-3)
    assert marked(real, "D") == [(pytest.approx(15.28, abs=0.01), 0.0)]
    assert marked(imaginary, "D")[0][1] > 9.0
    assert real.get_xlabel() == ""
    assert "wavenumber" in imaginary.get_xlabel()
    assert png(figure)


@pytest.mark.parametrize(
    "family",
    [
        {"zeta_1": [300, 400, 500, 600, 700]},
        {"r_on": [5, 20, 60]},
        {"D": [0.001, 1.0]},
        {"sigma_c": [0, 1000]},
        {"h": [0.0]},
    ],
)
def test_any_family_can_be_drawn(family):
    figure = cc.plot.dispersion(P, **family)
    real = figure.axes[0]
    (values,) = family.values()
    assert len(real.get_legend().get_texts()) == len(values)
    colours = {line.get_color().tobytes() for line in real.lines if line.get_marker() == "."}
    assert len(colours) == len(values)
    assert png(figure)


def test_dispersion_draws_on_the_axes_given_and_leaves_the_settings():
    before = dict(mpl.rcParams)
    mine = Figure()
    axes = mine.subplots(2, 1)
    assert cc.plot.dispersion(P, axes=axes, k_max=12, zeta_1=[500, 600]) is mine
    assert axes[0].get_xlim() == (0.0, 12.0)
    ax = Figure().add_subplot()
    assert cc.plot.stability(cc.linear.stability_map(P, **PLANE), ax=ax) is ax
    assert dict(mpl.rcParams) == before


def test_shades_are_the_regions_of_instability_from_light_to_dark():
    stability = cc.linear.stability_map(P, **PLANE)
    ax = cc.plot.stability(stability)
    patches = [patch for patch in ax.patches if isinstance(patch, PathPatch)]
    assert len(patches) == 5
    light = [sum(patch.get_facecolor()[:3]) for patch in patches]
    assert light == sorted(light, reverse=True)
    assert [patch.get_zorder() for patch in patches] == sorted(p.get_zorder() for p in patches)
    assert max(patch.get_zorder() for patch in patches) < 2.0
    rng = np.random.default_rng(1)
    for k, patch in zip(stability.k.values, patches, strict=True):
        for r_on, zeta_1 in zip(rng.uniform(6, 69, 40), rng.uniform(401, 639, 40), strict=True):
            rate = cc.linear.growth_rates(P.replace(r_on=r_on, zeta_1=zeta_1), k)[0].real
            inside = patch.get_path().contains_point((r_on, zeta_1))
            if abs(rate) > 0.05:
                assert inside == (rate > 0.0)
    (keys,) = [child for child in ax.get_children() if isinstance(child, Legend)]
    named = [text.get_text() for text in keys.get_texts()]
    assert named[1:] == ["1", "2", "5", "10", "15"]
    assert (ax.get_xlim(), ax.get_ylim()) == ((5.0, 70.0), (400.0, 640.0))
    assert png(ax.figure)


def test_all_or_nothing_unstable_is_the_whole_box_or_no_patch():
    whole = cc.linear.stability_map(P, k=2, r_on=[24, 26], zeta_1=[590, 600])
    none = cc.linear.stability_map(P, k=2, r_on=[24, 26], zeta_1=[0, 10])
    (patch,) = cc.plot.stability(whole).patches
    assert patch.get_path().contains_point((25, 595))
    assert not cc.plot.stability(none).patches


def circle(x, y, radius, way=1):
    angle = way * np.linspace(0, 2 * math.pi, 50)
    curve = np.column_stack([x + radius * np.cos(angle), y + radius * np.sin(angle)])
    curve[-1] = curve[0]
    return curve


def inside(path, x, y):
    """Non-zero winding, as pictures are filled."""
    return sum(
        Path(loop).contains_point((x, y)) * np.sign(_area(loop)) for loop in path.to_polygons()
    )


def _area(loop):
    x, y = loop.T
    return np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])


def test_regions_of_closed_and_open_curves():
    island = region([circle(1, 0.5, 0.3)], UNIT, corner_inside=False)
    assert inside(island, 1, 0.5)
    assert not inside(island, 0.1, 0.1)
    lake = region([circle(1, 0.5, 0.3, way=-1)], UNIT, corner_inside=True)
    assert not inside(lake, 1, 0.5)
    assert inside(lake, 0.1, 0.1)
    bands = [np.array([[x, y], [x, 1.0 - y]]) for x, y in ((0.5, 1.0), (1.0, 0.0), (1.5, 1.0))]
    striped = region(bands, UNIT, corner_inside=False)
    found = [bool(inside(striped, x, 0.5)) for x in (0.25, 0.75, 1.25, 1.75)]
    assert found == [False, True, False, True]
    corner = region([np.array([[0.5, 0.0], [0.0, 0.5]])], UNIT, corner_inside=True)
    assert inside(corner, 0.1, 0.1)
    assert not inside(corner, 1.5, 0.8)
    rest = region([np.array([[0.0, 0.5], [0.5, 0.0]])], UNIT, corner_inside=False)
    assert not inside(rest, 0.1, 0.1)
    assert inside(rest, 1.5, 0.8)
    assert region([], UNIT, corner_inside=False) is None


@pytest.mark.parametrize(
    ("draw", "said"),
    [
        (lambda: cc.plot.dispersion(P, zeta1=[1]), "did you mean 'zeta_1'"),
        (lambda: cc.plot.dispersion(P, zeta_1=[1], D=[1]), "one parameter, not 2"),
        (lambda: cc.plot.dispersion(P, zeta_1=range(20)), "1 to 12 values"),
        (lambda: cc.plot.dispersion(P, zeta_1=[3000]), "from 0 to 2000"),
        (lambda: cc.plot.dispersion(P, k_max=1), "k_max = 1"),
        (lambda: cc.plot.stability(P), "stability_map must be xarray.s Dataset"),
    ],
)
def test_mistakes_are_one_line(draw, said):
    with pytest.raises(cc.InputError, match=said) as error:
        draw()
    assert "\n" not in str(error.value)
