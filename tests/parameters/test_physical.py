import math
import subprocess
import sys

import numpy as np
import pint
import pytest
from hypothesis import given
from hypothesis import strategies as st

import cellcrawl as cc
from cellcrawl.parameters import KINDS, QUANTITIES
from tests.strategies import parameters

ULP = np.finfo(float).eps
cell = cc.PhysicalParameters
units = pint.UnitRegistry()

HUGE = pytest.param(10**5000, id="digits")  # too long for Python to print

scales = st.builds(
    cc.Scales,
    length=st.floats(1e-7, 1e-3),
    time=st.floats(1e-3, 1e5),
    viscous_friction=st.floats(1e-3, 1e6),
)


def same(first, second, ulps=16):
    """Whether two parameter sets agree to a few roundings."""
    numbers = [v for v in second.to_dict().values() if not isinstance(v, str)]
    given = [v for v in first.to_dict().values() if not isinstance(v, str)]
    return given == pytest.approx(numbers, rel=ulps * ULP, abs=0.0)


@st.composite
def scaled_parameters(draw):
    p, s = draw(parameters), draw(scales)
    return p, s.replace(retrograde_velocity=p.epsilon * s.velocity)


def test_default_cell_is_the_papers():
    assert same(cell().dimensionless(), cc.Parameters())


def test_default_scales_are_those_of_a_keratocyte():
    # MODEL.md section 7: time unit 10 s, velocity unit 1 um/s, v_beta = 1 nm/s
    s = cell().scales
    assert s.time == pytest.approx(10.0, rel=1e-15)
    assert s.velocity == pytest.approx(1e-6, rel=1e-15)
    assert s.retrograde_velocity == pytest.approx(1e-9, rel=1e-15)
    assert s.epsilon == pytest.approx(1e-3, rel=1e-15)


def test_keratocyte_speed_period_and_tension_are_right():
    s = cc.Scales()
    assert s.to_physical(0.19, "velocity") == pytest.approx(0.19e-6)  # MODEL.md section 7
    assert s.to_physical(18.0, "time") == pytest.approx(180.0)
    assert 0.5e-4 < s.to_physical(cc.Parameters().sigma_bar, "tension") < 2e-4


@given(scaled_parameters())
def test_round_trip_is_exact_to_rounding(case):
    p, s = case
    there = cell.from_dimensionless(p, s)
    assert same(there.dimensionless(), p, ulps=64)  # short numbers are taken as meant
    assert there.elasticity == p.elasticity
    assert same(there.scales, s)
    assert same(cell.from_dimensionless(there.dimensionless(), there.scales), there, ulps=40)


@given(parameters)
def test_without_scales_the_usual_ones_fit_any_epsilon(p):
    assert same(cell.from_dimensionless(p).dimensionless(), p)


def test_ends_of_a_range_survive_the_round_trip():
    for ends in ({"h": 0.2, "epsilon": 0.1}, {"zeta_1": 0.0, "D": 0.001, "k_sigma": 1e5}):
        p = cc.Parameters(**ends)
        for s in (cc.Scales(), cc.Scales(length=3e-5, time=7.0, viscous_friction=123.4)):
            fitting = s.replace(retrograde_velocity=p.epsilon * s.velocity)
            assert same(cell.from_dimensionless(p, fitting).dimensionless(), p)


def test_scales_of_another_epsilon_are_refused():
    with pytest.raises(
        cc.InputError, match=r"epsilon = 0.01, the scales 0.001.*velocity="
    ) as error:
        cell.from_dimensionless(cc.Parameters(epsilon=0.01), cc.Scales())
    advised = float(str(error.value).split("retrograde_velocity=")[1])
    cell.from_dimensionless(cc.Parameters(epsilon=0.01), cc.Scales(retrograde_velocity=advised))


