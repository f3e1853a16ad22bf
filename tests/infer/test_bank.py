"""A bank: the same runs whatever their number, one file, nothing lost and nothing overwritten."""

import json

import h5py
import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.infer import bank_file, films
from cellcrawl.sweeps.executors import InProcess
from tests.infer.conftest import PRIOR, T_END, swimmer


def test_a_larger_bank_begins_with_a_smaller_one(made_up, tmp_path):
    small = made_up(12, tmp_path / "small.h5")
    large = made_up(20, tmp_path / "large.h5")
    grown = made_up(20, tmp_path / "small.h5")
    for one in (small, grown):
        assert np.array_equal(one.parameters, large.parameters[: len(one)])
    (whole,), (again,) = large.blocks(), grown.blocks()
    assert np.array_equal(whole.modes, again.modes)
    assert np.array_equal(whole.centroid, again.centroid)
    assert not list(tmp_path.glob("*.work"))


def test_films_are_those_of_the_runs(bank):
    (block,) = bank.blocks(np.array([5, 9]))
    names = dict(zip(bank.prior.cell_names, bank.parameters[9], strict=True))
    run = swimmer(names["r_on"], names["epsilon"], 10_000_000 + 9)
    late = run.isel(time=run.time.values >= films.TRANSIENT)
    edge = films.edge_of_modes(block.modes[1]) + block.centroid[1][:, None]
    assert np.abs(edge.real - late["x"].values).max() < 2e-3  # steps of 1e-4 in 21 waves


def test_how_runs_ended_is_kept(bank):
    names, counts = np.unique(bank.outcomes, return_counts=True)
    assert dict(zip(names, counts, strict=True)) == {
        "completed": 144,
        "fragmented": 8,
        "resting": 8,
    }


def test_a_real_run_goes_into_a_bank_and_back(tmp_path):
    prior = cc.infer.Prior({"r_on": (25, 27)})
    made = cc.infer.bank(prior, 2, tmp_path / "real.h5", t_end=20.0, executor=InProcess())
    run = cc.simulate(
        cc.Parameters(r_on=made.parameters[1, 0]),
        20.0,
        start=cc.RandomPerturbation(seed=10_000_001),
        save_every=films.SAVE_EVERY,
        nodes=films.NODES,
        rtol=1e-3,
    )
    (block,) = made.blocks()
    late = run.isel(time=run.time.values >= films.TRANSIENT)
    assert block.centroid[1].real == pytest.approx(late["centroid_x"].values, abs=1e-6)


@pytest.mark.parametrize(
    ("change", "word"),
    [({"seed": 2}, "another seed"), ({"laws": "stiffness"}, "another law")],
)
def test_another_bank_is_not_overwritten(made_up, tmp_path, change, word):
    path = tmp_path / "bank.h5"
    made_up(2, path)
    before = path.read_bytes()
    with pytest.raises(cc.InputError, match=word):
        made_up(4, path, **change)
    assert path.read_bytes() == before


def of_another_version(path, change=None):
    """Make a bank one of another version, whose films may have been changed."""
    with h5py.File(path, "r+") as file:
        header = json.loads(file.attrs["header"]) | {"code": "0.0.0+elsewhere"}
        file.attrs["header"] = json.dumps(header)
        file.attrs["seal"] = bank_file._hash(file.attrs["header"])
        if change is not None:
            file["modes"][change, 4, 3, 0] += 1


def test_a_bank_of_another_version_is_gone_on_with_if_its_runs_are_the_same(made_up, tmp_path):
    path = tmp_path / "bank.h5"
    made_up(6, path)
    of_another_version(path)
    before = path.read_bytes()
    with pytest.raises(cc.InputError, match=r"another version of cellcrawl.*or adopt it"):
        made_up(8, path)
    assert path.read_bytes() == before
    grown = made_up(8, path, adopt=True)
    assert len(grown) == 8
    assert "6 runs of 0.0.0+elsewhere, 6 of them made again: the same" in grown.summary()
    anew = made_up(8, tmp_path / "anew.h5")
    (one,), (other,) = grown.blocks(), anew.blocks()
    assert np.array_equal(one.modes, other.modes)
    assert made_up(10, path).header["adopted"] == grown.header["adopted"]


