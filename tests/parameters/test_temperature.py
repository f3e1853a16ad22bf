"""Temperature: Arrhenius's law on the rates, Bell's on the force scale, and what stays."""

from __future__ import annotations

import math

import pytest

import cellcrawl as cc
from cellcrawl.errors import InputError

R = 8.314462618  # J/(mol K)
COLD, WARM = 278.15, 308.15
CELL = cc.PhysicalParameters(on_rate=3.3)


def test_rates_follow_arrhenius():
    energies = cc.ActivationEnergies(on_rate=80e3, off_rate=60e3)
    warm = CELL.at_temperature(WARM, energies)
    part = 1.0 / WARM - 1.0 / 298.15
    assert warm.on_rate == pytest.approx(3.3 * math.exp(-80e3 / R * part), rel=1e-9)
    assert warm.off_rate == pytest.approx(0.1 * math.exp(-60e3 / R * part), rel=1e-9)


def test_fifty_kilojoules_double_a_rate_in_ten_kelvin():
    rates = [CELL.at_temperature(298.15 + shift).off_rate for shift in (-5.0, 5.0)]
    assert rates[1] / rates[0] == pytest.approx(2.0, rel=0.03)


@pytest.mark.parametrize("difference", [-30e3, 0.0, 25e3, 60e3])
def test_r_on_moves_by_the_difference_of_the_two_energies(difference):
    energies = cc.ActivationEnergies(on_rate=100e3 + difference, off_rate=100e3)
    cold = CELL.at_temperature(288.15, energies).dimensionless()
    warm = CELL.at_temperature(298.15, energies).dimensionless()
    expected = math.exp(-difference / R * (1.0 / 298.15 - 1.0 / 288.15))
    assert warm.r_on / cold.r_on == pytest.approx(expected, rel=1e-9)


def test_zeta_1_rises_with_heat_only_if_the_flow_eases_more_than_linkers_let_go():
    # zeta_1/zeta_0 = (density of linkers) k_b / (k_off^0 zeta_0)
    eases = CELL.at_temperature(308.15, cc.ActivationEnergies(viscous_friction=70e3))
    water = CELL.at_temperature(308.15, cc.ActivationEnergies(viscous_friction=17e3))
    part = 1.0 / 308.15 - 1.0 / 298.15
    assert eases.dimensionless().zeta_1 == pytest.approx(600 * math.exp(-20e3 / R * part))
    assert water.dimensionless().zeta_1 == pytest.approx(600 * math.exp(33e3 / R * part))
    assert eases.dimensionless().zeta_1 > 600 > water.dimensionless().zeta_1


def test_the_force_scale_of_bells_law_is_proportional_to_temperature():
    cold = CELL.at_temperature(COLD)
    assert cold.adhesion_length == pytest.approx(1e-8 * COLD / 298.15, rel=1e-12)
    assert cold.dimensionless().epsilon == pytest.approx(1e-3 * COLD / 298.15, rel=1e-12)


def test_with_the_default_energies_the_other_numbers_stay():
    for temperature in (COLD, WARM):
        p, usual = CELL.at_temperature(temperature).dimensionless(), CELL.dimensionless()
        for name in ("zeta_1", "D", "h", "k_sigma"):
            assert getattr(p, name) == pytest.approx(getattr(usual, name), rel=1e-9)
        assert p.sigma_c == pytest.approx(100.0 * 298.15 / temperature, rel=1e-9)
        assert p.v_p == pytest.approx(usual.v_p * 298.15 / temperature, rel=1e-9)


def test_there_and_back_is_the_same_cell():
    back = CELL.at_temperature(WARM).at_temperature(298.15, reference=WARM)
    for name in CELL.field_names():
        if name != "elasticity":
            assert getattr(back, name) == pytest.approx(getattr(CELL, name), rel=1e-12)


def test_the_reference_temperature_changes_nothing():
    assert CELL.at_temperature(298.15) == CELL
    assert CELL.at_temperature(WARM, reference=WARM) == CELL


def test_quantities_of_any_unit_are_accepted():
    pint = pytest.importorskip("pint")
    units = pint.application_registry
    energies = cc.ActivationEnergies(on_rate=units.Quantity(18.0, "kcal/mol"))
    assert energies.on_rate == pytest.approx(18.0 * 4184.0)
    warm = CELL.at_temperature(units.Quantity(35.0, "degC"))
    assert warm.on_rate == pytest.approx(CELL.at_temperature(WARM).on_rate)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: CELL.at_temperature(25), "25 degrees Celsius are 298.15 K"),
        (lambda: CELL.at_temperature(-3.0), "-3 degrees Celsius are 270.15 K"),
        (lambda: CELL.at_temperature(500.0), "260 to 330 K"),
        (lambda: CELL.at_temperature(math.nan), "260 to 330 K"),
        (lambda: CELL.at_temperature("warm"), "'warm' has the wrong type"),
        (lambda: CELL.at_temperature(300.0, reference=20.0), "reference = 20.0 is out of range"),
        (lambda: CELL.at_temperature(300.0, {"on_rate": 5e4}), "must be ActivationEnergies"),
        (lambda: cc.ActivationEnergies(on_rate=75), "1 kJ/mol is 1000 J/mol"),
        (lambda: cc.ActivationEnergies(off_rate=-5e4), "from 0 to 500000 J/mol"),
        (lambda: cc.ActivationEnergies(on_rte=5e4), "did you mean 'on_rate'"),
        (
            lambda: CELL.at_temperature(WARM, cc.ActivationEnergies(on_rate=4e5)),
            "on_rate",  # r_on leaves its range
        ),
    ],
)
def test_nonsense_is_refused_in_one_line(call, says):
    with pytest.raises(InputError, match=says) as refused:
        call()
    assert "\n" not in str(refused.value)