@pytest.mark.parametrize(
    ("field", "factor", "name"),
    [
        ("on_rate", 2.0, "r_on"),
        ("adhesive_friction", 2.0, "zeta_1"),
        ("diffusivity", 2.0, "D"),
        ("lamellipodium_height", 2.0, "h"),
        ("contraction", 2.0, "sigma_c"),
        ("membrane_stiffness", 2.0, "k_sigma"),
    ],
)
def test_each_dimensionless_number_is_proportional_to_its_field(field, factor, name):
    first, doubled = cell(), cell(**{field: factor * getattr(cell(), field)})
    expected = factor * getattr(first.dimensionless(), name)
    assert getattr(doubled.dimensionless(), name) == pytest.approx(expected, rel=1e-14)


def test_dimensionless_numbers_follow_the_papers_definitions():
    c = cell(
        radius=8e-6,
        off_rate=0.2,
        on_rate=4.0,
        adhesion_length=2e-8,
        viscous_friction=150.0,
        adhesive_friction=9e4,
        diffusivity=1e-12,
        lamellipodium_height=2e-7,
        contraction=3e-5,
        membrane_stiffness=5e8,
        polymerization_speed=4e-7,
    )
    v_beta = 0.2 * 2e-8
    p = c.dimensionless()
    assert p.r_on == pytest.approx(4.0 / 0.2)
    assert p.zeta_1 == pytest.approx(9e4 / 150.0)
    assert pytest.approx(1e-12 / (0.2 * 8e-6**2)) == p.D
    assert p.epsilon == pytest.approx(v_beta / (0.2 * 8e-6))
    assert p.h == pytest.approx(2e-7 / 8e-6)
    assert p.sigma_c == pytest.approx(3e-5 / (150.0 * v_beta))
    assert p.k_sigma == pytest.approx(2 * 5e8 * 8e-6 / (150.0 * 0.2))
    assert p.v_p == pytest.approx(4e-7 / v_beta)
    assert c.scales.tension == pytest.approx(150.0 * v_beta / 2)


def test_consistent_elasticity_is_the_physical_law():
    # d sigma / dt = k_sigma dA / dt in SI, for an area growing by 1 um^2
    c = cell(elasticity="consistent")
    gained = c.dimensionless().tension_rate * c.scales.to_dimensionless(1e-12, "area")
    assert c.scales.to_physical(gained, "tension") == pytest.approx(c.membrane_stiffness * 1e-12)


@given(scaled_parameters())
def test_toml_round_trip_is_exact(case):
    there = cell.from_dimensionless(*case)
    assert cell.from_toml(there.to_toml()) == there
    assert cc.Scales.from_toml(there.scales.to_toml()) == there.scales


def test_quantities_of_any_unit_are_the_si_numbers():
    given = cell(
        radius=10 * units.um,
        off_rate=6 / units.minute,
        on_rate=2.5 * units.Hz,
        adhesion_length=10 * units.nm,
        viscous_friction=0.2 * units.pN * units.s / units.nm**2 * 1e-3,
        adhesive_friction=120 * units.kPa * units.s,
        diffusivity=0.5 * units.um**2 / units.s,
        lamellipodium_height=100 * units.nm,
        contraction=20 * units.pN / units.um,
        membrane_stiffness=1e-6 * units.pN / units.nm**3,
        polymerization_speed=195.6 * units.nm / units.s,
    )
    by_hand = cell(polymerization_speed=1.956e-7, viscous_friction=200.0)
    assert same(given, by_hand)
    assert type(given.radius) is float


@pytest.mark.parametrize("name", QUANTITIES)
def test_quantity_of_the_wrong_dimension_names_field_value_and_unit(name):
    unit = QUANTITIES[name].unit
    with pytest.raises(cc.InputError, match=f"^{name} = 3 kelvin has the wrong dimension") as error:
        cell(**{name: 3 * units.kelvin})
    assert unit in str(error.value)


@pytest.mark.parametrize("name", QUANTITIES)
def test_quantity_given_back_has_its_unit(name):
    value = cell().quantity(name)
    assert value.magnitude == getattr(cell(), name)
    assert value.check(units.parse_units(QUANTITIES[name].unit).dimensionality)
    assert cell(**{name: value}) == cell()


@pytest.mark.parametrize("name", QUANTITIES)
def test_field_that_takes_a_dimensionless_number_out_of_range_is_named(name):
    factor = 1e-9 if name == "viscous_friction" else 1e9
    with pytest.raises(cc.InputError, match="out of range") as error:
        cell(**{name: factor * getattr(cell(), name)})
    assert f"{name} = " in str(error.value)
    assert len(str(error.value).splitlines()) == 1


