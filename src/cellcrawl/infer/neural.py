"""Neural posterior estimation by sbi, beside regression ABC: the two check each other.

A network is kept as a NumPy archive: arrays by name, and what it was trained on as JSON. Nothing is
unpickled.
"""

from __future__ import annotations

import contextlib
import importlib
import io
import json
import warnings
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

import numpy as np

from cellcrawl.arguments import checked, file_path
from cellcrawl.errors import InputError, MissingExtraError, StorageError
from cellcrawl.infer.approximate import Samples
from cellcrawl.infer.regression import Scaling
from cellcrawl.infer.result import Fit
from cellcrawl.infer.summaries import VERSION
from cellcrawl.infer.trained import Trained
from cellcrawl.validation import is_real

_SAMPLES: Final = 2000
_HIDDEN: Final = 50
_TRANSFORMS: Final = 5
_KIND: Final = "cellcrawl network"
_EPOCHS: Final = 200
_EDGE: Final = 1e-3
_MOST_KEPT: Final = 4
_ALIKE: Final = 0.02  # relative: microscopes that differ less are one
_kept: dict[tuple[int, int], tuple[Any, Any]] = {}  # views with their networks, for the next cell


class _Silent:
    """What sbi tells of its training, kept nowhere: it would write to the folder one is in."""

    log_dir = None

    def log_metric(self, name: str, value: float, step: int | None = None) -> None: ...
    def log_metrics(self, metrics: dict[str, float], step: int | None = None) -> None: ...
    def log_params(self, params: dict[str, Any]) -> None: ...
    def add_figure(self, name: str, figure: Any, step: int | None = None) -> None: ...
    def flush(self) -> None: ...


class Estimate:
    """A trained network, that gives the posterior of a vector of summaries at once."""

    def __init__(self, network: Any, scaling: Scaling, header: dict[str, Any]) -> None:
        self._network, self._scaling, self.header = network, scaling, header

    def posterior(self, summaries: np.ndarray, seed: int = 0) -> Samples:
        """Return samples of the posterior, equally weighted, as parts of the ranges."""
        torch = _torch()
        x = torch.as_tensor(self._scaling(summaries[None]))
        with torch.random.fork_rng(), torch.no_grad():
            torch.manual_seed(seed)
            drawn = self._network.sample((_SAMPLES,), condition=x).reshape(_SAMPLES, -1).numpy()
        part = 0.5 * (1.0 + np.tanh(0.5 * drawn.astype(float)))
        return Samples(part, np.full(_SAMPLES, 1.0 / _SAMPLES), np.zeros(_SAMPLES, int))

    def save(self, path: Path) -> None:
        """Write weights and what they belong to, all or nothing."""
        arrays = {f"w:{n}": v.numpy() for n, v in self._network.state_dict().items()}
        arrays |= {"middle": self._scaling.middle, "spread": self._scaling.spread}
        text = json.dumps(self.header).encode()
        stream = io.BytesIO()
        np.savez(stream, header=np.frombuffer(text, np.uint8), **arrays)
        temporary = path.with_name(f".{path.name}.tmp")
        try:
            temporary.write_bytes(stream.getvalue())
            temporary.replace(path)
        except OSError as error:
            temporary.unlink(missing_ok=True)
            raise StorageError(f"cannot write {path}: {error.strerror or error}") from None


