"""Neural posteriors, where sbi is installed: they agree with ABC, and networks are kept safely."""

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.infer import neural
from tests.infer.conftest import swimmer

pytest.importorskip("sbi", reason="needs the extra cellcrawl[infer]")
UNIT = {"time_unit": (0.8, 1.25, "log")}


def cell(seed=5):
    return swimmer(28.0, 1e-3, seed=seed, step=0.5)


@pytest.fixture(scope="module")
def kept(bank, tmp_path_factory):
    """A fit, and the file where its network is kept."""
    path = tmp_path_factory.mktemp("network") / "network.npz"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(neural, "_EPOCHS", 20)
        patch.chdir(path.parent)
        fit = cc.infer.fit(cell(), bank, method="npe", network=path, **UNIT)
    assert [one.name for one in path.parent.iterdir()] == [path.name]  # and no logs
    return fit, path


def test_the_methods_agree_on_a_cell_that_tells_much(kept):
    fit, _ = kept
    for name, value in (("r_on", 28.0), ("epsilon", 1e-3)):
        interval = fit.interval(name, 0.99)
        assert interval.low < value < interval.high
    ranges = fit.trained.view.ranges
    assert all(r.low <= v <= r.high for r, v in zip(ranges, fit.values.min(axis=0), strict=True))
    assert all(r.low <= v <= r.high for r, v in zip(ranges, fit.values.max(axis=0), strict=True))


def test_a_network_that_was_kept_gives_the_same_posterior(kept, bank, monkeypatch):
    fit, path = kept
    monkeypatch.setattr(neural, "train_estimate", None)  # none is trained
    again = cc.infer.fit(cell(), bank, method="npe", network=path, **UNIT)
    assert again.samples.part == pytest.approx(fit.samples.part, abs=1e-6)
    assert again.calibration.rank == pytest.approx(fit.calibration.rank)
    other = cc.infer.fit(cell(6), bank, method="npe", network=path, **UNIT)
    assert other.estimate.header == fit.estimate.header


def test_intervals_of_runs_set_apart_hold_the_truth_as_they_say(kept):
    fit, _ = kept
    cells = len(fit.calibration.rank)
    unsure = 3.0 * (0.9 * 0.1 / cells) ** 0.5
    assert fit.calibration.coverage(0.9) == pytest.approx(np.full(len(fit.names), 0.9), abs=unsure)
    assert fit.calibration is not fit.trained.calibration


def test_a_network_is_kept_once(kept, tmp_path):
    fit, path = kept
    saved = cc.infer.save_network(fit, tmp_path / "mine.npz")
    assert saved.stat().st_size == pytest.approx(path.stat().st_size, rel=0.01)
    with pytest.raises(cc.InputError, match="not overwritten"):
        cc.infer.save_network(fit, saved)


def test_a_network_whose_weights_do_not_fit_is_refused(kept, bank, tmp_path):
    _, path = kept
    with np.load(path) as file:
        arrays = {name: file[name] for name in file.files}
    first = next(name for name in arrays if name.startswith("w:"))
    arrays[first] = np.zeros(7, np.float32)
    wrong = tmp_path / "network.npz"
    with wrong.open("wb") as file:
        np.savez(file, **arrays)
    before = wrong.read_bytes()
    with pytest.raises(cc.StorageError, match="damaged"):
        cc.infer.fit(cell(), bank, method="npe", network=wrong, **UNIT)
    assert wrong.read_bytes() == before