def test_a_bank_whose_runs_come_out_otherwise_is_not_adopted(made_up, tmp_path):
    path = tmp_path / "bank.h5"
    made_up(6, path)
    of_another_version(path, change=2)
    before = path.read_bytes()
    with pytest.raises(cc.InputError, match=r"run 2 of .*make the bank anew"):
        made_up(8, path, adopt=True)
    assert path.read_bytes() == before


def test_a_file_that_is_no_bank_is_refused(tmp_path):
    other = tmp_path / "other.h5"
    other.write_bytes(b"no bank at all")
    with pytest.raises(cc.InputError, match="is no bank"):
        cc.infer.open_bank(other)
    with pytest.raises(cc.InputError, match="there is no bank"):
        cc.infer.open_bank(tmp_path / "nowhere.h5")
    with h5py.File(other, "w") as file:
        file["x"] = 1
    with pytest.raises(cc.InputError, match="is no bank"):
        cc.infer.open_bank(other)


def test_a_damaged_bank_is_refused(made_up, tmp_path):
    path = tmp_path / "bank.h5"
    made_up(8, path)
    whole = path.read_bytes()
    with h5py.File(path, "r+") as file:
        file.attrs["header"] = file.attrs["header"].replace('"seed": 1', '"seed": 2')
    with pytest.raises(cc.StorageError, match="damaged"):
        cc.infer.open_bank(path)
    path.write_bytes(whole)
    with h5py.File(path) as file:
        place = file["modes"].id.get_chunk_info(0).byte_offset
    path.write_bytes(whole[: place + 50] + bytes([whole[place + 50] ^ 255]) + whole[place + 51 :])
    with pytest.raises(cc.StorageError):
        list(cc.infer.open_bank(path).blocks())


@pytest.mark.parametrize(
    ("ranges", "word"),
    [
        ({}, "no parameter of the cell"),
        ({"time_unit": (5, 20)}, "no parameter of the cell"),
        ({"r_onn": (15, 40)}, "r_on"),
        ({"r_on": (40, 15)}, "from low to high"),
        ({"r_on": (0, 15)}, "beyond"),
        ({"D": (-1, 1, "log")}, "above zero"),
        ({"r_on": 7}, "range"),
    ],
)
def test_a_prior_that_cannot_be_is_refused(ranges, word):
    with pytest.raises(cc.InputError, match=word):
        cc.infer.Prior(ranges)


def test_a_law_without_the_number_in_the_prior_is_refused(tmp_path):
    prior = cc.infer.Prior({"r_on": (15, 40), "laws.gain": (0, 1)})
    with pytest.raises(cc.InputError, match="gain"):
        cc.infer.bank(prior, 2, tmp_path / "bank.h5", laws="stiffness")


def test_numbers_of_a_law_can_be_unknown(made_up, tmp_path):
    prior = cc.infer.Prior({"r_on": (15, 40), "laws.chi": (0.1, 0.5)})
    prior.check_law(cc.laws.Stiffness())
    point = cc.infer.prior.point_of(prior.cell_names, np.array([20.0, 0.3]), cc.laws.Stiffness())
    assert point == {"r_on": 20.0, "laws": cc.laws.Stiffness(chi=0.3)}


def test_draws_fill_the_prior():
    values = PRIOR.draw(range(400), 3)
    for i, name in enumerate(PRIOR.cell_names):
        part = PRIOR.ranges[name].part(values[:, i])
        assert part.min() > 0
        assert part.max() < 1
        assert part.mean() == pytest.approx(0.5, abs=4 * np.sqrt(1 / 12 / 400))
    assert T_END > films.TRANSIENT
