import json

import numpy as np
import pytest
import xarray as xr

import cellcrawl as cc
from cellcrawl.parameters import KINDS
from cellcrawl.simulation.dataset import FIELDS, TIME


@pytest.fixture
def run():
    """A Dataset of the run schema without a run."""
    sizes = {"time": 3, "node": 4}
    rng = np.random.default_rng(0)
    variables = {
        name: (f.dims, rng.normal(size=[sizes[d] for d in f.dims]), {"units": f.units})
        for name, f in FIELDS.items()
    }
    time = ("time", [0.0, 0.5, 1.0], {"units": TIME.units})
    attributes = {"parameters": json.dumps(cc.Parameters().to_dict()), "schedule": "{}"}
    return xr.Dataset(variables, coords={"time": time}, attrs=attributes)


def test_every_variable_of_a_run_has_units_the_scales_know():
    labels = {kind.label for kind in KINDS.values()} | {"1", "rad"}
    assert {field.units for field in FIELDS.values()} | {TIME.units} <= labels


def test_variables_are_scaled_and_named_in_si(run):
    si = cc.Scales().dataset(run)
    assert si.time.values.tolist() == [0.0, 5.0, 10.0]
    assert si.time.attrs["units"] == "s"
    expected = {  # length 10 um, time 10 s, v_beta 1 nm/s, zeta_0 200 N s/m^2
        "x": (1e-5, "m"),
        "theta": (1.0, "rad"),
        "curvature": (1e5, "1/m"),
        "bound_fraction": (1.0, "1"),
        "off_rate": (0.1, "1/s"),
        "normal_velocity": (1e-6, "m/s"),
        "friction": (2e-7, "N/m"),
        "tension": (1e-7, "N/m"),
        "area": (1e-10, "m^2"),
    }
    for name, (size, unit) in expected.items():
        np.testing.assert_allclose(si[name], run[name].values * size, rtol=1e-14)
        assert si[name].attrs["units"] == unit
    assert si.x.dims == run.x.dims
    assert si.attrs["parameters"] == run.attrs["parameters"]
    assert cc.Scales.from_dict(json.loads(si.attrs["scales"])) == cc.Scales()


def test_the_run_given_is_left_alone(run):
    before = run.copy(deep=True)
    cc.Scales().dataset(run)
    assert run.identical(before)


def test_dataset_in_si_is_not_scaled_again(run):
    with pytest.raises(cc.InputError, match="in SI already"):
        cc.Scales().dataset(cc.Scales().dataset(run))


def test_scales_of_another_cell_are_refused_with_the_velocity_that_fits(run):
    with pytest.raises(cc.InputError, match=r"this run has epsilon = 0.001") as error:
        cc.Scales(time=20.0).dataset(run)
    advised = float(str(error.value).split("retrograde_velocity=")[1])
    cc.Scales(time=20.0, retrograde_velocity=advised).dataset(run)


def test_run_whose_epsilon_changes_has_no_scales(run):
    run.attrs["schedule"] = json.dumps({"epsilon": [[0, 0.001], [1, 0.002]]})
    with pytest.raises(cc.InputError, match="epsilon changes"):
        cc.Scales().dataset(run)


def test_unknown_units_are_named(run):
    run["x"].attrs["units"] = "furlong"
    with pytest.raises(cc.InputError, match="'x' is in 'furlong'"):
        cc.Scales().dataset(run)


def test_other_things_are_refused():
    with pytest.raises(cc.InputError, match="xarray Dataset, not list"):
        cc.Scales().dataset([1.0])


def test_dataarray_gets_its_unit(run):
    speed = xr.DataArray([0.1, 0.2], dims="time", attrs={"long_name": "speed", "units": "?"})
    si = cc.Scales().to_physical(speed, "velocity")
    assert si.attrs == {"long_name": "speed", "units": "m/s"}
    np.testing.assert_allclose(si, [1e-7, 2e-7])
    back = cc.Scales().to_dimensionless(si, "velocity")
    assert back.attrs["units"] == "R_0 k_off0"
