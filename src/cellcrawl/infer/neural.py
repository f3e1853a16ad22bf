"""Neural posterior estimation by sbi, beside regression ABC: the two check each other.

Masked autoregressive flows (Papamakarios, Pavlakou & Murray, NIPS 2017) read the summaries, and
what the networks of ABC expect of them, each of a film that it has not seen. How far these are to
be trusted, how parameters hang together and how wide the posterior is, the flows learn themselves.

Flows are kept as a NumPy archive: arrays by name, and what they were trained on as JSON. Nothing is
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
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

import numpy as np

from cellcrawl.arguments import checked, file_path
from cellcrawl.errors import InputError, MissingExtraError, StorageError
from cellcrawl.infer import approximate
from cellcrawl.infer.approximate import Samples
from cellcrawl.infer.regression import Scaling
from cellcrawl.infer.result import Fit
from cellcrawl.infer.summaries import VERSION
from cellcrawl.infer.trained import Calibration, Trained, calibrated
from cellcrawl.validation import is_real

_SAMPLES: Final = 2000
_FLOWS: Final = 4  # trained apart, their samples together: one alone errs in its own way
_HIDDEN: Final = 50
_TRANSFORMS: Final = 5
_READ: Final = (256, 128, 8)  # nodes of the layers that read the summaries
_LEFT_OUT: Final = 0.1  # of their nodes, at each step
_BLUR: Final = 0.05  # of each number, in spreads, at each step
_RATE: Final = 1e-3
_DECAY: Final = 0.1
_HELD: Final = 10  # one run in so many says when a flow is best
_LAYOUT: Final = 2  # of the file
_KIND: Final = "cellcrawl network"
_EPOCHS: Final = 40
_MOST_KEPT: Final = 4
_ALIKE: Final = 0.02  # relative: microscopes that differ less are one
_kept: dict[tuple[int, int], tuple[Any, Any]] = {}  # views with their networks, for the next cell


class Estimate:
    """Trained flows, that give the posterior of a vector of summaries at once.

    Attributes
    ----------
    header : dict
        What they belong to.
    width : ndarray, shape (name,)
        Factors of the spread of each parameter, as in `Trained`.
    calibration : Calibration
        How posteriors of cells of the bank set apart stand to the truth.
    """

    width: np.ndarray | float = 1.0
    calibration: Calibration

    def __init__(self, taught: Trained, flows: list[Any], scaling: Scaling) -> None:
        self._taught, self._flows, self._scaling = taught, flows, scaling
        self.header = _header(taught)

    def posterior(self, summaries: np.ndarray, seed: int = 0) -> Samples:
        """Return samples of the posterior, equally weighted, as parts of the ranges."""
        torch = _torch()
        thought = self._taught.thought(summaries[None])
        x = torch.as_tensor(_inputs(self._scaling, summaries[None], thought))
        with torch.random.fork_rng(), torch.no_grad(), _one_thread(torch):
            torch.manual_seed(seed)
            drawn = [
                flow.sample((_SAMPLES // len(self._flows),), condition=x)[:, 0].numpy()
                for flow in self._flows
            ]
        part = approximate.expit(np.concatenate(drawn).astype(float))
        equal = np.full(len(part), 1.0 / len(part))
        samples = Samples(part, equal, np.zeros(len(part), int))
        return approximate.widened(samples, self.width)

    def save(self, path: Path) -> None:
        """Write weights and what they belong to, all or nothing."""
        arrays = {
            f"w:{number}:{name}": value.numpy()
            for number, flow in enumerate(self._flows)
            for name, value in flow.state_dict().items()
        }
        arrays |= {
            "middle": self._scaling.middle,
            "spread": self._scaling.spread,
            "width": np.asarray(self.width),
            "mean": self.calibration.mean,
            "rank": self.calibration.rank,
        }
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
    """Train flows on all looks but those set apart, and hold their width to these.

    Raises
    ------
    MissingExtraError
        Without sbi.
    """
    torch = _torch()
    view, scaling = taught.view, taught.alarm.scaling
    rows, thought = (
        np.concatenate([getattr(one, name) for one in taught.references])
        for name in ("rows", "seen")
    )
    theta = approximate.logit(view.part[rows]).astype(np.float32)
    x = _inputs(scaling, view.summaries[rows], thought)
    order = np.random.default_rng(seed).permutation(np.unique(view.run[rows]))
    flows = []
    with torch.random.fork_rng(), warnings.catch_warnings(), _one_thread(torch):
        warnings.simplefilter("ignore")
        for number in range(_FLOWS):
            torch.manual_seed(seed + number)
            held = np.isin(view.run[rows], order[number::_HELD])
            flows.append(_trained_flow(torch, theta, x, held))
    made = Estimate(taught, flows, scaling)
    tried = [made.posterior(summaries) for summaries in view.summaries[taught.aside]]
    made.width, made.calibration = calibrated(view, taught.aside, tried)
    return made


def _inputs(scaling: Scaling, summaries: np.ndarray, thought: np.ndarray) -> np.ndarray:
    """Return what flows read of films, shape (film, summary and name)."""
    expected = approximate.logit(thought, approximate.SEEN_EDGE)
    return np.column_stack([scaling(summaries), expected]).astype(np.float32)


def _trained_flow(torch: Any, theta: np.ndarray, x: np.ndarray, held: np.ndarray) -> Any:
    """Return a flow as it was when it told most of the runs that are held back."""
    parameters, inputs = torch.as_tensor(theta[~held]), torch.as_tensor(x[~held])
    parameters_held, inputs_held = torch.as_tensor(theta[held]), torch.as_tensor(x[held])
    flow = _new_flow(torch, parameters, inputs)
    weights = list(flow.parameters())
    batch = min(256, max(len(inputs) // 8, 16))
    steps = max(len(inputs) // batch, 1)
    descent = torch.optim.AdamW(weights, lr=_RATE, weight_decay=_DECAY)
    rate = torch.optim.lr_scheduler.OneCycleLR(
        descent, _RATE, total_steps=_EPOCHS * steps, pct_start=0.05
    )
    best, least = None, np.inf
    for _ in range(_EPOCHS):
        flow.train()
        order = torch.randperm(len(inputs))
        for step in range(steps):
            rows = order[step * batch : (step + 1) * batch]
            blurred = inputs[rows] + _BLUR * torch.randn_like(inputs[rows])
            descent.zero_grad()
            flow.loss(parameters[rows], condition=blurred).mean().backward()
            torch.nn.utils.clip_grad_norm_(weights, 5.0)
            descent.step()
            rate.step()
        flow.eval()
        with torch.no_grad():
            loss = float(flow.loss(parameters_held, condition=inputs_held).mean())
        if best is None or loss < least:
            best, least = {n: v.clone() for n, v in flow.state_dict().items()}, loss
    flow.load_state_dict(best)
    return flow.eval()


def _new_flow(torch: Any, theta: Any, x: Any) -> Any:
    """Return a flow of these shapes, not yet trained."""
    from sbi.neural_nets import posterior_nn

    unknowns = theta.shape[1]

    class Reader(torch.nn.Module):  # type: ignore[misc]
        """What ABC expects, as it is, and a few numbers read off everything."""

        def __init__(self) -> None:
            super().__init__()
            layers = []
            for below, above in pairwise((x.shape[1], *_READ)):
                layers += [torch.nn.Linear(below, above), torch.nn.Tanh()]
                layers.append(torch.nn.Dropout(_LEFT_OUT))
            self.layers = torch.nn.Sequential(*layers[:-2])

        def forward(self, given: Any) -> Any:
            return torch.cat([given[:, -unknowns:], self.layers(given)], dim=1)

    build = posterior_nn(
        "maf",
        hidden_features=_HIDDEN,
        num_transforms=_TRANSFORMS,
        z_score_x="none",
        embedding_net=Reader(),
    )
    return build(theta, x)


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
    wanted = _header(taught)
    arrays = _read(path, wanted)  # a file that is refused is so without sbi
    torch = _torch()
    unknowns = len(taught.view.names)
    random = torch.Generator().manual_seed(0)
    theta = torch.randn((64, unknowns), generator=random)
    x = torch.randn((64, taught.view.summaries.shape[1] + unknowns), generator=random)
    flows = []
    try:
        for number in range(_FLOWS):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                flow = _new_flow(torch, theta, x)
            start = f"w:{number}:"
            weights = {n: torch.as_tensor(v) for n, v in arrays.items() if n.startswith(start)}
            flow.load_state_dict({n.removeprefix(start): v for n, v in weights.items()})
            flows.append(flow.eval())
        kept = Estimate(taught, flows, Scaling(arrays["middle"], arrays["spread"]))
        kept.width = arrays["width"].reshape(unknowns)
        truth = taught.view.part[taught.aside]
        mean, rank = (arrays[name].reshape(truth.shape) for name in ("mean", "rank"))
        kept.calibration = Calibration(taught.view.names, truth, mean, rank)
        return kept
    except (RuntimeError, KeyError, ValueError):
        raise StorageError(f"{path} is damaged: its weights do not fit; train it anew") from None


def _read(path: Path, wanted: dict[str, Any]) -> dict[str, np.ndarray]:
    """Return the arrays of a file of networks, if it says of itself what is wanted."""
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
    return arrays


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


def _header(taught: Trained) -> dict[str, Any]:
    return {
        "kind": _KIND,
        "layout": _LAYOUT,
        "version": VERSION,
        "bank": taught.bank.digest,
        "microscope": taught.microscope.in_usual_units(),
        "unknown": list(taught.view.names),
        "summaries": int(taught.view.summaries.shape[1]),
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