def train_estimate(taught: Trained, seed: int = 0) -> Estimate:
    """Train a network on all looks but those set apart.

    Raises
    ------
    MissingExtraError
        Without sbi.
    """
    torch = _torch()
    view = taught.view
    rows = np.setdiff1d(
        np.arange(len(view.run)), np.flatnonzero(np.isin(view.run, view.run[taught.aside]))
    )
    scaling = taught.alarm.scaling
    inner = np.clip(view.part[rows], _EDGE, 1.0 - _EDGE)
    theta = torch.as_tensor(np.log(inner / (1.0 - inner)).astype(np.float32))
    x = torch.as_tensor(scaling(view.summaries[rows]))
    from sbi.inference import NPE
    from sbi.neural_nets import posterior_nn

    silent = contextlib.redirect_stdout(io.StringIO())
    with torch.random.fork_rng(), warnings.catch_warnings(), _one_thread(torch), silent:
        warnings.simplefilter("ignore")
        torch.manual_seed(seed)
        trainer = NPE(
            density_estimator=posterior_nn(
                "maf", hidden_features=_HIDDEN, num_transforms=_TRANSFORMS
            ),
            show_progress_bars=False,
            tracker=_Silent(),
        )
        network = trainer.append_simulations(theta, x).train(
            training_batch_size=min(256, max(len(rows) // 8, 16)), max_num_epochs=_EPOCHS
        )
    network.eval()
    return Estimate(network, scaling, _header(taught, theta.shape[1], x.shape[1]))


def estimate_of(taught: Trained, seed: int = 0, path: Path | None = None) -> Estimate:
    """Return a network for these films: from a file if it is there, else trained, and kept there.

    Raises
    ------
    InputError, StorageError
        As `load_estimate`; the file is left as it is.
    """
    if path is not None and path.exists():
        return load_estimate(path, taught)
    key = (id(taught.view), seed)
    found = _kept.get(key)
    if found is None or found[0] is not taught.view:
        found = (taught.view, train_estimate(taught, seed))
        while len(_kept) >= _MOST_KEPT:
            _kept.pop(next(iter(_kept)))
        _kept[key] = found
    if path is not None:
        found[1].save(path)
    return found[1]


def load_estimate(path: Path, taught: Trained) -> Estimate:
    """Read a network that was trained on the same bank through the same microscope.

    Raises
    ------
    InputError
        For a network of another bank, microscope or version.
    StorageError
        If the file is no network, or damaged.
    """
    wanted = _header(taught, taught.view.part.shape[1], taught.view.summaries.shape[1])
    header, arrays = _read(path, wanted)  # a file that is refused is so without sbi
    torch = _torch()
    from sbi.neural_nets import posterior_nn

    random = torch.Generator().manual_seed(0)
    theta = torch.randn((64, wanted["unknowns"]), generator=random)
    x = torch.randn((64, wanted["summaries"]), generator=random)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        network = posterior_nn("maf", hidden_features=_HIDDEN, num_transforms=_TRANSFORMS)(theta, x)
    weights = {n[2:]: torch.as_tensor(v) for n, v in arrays.items() if n.startswith("w:")}
    try:
        network.load_state_dict(weights)
        scaling = Scaling(arrays["middle"], arrays["spread"])
    except (RuntimeError, KeyError):
        raise StorageError(f"{path} is damaged: its weights do not fit; train it anew") from None
    network.eval()
    return Estimate(network, scaling, header)


def _read(path: Path, wanted: dict[str, Any]) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """Return what a file of a network says of itself, if it says what is wanted, and its arrays."""
    try:
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
            header = json.loads(bytes(file["header"]))
            arrays = {name: file[name] for name in file.files if name != "header"}
            if not isinstance(header, dict):
                raise TypeError
    except FileNotFoundError:
        raise InputError(f"there is no network {path}") from None
    except (OSError, ValueError, KeyError, TypeError, AttributeError, zipfile.BadZipFile, EOFError):
        raise StorageError(
            f"{path} is no network of cellcrawl, or damaged: train it anew; nothing in it was run"
        ) from None
    for name, told in wanted.items():
        if not _same(header.get(name), told):
            raise InputError(
                f"{path} is a network of another {name}: give another file, where one is trained "
                "and kept; it is not overwritten"
            )
    return header, arrays


def _same(given: Any, wanted: Any) -> bool:
    """Whether a header says the same; numbers of the microscope within two percent."""
    if not isinstance(wanted, dict):
        return bool(given == wanted)
    if not isinstance(given, dict) or given.keys() != wanted.keys():
        return False
    return all(
        is_real(given[name]) and abs(given[name] - value) <= _ALIKE * abs(value)
        for name, value in wanted.items()
    )


@checked
def save_network(fit: Fit, path: str | Path) -> Path:
    """Keep the network behind a fit by ``method="npe"`` in a file, with its bank's hash.

    Parameters
    ----------
    fit : Fit
    path : str or Path
        The file, ``.npz``. One that is there is not overwritten.

    Raises
    ------
    InputError
        For a fit by another method, or a file that is there.
    StorageError
        If it cannot be written.

    See Also
    --------
    cellcrawl.infer.fit : Its argument ``network`` reads the file.
    """
    if fit.method != "npe":
        raise InputError("only a fit by method='npe' has a network to keep")
    target = file_path("path", path)
    if target.exists():
        raise InputError(f"{target} is there already: give another file; it is not overwritten")
    fit.estimate.save(target)
    return target


def _header(taught: Trained, unknowns: int, summaries: int) -> dict[str, Any]:
    return {
        "kind": _KIND,
        "version": VERSION,
        "bank": taught.bank.digest,
        "microscope": taught.microscope.in_usual_units(),
        "unknown": list(taught.view.names),
        "unknowns": int(unknowns),
        "summaries": int(summaries),
    }


@contextlib.contextmanager
def _one_thread(torch: Any) -> Iterator[None]:
    """Matrices are small: threads would wait for each other more than they work."""
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)


def _torch() -> Any:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            importlib.import_module("sbi.inference")
            import torch
    except ImportError:
        raise MissingExtraError(
            "method='npe' needs sbi: install it with pip install 'cellcrawl[infer]'"
        ) from None
    return torch
