import copy
import math
import pickle

import numpy as np
import pytest
from hypothesis import given

import cellcrawl as cc
from cellcrawl.errors import StorageError
from cellcrawl.parameters import DESCRIPTIONS
from tests.strategies import TABLE, parameters


@pytest.mark.parametrize("name", TABLE)
def test_default_is_the_papers_value(name):
    assert getattr(cc.Parameters(), name) == TABLE[name][0]


@pytest.mark.parametrize("name", TABLE)
def test_both_ends_of_the_range_are_allowed_and_nothing_beyond(name):
    _, low, high = TABLE[name]
    for end, beyond in ((low, -math.inf), (high, math.inf)):
        assert getattr(cc.Parameters(**{name: end}), name) == end
        with pytest.raises(cc.InputError, match=f"^{name} = .* out of range.*{high:g}"):
            cc.Parameters(**{name: np.nextafter(end, beyond)})


def test_range_table_has_every_parameter():
    assert set(DESCRIPTIONS) == set(TABLE)


def test_polymerization_velocity_is_the_tables_200_before_rounding():
    assert cc.Parameters().v_p == pytest.approx(195.6, abs=0.05)


def test_resting_state_at_25_600():
    p = cc.Parameters(r_on=25, zeta_1=600)
    log_r = math.log(50)
    assert p.n_bar == pytest.approx(1 / 3, rel=1e-15)
    assert p.sigma_bar == pytest.approx((50 * log_r + 200 * log_r - 100) / 1.01, rel=1e-14)


@pytest.mark.parametrize(
    ("r_on", "zeta_1", "low", "high"),
    [(56, 560, 1240.3, 1240.3), (24, 540, 776, 815), (26, 600, 886, 931)],
)
def test_resting_tension_is_near_that_of_the_moving_cell(r_on, zeta_1, low, high):
    # MODEL.md section 6: the ranges of tension in long runs; a moving cell stays within 5 %.
    assert low * 0.95 < cc.Parameters(r_on=r_on, zeta_1=zeta_1).sigma_bar < high * 1.05


@given(parameters)
def test_resting_state_balances_kinetics_and_force(p):
    assert p.r_on * (1 - p.n_bar) == pytest.approx(p.r_p * p.n_bar, rel=1e-12)
    pull = p.sigma_c + p.sigma_bar * (1 + p.h)
    friction = p.v_p + p.zeta_1 * p.n_bar * math.log(p.r_p)
    assert pull == pytest.approx(friction, rel=1e-12)


@given(parameters)
def test_tension_rates_of_the_two_readings_differ_by_epsilon(p):
    assert p.replace(elasticity="printed").tension_rate == p.k_sigma
    assert p.replace(elasticity="consistent").tension_rate == p.k_sigma / p.epsilon


@given(parameters)
def test_toml_round_trip_is_exact(p):
    assert cc.Parameters.from_toml(p.to_toml()) == p


def test_toml_file_round_trip_is_exact(tmp_path):
    p = cc.Parameters(D=0.1 + 0.2, elasticity="consistent")
    path = tmp_path / "r_on=25, D.toml"
    p.to_toml(path)
    assert cc.Parameters.from_toml(path) == cc.Parameters.from_toml(str(path)) == p


def test_toml_file_may_begin_with_a_byte_order_mark(tmp_path):
    path = tmp_path / "windows.toml"
    path.write_bytes(b"\xef\xbb\xbfr_on = 30\r\n")
    assert cc.Parameters.from_toml(path).r_on == 30.0


@given(parameters)
def test_copies_and_pickles_are_equal_and_hash_alike(p):
    for other in (copy.deepcopy(p), pickle.loads(pickle.dumps(p)), p.replace()):
        assert other == p
        assert hash(other) == hash(p)


def test_parameters_are_immutable():
    with pytest.raises(AttributeError):
        cc.Parameters().r_on = 3.0


def test_replace_leaves_the_original_and_checks_the_copy():
    p = cc.Parameters()
    assert p.replace(D=0.01).D == 0.01
    assert p.D == 0.05
    with pytest.raises(cc.InputError, match="did you mean 'r_on'"):
        p.replace(r_onn=3)


@pytest.mark.parametrize(
    ("wrong", "nearest"),
    [("ron", "r_on"), ("zeta1", "zeta_1"), ("d", "D"), ("eps", "epsilon"), ("K_SIGMA", "k_sigma")],
)
def test_misspelt_name_is_answered_with_the_nearest(wrong, nearest):
    with pytest.raises(cc.InputError, match=f"no '{wrong}': did you mean '{nearest}'"):
        cc.Parameters(**{wrong: 1.0})


@pytest.mark.parametrize("name", ["self", "cls", "args", "fields", "", "__class__"])
def test_names_python_uses_itself_are_unknown_too(name):
    with pytest.raises(cc.InputError, match="Parameters has no"):
        cc.Parameters.from_dict({name: 1})
    with pytest.raises(cc.InputError, match="Parameters has no"):
        cc.Parameters().replace(**{name: 1})


def test_numbers_may_come_from_numpy():
    p = cc.Parameters(r_on=np.float32(25), zeta_1=np.int64(600), D=np.float64(0.05))
    assert p == cc.Parameters()
    assert type(p.r_on) is float
    assert type(p.zeta_1) is float


@pytest.mark.parametrize(
    "value",
    ["25", None, True, np.True_, 25j, [25], np.array([25.0]), {}, b"25", np.timedelta64(25, "s")],
)
def test_wrong_types_are_named(value):
    with pytest.raises(cc.InputError, match=r"^r_on = .* has the wrong type: .* from 1 to 200$"):
        cc.Parameters(r_on=value)


@pytest.mark.parametrize(
    "value", [math.nan, math.inf, -math.inf, pytest.param(-(10**5000), id="digits"), -0.1, 1e9]
)
def test_impossible_numbers_are_named(value):
    with pytest.raises(cc.InputError, match=r"^r_on .*from 1 to 200$"):
        cc.Parameters(r_on=value)


def test_positional_values_are_refused():
    with pytest.raises(cc.InputError, match="by name"):
        cc.Parameters(25.0)


@pytest.mark.parametrize(
    ("source", "says"),
    [
        ("r_on = ", "not valid TOML"),
        ("r_on", r"not valid TOML.*|a file's name ends in .toml"),
        ("missing.toml", "cannot read 'missing.toml'"),
        ("a\0b.toml", "not valid TOML"),
        pytest.param("x = " + "[" * 5000, "not valid TOML", id="brackets"),
        pytest.param("r_on = 1" + "0" * 5000, "TOML|too large", id="digits"),
        (26, "from a path or text"),
        (None, "from a path or text"),
        ("r_on = 'many'", "wrong type"),
        ("r_on = nan", "out of range"),
        ("[r_on]\nvalue = 3", "wrong type"),
    ],
)
def test_bad_toml_is_one_line(source, says):
    with pytest.raises(cc.InputError, match=says) as caught:
        cc.Parameters.from_toml(source)
    assert len(str(caught.value).splitlines()) == 1


def test_unreadable_files_are_one_line(tmp_path):
    binary = tmp_path / "binary.toml"
    binary.write_bytes(b"\xff\xfe\x00")
    for path in (binary, tmp_path, tmp_path / "missing.toml"):
        with pytest.raises(cc.InputError, match=r"TOML|cannot read"):
            cc.Parameters.from_toml(path)


def test_unwritable_path_is_named(tmp_path):
    with pytest.raises(StorageError, match=r"cannot write .*missing"):
        cc.Parameters().to_toml(tmp_path / "missing" / "p.toml")
