"""Files of networks are refused for what they are, not by pickle, also where sbi is not there."""

import json

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.infer import neural
from tests.infer.conftest import swimmer

UNIT = {"time_unit": (0.8, 1.25, "log")}


def cell():
    return swimmer(28.0, 1e-3, seed=5, step=0.5)


@pytest.fixture(scope="module")
def header(bank):
    """What a file says of itself whose network is of this bank and film."""
    taught = cc.infer.fit(cell(), bank, **UNIT).trained
    return neural._header(taught)


def written(path, header):
    """Write a file of a network that has next to no weights."""
    text = np.frombuffer(json.dumps(header).encode(), np.uint8)
    with path.open("wb") as file:
        np.savez(file, header=text, middle=np.zeros(3), spread=np.ones(3))
    return path


class Trap:
    """Says so if it is unpickled."""

    def __reduce__(self):
        return (pytest.fail, ("it was unpickled",))


def refused(path, bank, error, word):
    before = path.read_bytes()
    with pytest.raises(error, match=word) as raised:
        cc.infer.fit(cell(), bank, method="npe", network=path, **UNIT)
    assert "\n" not in str(raised.value)
    assert path.read_bytes() == before


@pytest.mark.parametrize("how", ["pickle", "pickle within", "cut", "empty", "text", "list", "json"])
def test_a_file_that_is_no_network_is_refused_and_nothing_in_it_is_run(how, header, bank, tmp_path):
    wrong = tmp_path / "network.npz"
    if how.startswith("pickle"):
        trap = np.array([Trap()], object)
        with wrong.open("wb") as file:
            if how == "pickle":
                np.save(file, trap, allow_pickle=True)
            else:
                np.savez(file, header=trap)
    elif how == "list":
        written(wrong, [header])
    elif how == "json":
        written(wrong, header)
        wrong.write_bytes(wrong.read_bytes().replace(b'"kind"', b'"kin""'))
    else:
        whole = written(wrong, header).read_bytes()
        wrong.write_bytes({"cut": whole[:-300], "empty": b"", "text": b"no network"}[how])
    refused(wrong, bank, cc.StorageError, "no network of cellcrawl, or damaged: train it anew")


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("kind", "another"),
        ("version", -1),
        ("bank", "0123456789abcdef"),  # of another prior, law or version of the solver
        ("microscope", "error"),
        ("unknown", ["r_on"]),
    ],
)
def test_a_network_of_something_else_is_refused(name, value, header, bank, tmp_path):
    if name == "microscope":
        value = {**header["microscope"], value: 0.1}
    path = written(tmp_path / "network.npz", {**header, name: value})
    refused(path, bank, cc.InputError, f"of another {name}: give another file")
