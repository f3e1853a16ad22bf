"""What `simulate` says to values that cannot be meant."""

from __future__ import annotations

import numpy as np
import pytest

import cellcrawl as cc

SQUARE = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"r_on": 26}, r"r_on is a parameter of the cell: .*Parameters\(r_on=...\)"),
        ({"elasticity": "printed"}, "elasticity is a parameter of the cell"),
        ({"seed": 3}, r"seed belongs to the start: .*RandomPerturbation\(seed=...\)"),
        ({"k": 3}, r"k belongs to the start: .*Eigenmode\(k=...\)"),
        ({"saveevery": 1.0}, "did you mean 'save_every'"),
        ({"rtoll": 1e-3}, "did you mean 'rtol'"),
        ({"x" * 5000: 1}, "has no option 'xxx"),
        ({"solver": ["adaptive"]}, "solver must be text"),
        ({"solver": "adpative"}, "did you mean 'adaptive'"),
        ({"save_every": 1e-8}, r"1e\+10 records up to t_end = 100: .*with save_every = 1e-05"),
        ({"save_every": 5e-324}, "records up to t_end"),
        ({"solver": "paper", "dt": 1e-300}, r"1e\+302 steps"),
        ({"solver": "paper", "dt": np.zeros(3)}, "dt = "),
        ({"parameters": {"r_on": 26}}, "parameters must be Parameters"),
        ({"progress": np.array([True, False])}, "progress must be True or False"),
        ({"output": "x" * 5000 + ".nc"}, "too long"),
        ({"output": "a\0b.nc"}, "is not a path"),
    ],
)
def test_a_mistake_is_named_with_what_is_meant(arguments, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(cc.InputError, match=words) as error:
        cc.simulate(**arguments)
    assert len(str(error.value)) < 400
    assert not list(tmp_path.iterdir())


def test_going_on_for_too_many_records_is_refused(tmp_path):
    cc.simulate(t_end=0.001, save_every=0.001, nodes=32, output=tmp_path / "run.nc")
    with pytest.raises(cc.InputError, match=r"1e\+12 records"):
        cc.resume(tmp_path / "run.nc", 1e9)


@pytest.mark.parametrize("scale", [20.0, 1e-6])
def test_an_outline_in_other_units_is_refused_with_the_radius_to_give(scale):
    with pytest.raises(cc.InputError, match=r"Give radius=1 .*or radius=") as error:
        cc.FromOutline(scale * SQUARE)
    kept = float(str(error.value).rpartition("radius=")[2].split()[0])
    area = cc.FromOutline(scale * SQUARE, radius=kept).state(cc.Parameters(), 256).curve.area
    assert area == pytest.approx(4.0 * scale**2, rel=1e-3)
    cell = cc.FromOutline(scale * SQUARE, radius=1).state(cc.Parameters(), 256)
    assert cell.curve.area == pytest.approx(np.pi, rel=1e-9)


def test_a_start_takes_numbers_out_of_their_boxes():
    run = cc.simulate(t_end=0.1, nodes=32)
    start = cc.FromRun(run, np.int64(1))
    assert start.describe()["record"] == 1
    assert type(start.record) is int
    again = cc.simulate(t_end=np.array(0.1), start=start, nodes=np.int32(32))
    assert again.attrs["status"] == "completed"