@pytest.mark.parametrize("name", QUANTITIES)
@pytest.mark.parametrize(
    "value",
    [math.nan, math.inf, -1.0, 1e300, "1", None, True, HUGE, np.ones(3) * units.m, [1.0]],
)
def test_impossible_values_are_one_line(name, value):
    with pytest.raises(cc.InputError, match=f"^{name} ") as error:
        cell(**{name: value})
    assert len(str(error.value).splitlines()) == 1


@given(scaled_parameters(), st.sampled_from(sorted(KINDS)), st.floats(-1e6, 1e6))
def test_scales_go_both_ways(case, kind, value):
    s = case[1]
    assert s.to_dimensionless(s.to_physical(value, kind), kind) == pytest.approx(
        value, rel=4 * ULP, abs=1e-300
    )


@pytest.mark.parametrize("kind", KINDS)
def test_scale_of_each_kind_has_the_dimension_of_its_unit(kind):
    # k times longer cells, lifetimes and so on change each scale by the power of its dimension
    meter, second, newton = 3.0, 5.0, 7.0
    usual = cc.Scales()
    other = cc.Scales(
        length=usual.length * meter,
        time=usual.time * second,
        retrograde_velocity=usual.retrograde_velocity * meter / second,
        viscous_friction=usual.viscous_friction * newton * second / meter**2,
    )
    given = dict(units.parse_units(KINDS[kind].unit)._units)
    known = {"meter": meter, "second": second, "newton": newton, "radian": 1.0}
    factor = math.prod(known[unit] ** power for unit, power in given.items())
    assert KINDS[kind].size(other) == pytest.approx(factor * KINDS[kind].size(usual), rel=1e-14)


def test_arrays_keep_their_shape():
    s = cc.Scales()
    assert np.array_equal(s.to_physical([[1, 2]], "time"), [[10.0, 20.0]])
    assert s.to_dimensionless(np.array([10.0, 30.0]), "time").tolist() == [1.0, 3.0]
    assert type(s.to_physical(np.float64(2.0), "time")) is float


def test_quantities_come_on_request_and_go_back():
    s = cc.Scales()
    speed = s.to_physical(0.2, "velocity", as_quantity=True)
    assert speed.to("um/s").magnitude == pytest.approx(0.2)
    assert s.to_dimensionless(12 * units.um / units.minute, "velocity") == pytest.approx(0.2)


@pytest.mark.parametrize("value", ["2", None, True, 1j, [[1], [2, 3]], {}, HUGE])
def test_values_that_are_no_numbers_are_refused(value):
    with pytest.raises(cc.InputError, match="must be a number or an array of numbers"):
        cc.Scales().to_physical(value, "length")


def test_unknown_kind_is_answered_with_the_nearest():
    with pytest.raises(cc.InputError, match="did you mean 'length'"):
        cc.Scales().to_physical(1.0, "lenght")
    with pytest.raises(cc.InputError, match="length = 2 second has the wrong dimension"):
        cc.Scales().to_dimensionless(2 * units.s, "length")


def test_pint_is_imported_only_for_quantities():
    code = (
        "import sys, cellcrawl as cc; cc.PhysicalParameters().dimensionless();"
        "cc.Scales().to_physical(1.0, 'length'); sys.exit('pint' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_without_pint_a_quantity_names_the_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "pint", None)
    with pytest.raises(ImportError, match=r"cellcrawl\[units\]"):
        cell().quantity("radius")


def test_the_usual_cell_is_the_usual_cell():
    assert cell().dimensionless() == cc.Parameters()


def test_a_length_in_micrometres_is_the_same_cell():
    measured = cell(radius=10 * units.um)
    assert measured == cell(radius=10e-6)
    assert measured.dimensionless() == cc.Parameters()


@pytest.mark.parametrize("value", [np, int, "x", None, np.array(["a"])])
def test_what_is_no_number_has_no_scale(value):
    with pytest.raises(cc.InputError, match="must be a number"):
        cc.Scales().to_physical(value, "length")
