"""One check at every door: data that users have changed is handled, or refused in one line."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import cellcrawl as cc
from cellcrawl.data import FIELDS, TRACK_FIELDS, records_with
from cellcrawl.data.units import units_of
from cellcrawl.data.schema import DIMENSIONAL
from cellcrawl.parameters.scales import KINDS
from tests.runs import circling, straight

RUN = circling(0.3, records=120)
"""A circle that goes round, long enough for every observable."""

DOORS = {
    "speed": cc.observables.speed,
    "heading": cc.observables.heading,
    "turning_rate": cc.observables.turning_rate,
    "mean_squared_displacement": cc.observables.mean_squared_displacement,
    "straightness": cc.observables.straightness,
    "mean_distance": cc.observables.mean_distance,
    "persistence": cc.observables.persistence,
    "turning_events": cc.observables.turning_events,
    "lateral_oscillation": cc.observables.lateral_oscillation,
    "tension_oscillation": cc.observables.tension_oscillation,
    "circularity": cc.observables.circularity,
    "aspect_ratio": cc.observables.aspect_ratio,
    "front_position": cc.observables.front_position,
    "front_rear_asymmetry": cc.observables.front_rear_asymmetry,
    "kymograph": cc.observables.kymograph,
    "classify": cc.classify,
    "plot.path": cc.plot.path,
    "plot.kymographs": cc.plot.kymographs,
    "plot.time_series": cc.plot.time_series,
    "plot.summary": cc.plot.summary,
    "FromRun": lambda run: cc.FromRun(run).state(cc.Parameters(), 64),
}
OF_THE_EDGE = (
    "aspect_ratio",
    "front_position",
    "front_rear_asymmetry",
    "kymograph",
    "plot.path",
    "plot.kymographs",
    "plot.summary",
    "FromRun",
)


def changed(name: str, values: np.ndarray) -> xr.Dataset:
    return RUN.assign({name: RUN[name].copy(data=values)})


def with_nan(name: str) -> xr.Dataset:
    values = RUN[name].values.copy()
    values[-1] = np.nan
    return changed(name, values)


BAD_EVERYWHERE = {
    "reversed": (RUN.isel(time=slice(None, None, -1)), "must rise"),
    "joined twice": (xr.concat([RUN, RUN], "time"), "must rise"),
    "of several runs": (xr.concat([RUN, RUN], "seed"), "has dimensions"),
    "padded": (RUN.pad(time=(0, 3)), "not finite"),
    "one record, bare": (RUN.isel(time=3), "has dimensions"),
    "without records": (RUN.isel(time=[]), "record"),
    "times as durations": (
        RUN.assign_coords(time=(RUN["time"] * 1e9).values.astype("timedelta64[ns]")),
        "numbers",
    ),
    "a table": (RUN.to_array("field", "all").to_dataset(name="all"), "no '"),
    "an array": (RUN["tension"], "Dataset"),
}
BAD_EDGES = {
    "half of the nodes": (RUN.isel(node=slice(0, 32)), "not a whole ring"),
    "nodes backwards": (RUN.isel(node=slice(None, None, -1)), "clockwise"),
    "nodes sorted by x": (
        RUN.isel(node=np.argsort(RUN["x"].values[0])),
        "not a whole ring",
    ),
    "scaled by hand": (changed("x", 7.0 * RUN["x"].values), "not a whole ring"),
    "a track": (RUN[list(TRACK_FIELDS)], "without its edge"),
    "NaN on the edge": (with_nan("x"), "not finite at record"),
}


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize("case", BAD_EVERYWHERE)
def test_what_is_no_run_is_refused_at_every_door_in_one_line(door, case):
    run, says = BAD_EVERYWHERE[case]
    with pytest.raises(cc.InputError) as caught:
        DOORS[door](run)
    assert "\n" not in str(caught.value)
    assert says in str(caught.value)


@pytest.mark.parametrize("door", OF_THE_EDGE)
@pytest.mark.parametrize("case", BAD_EDGES)
def test_an_edge_that_is_no_ring_is_refused_wherever_it_counts(door, case):
    run, says = BAD_EDGES[case]
    with pytest.raises(cc.InputError) as caught:
        DOORS[door](run)
    assert "\n" not in str(caught.value)
    assert says in str(caught.value)


@pytest.mark.parametrize("door", DOORS)
def test_a_part_of_a_run_is_a_run(door):
    DOORS[door](RUN.isel(time=slice(20, None)))
    DOORS[door](RUN.isel(time=slice(None, None, 2), node=slice(None, None, 2)))
    DOORS[door](RUN.assign(mine=("time", np.arange(120))))


@pytest.mark.parametrize("name", ["length", "area"])
def test_differences_are_no_run(name):
    with pytest.raises(cc.InputError, match=f"'{name}' must be above 0"):
        records_with(RUN.diff("time"), name)


@pytest.mark.parametrize("name", ["time", *FIELDS])
def test_a_value_that_is_not_finite_is_placed(name):
    run = RUN.assign_coords(time=with_nan("time")["time"]) if name == "time" else with_nan(name)
    with pytest.raises(cc.InputError, match=rf"{name}.* is not finite at"):
        records_with(run, *FIELDS)


def test_units_are_the_models_or_all_of_one_system():
    si = cc.Scales().dataset(RUN)
    assert records_with(si, *FIELDS) is si
    assert units_of(RUN).system == "model"
    assert units_of(si).system == "SI"
    mixed = RUN.assign(x=RUN["x"].assign_attrs(units="m"))
    with pytest.raises(cc.InputError, match=r"'x' is in 'm' but 'time' is in '1/k_off0'"):
        records_with(mixed, *FIELDS)
    pixels = RUN.assign(x=RUN["x"].assign_attrs(units="px"))
    with pytest.raises(cc.InputError, match=r"'x' is in 'px': a run has it in 'R_0', 'm'"):
        records_with(pixels, *FIELDS)
    bare = RUN.assign({name: RUN[name].copy() for name in FIELDS})
    for name in bare.variables:
        bare[name].attrs.clear()
    assert records_with(bare, *FIELDS) is bare


def test_si_units_are_those_that_scales_give():
    given = {kind.label: kind.unit for kind in KINDS.values()}
    assert {label: si for label, (si, _) in DIMENSIONAL.items()} == {
        label: given[label] for label in DIMENSIONAL
    }
    assert {field.units for field in FIELDS.values()} <= {*DIMENSIONAL, "1", "rad"}


def test_a_start_from_another_size_is_refused_with_and_without_units():
    si = cc.Scales().dataset(straight())
    with pytest.raises(cc.InputError, match="this one is in others"):
        cc.FromRun(si).state(cc.Parameters(), 64)
    for name in si.variables:
        si[name].attrs.clear()
    del si.attrs["scales"]
    with pytest.raises(cc.InputError, match="area of this record is"):
        cc.FromRun(si).state(cc.Parameters(), 64)
