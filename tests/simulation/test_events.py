"""How runs end: a cell that tears."""

from __future__ import annotations

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.curve import first_crossing


@pytest.fixture(scope="module", params=["paper", "adaptive"])
def torn(request, tmp_path_factory):
    # MODEL.md section 6: 20-33 % of seeds at (16, 600) tear; this is one of them.
    path = tmp_path_factory.mktemp("torn") / "run.nc"
    return cc.simulate(
        cc.Parameters(r_on=16, zeta_1=600),
        60.0,
        start=cc.RandomPerturbation(seed=7),
        solver=request.param,
        nodes=1000,
        output=path,
    )


def test_a_torn_cell_ends_as_fragmented_and_says_when_and_where(torn):
    assert torn.attrs["status"] == "fragmented"
    message = torn.attrs["status_message"]
    assert "crosses itself at t = " in message
    assert "s/L = " in message
    assert "tears" in message


def test_everything_up_to_the_tear_is_kept_and_valid(torn):
    end = torn.attrs["end_time"]
    time = torn["time"].values
    assert time[-1] == end
    assert np.array_equal(time[:-1], 0.1 * np.arange(time.size - 1))
    for record in range(time.size):
        frame = torn.isel(time=record)
        assert first_crossing(np.column_stack([frame["x"], frame["y"]])) is None


def test_the_tear_is_located_to_1e_4(torn):
    crossed = float(torn.attrs["status_message"].split("t = ")[1].split(",")[0])
    assert 0.0 < crossed - torn.attrs["end_time"] < 2e-4


def test_the_torn_shape_is_long(torn):
    # MODEL.md: torn cells stretch to L = 10-20, a gliding one has about 7.3.
    assert torn["length"].values[-1] > 10.0


def test_a_torn_run_cannot_be_resumed(torn, tmp_path):
    with pytest.raises(cc.InputError, match="'fragmented' and cannot go on"):
        cc.resume(torn.encoding["source"], 100.0)
