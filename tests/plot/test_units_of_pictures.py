"""Pictures and observables of a run in SI: the same cell, with its own units."""

from __future__ import annotations

import json

import numpy as np
import pytest
from matplotlib.colors import LogNorm, SymLogNorm

import cellcrawl as cc
from tests.runs import circling

RUN = circling(0.3, records=61).assign_attrs(
    parameters=json.dumps(cc.Parameters().to_dict()), schedule="{}"
)
SI = cc.Scales().dataset(RUN)  # 10 um, 10 s


def test_observables_say_their_units():
    speed = cc.observables.speed(SI)
    assert speed.attrs["units"] == "m/s"
    np.testing.assert_allclose(speed, 1e-6 * cc.observables.speed(RUN))
    assert cc.observables.centroid_velocity(SI).attrs["units"] == "m/s"
    assert cc.observables.turning_rate(SI).attrs["units"] == "rad/s"
    squares = cc.observables.mean_squared_displacement(SI)
    assert (squares.attrs["units"], squares["lag"].attrs["units"]) == ("m^2", "s")
    assert cc.observables.turning_events(SI)["time"].attrs["units"] == "s"
    assert cc.observables.kymograph(SI, "curvature").attrs["units"] == "1/m"
    assert cc.observables.speed(RUN).attrs["units"] == "R_0 k_off0"


def test_observables_do_not_depend_on_the_units():
    for name in ("heading", "circularity", "front_position", "aspect_ratio"):
        measure = getattr(cc.observables, name)
        np.testing.assert_allclose(measure(SI), measure(RUN), rtol=1e-9, atol=1e-9)
    assert cc.classify(SI).mode == cc.classify(RUN).mode


def texts(figure):
    labels = [ax.get_xlabel() + ax.get_ylabel() for ax in figure.axes]
    written = [t.get_text() for ax in figure.axes for t in (ax.title, *ax.texts)]
    bars = [
        child.txt_label.get_text()
        for ax in figure.axes
        for child in ax.get_children()
        if hasattr(child, "size_bar")
    ]
    return " ".join([*labels, *written, *bars, figure.get_suptitle()])


@pytest.mark.parametrize(
    "draw",
    [
        lambda run: cc.plot.summary(run),
        lambda run: cc.plot.path(run).figure,
        lambda run: cc.plot.cell(run).figure,
        lambda run: cc.plot.snapshots(run, [float(run["time"][0]), float(run["time"][9])]),
        lambda run: cc.plot.kymographs(run),
        lambda run: cc.plot.time_series(run),
        lambda run: cc.plot.cycle(run, float(run["time"][5]), 30 * float(run["time"][1])),
    ],
)
def test_pictures_write_the_units_of_the_data(draw):
    figure = draw(SI)
    figure.canvas.draw()
    written = texts(figure)
    assert "k_" not in written
    assert "R_0" not in written
    assert "R_0" in (plain := texts(draw(RUN))) or "k_" in plain


def test_the_picture_of_a_run_in_si_is_the_same_drawing_at_another_scale():
    plain, si = cc.plot.path(RUN), cc.plot.path(SI)
    np.testing.assert_allclose(si.get_xlim(), 10.0 * np.array(plain.get_xlim()))
    assert len(si.collections) == len(plain.collections)
    bars = [
        next(
            child.txt_label.get_text() for child in ax.get_children() if hasattr(child, "size_bar")
        )
        for ax in (plain, si)
    ]
    assert bars == ["1 $R_0$", "10 µm"]
    assert r"$\Delta t$ = " in si.texts[-1].get_text()
    assert si.texts[-1].get_text().endswith(" s")


def test_colour_scales_of_the_model_follow_its_scales():
    limits = {}
    for name, run in (("plain", RUN), ("si", SI)):
        for field in ("off_rate", "curvature", "bound_fraction"):
            norm = cc.plot.kymograph(run, field).images[0].norm
            limits[name, field] = np.array([norm.vmin, norm.vmax])
            if field == "curvature":
                assert isinstance(norm, SymLogNorm)
                limits[name, "linear"] = norm.linthresh
            if field == "off_rate":
                assert isinstance(norm, LogNorm)
    np.testing.assert_allclose(limits["si", "off_rate"], 0.1 * limits["plain", "off_rate"])  # 1/s
    np.testing.assert_allclose(limits["si", "curvature"], 0.1 * limits["plain", "curvature"])
    assert limits["si", "linear"] == pytest.approx(0.1 * limits["plain", "linear"])
    np.testing.assert_array_equal(limits["si", "bound_fraction"], limits["plain", "bound_fraction"])


def test_mixed_and_unknown_units_are_refused_in_one_line():
    mixed = SI.assign(x=RUN["x"].variable)  # a DataArray would bring its times along
    odd = RUN.assign(x=RUN["x"].assign_attrs(units="furlong"))
    for run, said in ((mixed, "'x' is in 'R_0' but"), (odd, "'furlong'")):
        for use in (cc.plot.summary, cc.observables.speed):
            with pytest.raises(cc.InputError, match=said) as error:
                use(run)
            assert "\n" not in str(error.value)


def test_linear_theory_is_not_drawn_over_a_run_in_si():
    with pytest.raises(cc.InputError, match="without dimension"):
        cc.plot.growth(SI, [1])
