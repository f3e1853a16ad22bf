"""Lyapunov exponents: how fast two nearly alike cells grow apart, and what a cell does for good.

Two cells are carried on side by side and brought near each other again and again. Shapes have no
place, direction or first node, so that those zero exponents are not there; the one of time is taken
out across the pace of the shape. What is left is the growth rate of a steady cell, ``log |mu| / T``
of an orbit, 0 of a cell with two rhythms, and above 0 of a chaotic one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.branches.circle import circle
from cellcrawl.branches.flow import Flow
from cellcrawl.branches.setting import Setting
from cellcrawl.branches.shooting import scaled, unscaled
from cellcrawl.branches.starting import last_of, polished
from cellcrawl.branches.system import NotFound
from cellcrawl.curve import Curve
from cellcrawl.errors import InputError
from cellcrawl.laws.law import PAPER
from cellcrawl.parameters import Parameters
from cellcrawl.starts import RandomPerturbation
from cellcrawl.starts.base import CellState, Start
from cellcrawl.threads import on_one_thread
from cellcrawl.validation import real_number, whole_number

if TYPE_CHECKING:
    from cellcrawl.branches.state import SteadyState

NODES: Final = (192, 256, 384, 512)
_LOOKS = 15
_APART = 1e-6
_PAUSE = 0.5  # time between two measurements
_STEP = 0.01
_TAIL = 3e-4  # share of the shortest waves
_RELAXES = 0.01  # pace of a shape that may be about to be steady
_NEAR = 0.1
_RESTS = 2e-3  # pace of a shape that is steady or soon will be
_STILL = 1e-6
_COUNTED, _COUNTED_HELD = 0.8, 0.3  # part of the time that counts, the last
_BATCHES = 8
_T95 = 2.36  # Student's factor for so many batches
_T95_OF: Final = {2: 12.7, 3: 4.3, 4: 3.18, 5: 2.78, 6: 2.57, 7: 2.45, 8: 2.36, 9: 2.31, 10: 2.26}
_ROUND = 1e-3  # spread of the bound fraction along a round cell's edge
_CLEAR = 0.003  # rate below which growth is not told from none
_WILD = 0.02  # rate at which a while counts as irregular
_WHILE = 40.0
_LEAST, _EVERY = 240, 120  # pauses before a first and another look whether small changes decay
_SURE = 0.01  # rate of decay that ends an early measurement
ZEROS: Final = ("time", "direction", "place", "first node")
LABELS: Final = {
    "steady glide": "keeps its shape and goes straight",
    "steady spin": "keeps its shape and turns at a constant rate",
    "at rest": "a circle that stays",
    "breathing at rest": "a circle that swells and shrinks in place",
    "periodic": "its shape repeats, perhaps mirrored",
    "quasi-periodic": "two rhythms that never fall together; small changes neither grow nor decay",
    "irregular for a while": "small changes grew for long, and then the cell settled",
    "chaotic": "small changes grow for good: no forecast beyond a few turns",
    "undecided": "growth is not told from none in the time it was measured: give a longer t_end",
    "torn": "the cell tore or left the model",
}


@dataclass(frozen=True, eq=False)
class LyapunovExponent:
    """The largest exponent beside the known zeros, and what it says of the cell.

    Attributes
    ----------
    value, error : float
        Rate of growth of small changes and its 95 % half-width, from batches in time.
    label : str
        One of `cellcrawl.branches.LABELS`.
    zeros : tuple of str
        What has an exponent of 0 in any cell and is taken out: time, direction, place, first node.
    time : float
        For how long growth was measured.
    course : array, shape (measurements,)
        Rate over each pause of half a time unit.
    """

    value: float
    error: float
    label: str
    time: float
    course: np.ndarray
    zeros: tuple[str, ...] = ZEROS

    def __repr__(self) -> str:
        return f"LyapunovExponent({self.value:.4f} +- {self.error:.4f}, {self.label})"


@checked
@on_one_thread
def lyapunov_exponent(
    parameters: Parameters,
    *,
    start: Any = None,
    t_end: float = 1200.0,
    settle: float = 60.0,
    laws: Any = None,
    nodes: int | None = None,
    early: bool = False,
    runs: int = 1,
) -> LyapunovExponent:
    """Return the largest Lyapunov exponent of a cell, the known zeros taken out.

    Parameters
    ----------
    parameters : Parameters
    start : Start, optional
        As for `simulate`; a steady state or orbit is taken as it is, others first run for
        ``settle``. ``RandomPerturbation(seed=1)`` unless given.
    t_end : float
        For how long growth is measured, 40 to 1e6; the error shrinks with its root, or faster where
        nothing is chaotic.
    settle : float
        Time that a cell is given first, 0 to 1e6.
    nodes : int, optional
        Even nodes along the edge, a multiple of 8 from 64; 192 to 512 by the shape unless given.
    early : bool
        Stop, from a time of 120 on, once small changes decay beyond doubt: at more than 0.01 in the
        second half, error included. A stable steady state has its leading growth rate, with no
        error and no time. Growth is measured to the end: it may be of a while only.
    runs : int
        Take the mean over random starts of seeds 1 to this, 1 to 1000, and the error from how far
        they lie apart. An intermittent cell keeps to one way of moving for long: stretches of one
        run are then too much alike, and the error they give is too small.

    Raises
    ------
    InputError
        For values out of range. A cell that tears is no error: its label is "torn".

    Notes
    -----
    Two trajectories in the space of shapes, `_APART` from each other (Benettin et al., Meccanica
    15, 1980), by stabilised Runge-Kutta steps of order 2. At the low end of zigzag the asymmetry
    between two turns falls to 1e-6: there the exponent of a run is that of the turns it made.
    """
    t_end = real_number("t_end", t_end, 40.0, 1e6)
    settle = real_number("settle", settle, 0.0, 1e6)
    from cellcrawl.branches.orbit import Orbit, nodes_or_none
    from cellcrawl.branches.state import SteadyState

    nodes = nodes_or_none(nodes)
    count = whole_number("runs", runs, 1, 1000)
    if count > 1:
        if start is not None:
            raise InputError("runs = 2 and more have random starts of their own: leave out start")
        return _together(
            [
                lyapunov_exponent(
                    parameters, start=RandomPerturbation(seed=seed), t_end=t_end, settle=settle,
                    laws=laws, nodes=nodes, early=early,
                )
                for seed in range(1, count + 1)
            ]
        )  # fmt: skip
    try:
        if isinstance(start, Orbit | SteadyState):
            setting = start.setting
            if setting.parameters != parameters:
                setting = Setting(parameters, setting.laws, setting.rest_area)
            cell = start.state(parameters, 1024)
            held = isinstance(start, SteadyState) and setting.parameters == start.parameters
        else:
            setting, cell, state = _settled(parameters, start, settle, laws)
            held = state is not None
            if state is not None and early:
                return _of_state(state)
        flow, shape = _resolved(setting, cell, nodes)
        return _measured(flow, shape, t_end, held, early)
    except NotFound:
        return LyapunovExponent(math.nan, math.nan, "torn", 0.0, np.zeros(0))


def _together(found: Sequence[LyapunovExponent]) -> LyapunovExponent:
    """Return the mean of runs with the larger of its errors, by the spread and by the runs' own."""
    values = np.array([one.value for one in found])
    count = values.size
    spread = _T95_OF.get(count, 2.0) * float(np.std(values, ddof=1)) / math.sqrt(count)
    own = math.sqrt(sum(one.error**2 for one in found)) / count
    value, error = float(values.mean()), max(spread, own)
    labels = [one.label for one in found]
    label = max(LABELS, key=labels.count)
    if value > max(error, _CLEAR):
        label = "chaotic"
    elif label == "chaotic":
        label = "undecided"
    course = np.concatenate([one.course for one in found])
    return LyapunovExponent(value, error, label, sum(one.time for one in found), course)


def _resolved(setting: Setting, cell: CellState, nodes: int | None) -> tuple[Flow, np.ndarray]:
    """Return a cell's shape on the nodes given, or on as few as its next shapes allow."""
    if nodes is not None:
        flow = Flow(setting, nodes)
        return flow, flow.from_cell(cell)
    fine = Flow(setting, NODES[-1])
    shapes = [fine.from_cell(cell)]
    fastest = fine.stiffness(shapes[0])
    for _ in range(_LOOKS):
        shapes.append(fine.after_stabilised(shapes[-1], 2.0 * _PAUSE, 0.02, fastest).shape)
    for count in NODES:
        flow = Flow(setting, count)
        if max(flow.tail(fine.resampled(shape, count)) for shape in shapes) < _TAIL:
            break
    return flow, flow.from_cell(cell)


def _settled(
    parameters: Parameters, start: Start | None, settle: float, laws: Any
) -> tuple[Setting, CellState, SteadyState | None]:
    """Return a cell after a while, or the stable steady state that it comes to."""
    from cellcrawl.simulation import simulate

    first = RandomPerturbation(seed=1) if start is None else start
    long = max(settle, 1e-3)
    run = simulate(
        parameters, long, start=first, laws=PAPER if laws is None else laws, save_every=long,
        nodes=512,
    )  # fmt: skip
    if run.attrs["status"] != "completed":
        raise NotFound(run.attrs["status"])
    setting, theta, n, length, sigma = last_of(run, "lyapunov_exponent")
    cell = CellState(Curve(theta, length).closed(), n, sigma)
    flow = Flow(setting, 512)
    shape = flow.from_cell(cell)
    if flow.norm(flow.pace(shape)) > _RELAXES:
        return setting, cell, None
    try:  # a shape that still relaxes has its slowest change along its pace
        state = polished(setting, theta, n, length, sigma)
    except InputError:
        return setting, cell, None
    if np.ptp(state.fields.n) < _ROUND and setting.rest_area == math.pi:
        state = circle(parameters, laws=setting.laws)
    exact = state.state(parameters, 1024)
    if flow.norm(flow.from_cell(exact) - shape) > _NEAR or not state.stable:
        return setting, cell, None  # near an unstable state a cell is only on its way
    return setting, exact, state


def _of_state(state: SteadyState) -> LyapunovExponent:
    from cellcrawl.branches.state import AT_REST, TURNING

    label = {AT_REST: "at rest", TURNING: "steady spin"}.get(state.kind, "steady glide")
    return LyapunovExponent(float(state.eigenvalues[0].real), 0.0, label, 0.0, np.zeros(0))


def _measured(
    flow: Flow, shape: np.ndarray, t_end: float, held: bool, early: bool
) -> LyapunovExponent:
    fastest = flow.stiffness(shape)
    rng = np.random.default_rng(0)
    count = math.ceil(t_end / _PAUSE)
    course = np.zeros(count)
    pace = scaled(flow.pace(shape))
    change = flow.canonical(shape + 1e-3 * unscaled(_smooth(flow.nodes, rng))) - shape
    vector = _across(scaled(change), pace, held)
    turned, paces, spreads = 0.0, [], []
    part = _COUNTED_HELD if held else _COUNTED
    home = flow.after_stabilised(shape, _PAUSE, _STEP, fastest)
    for k in range(count):
        there = flow.after_stabilised(shape + _APART * unscaled(vector), _PAUSE, _STEP, fastest)
        grown = scaled(there.shape - home.shape) / _APART
        turned += home.turn
        if not held:
            shape = home.shape
            pace = scaled(flow.pace(shape))
            if k % 100 == 99:
                fastest = flow.stiffness(shape)
        image = _across(grown, pace, held, unit=False)
        size = float(np.linalg.norm(image))
        course[k] = math.log(max(size, 1e-300)) / _PAUSE
        vector = image / size
        if not held:
            paces.append(float(np.linalg.norm(pace)))
            spreads.append(float(np.ptp(shape[flow.nodes : 2 * flow.nodes])))
            home = flow.after_stabilised(shape, _PAUSE, _STEP, fastest)
            done = k + 1
            looks = early and done >= _LEAST and done % _EVERY == 0
            if looks and _decays(course[done // 2 : done]):
                course, count, part = course[:done], done, 0.5
                break
    counted = course[count - int(part * count) :]
    value, error = _batched(counted)
    if held:
        spin = abs(home.turn) / _PAUSE
        round_one = np.ptp(shape[flow.nodes : 2 * flow.nodes]) < _ROUND
        label = "at rest" if round_one else "steady spin" if spin > 1e-5 else "steady glide"
    else:
        late = slice(count // 2, None)
        label = _label(course, value, error, paces[late], spreads[late], turned)
    return LyapunovExponent(value, error, label, _PAUSE * count, course)


def _smooth(nodes: int, rng: np.random.Generator) -> np.ndarray:
    """Return a random change of a few long waves."""
    place = 2.0 * math.pi * np.arange(nodes) / nodes
    parts = [
        sum(
            (rng.normal() * np.cos(k * place) + rng.normal() * np.sin(k * place) for k in range(9)),
            np.zeros(nodes),
        )
        for _ in range(2)
    ]
    return scaled(np.concatenate([*parts, [0.1]]))


def _across(vector: np.ndarray, pace: np.ndarray, held: bool, *, unit: bool = True) -> np.ndarray:
    """Return the part of a change across the pace, which is none at a steady state."""
    square = float(pace @ pace)
    if not held and square > _STILL**2:
        vector = vector - (vector @ pace) / square * pace
    return vector / float(np.linalg.norm(vector)) if unit else vector


def _decays(course: np.ndarray) -> bool:
    value, error = _batched(course)
    return value + error < -_SURE


def _batched(course: np.ndarray) -> tuple[float, float]:
    """Rate and its 95 % half-width, from slopes of the logarithm in batches of time.

    Slopes, not ends: a rhythm of the cell, in which changes grow and shrink again, is no trend.
    """
    size = course.size // _BATCHES
    time = _PAUSE * np.arange(size)
    slopes = [
        float(np.polyfit(time, _PAUSE * np.cumsum(course[k * size : (k + 1) * size]), 1)[0])
        for k in range(_BATCHES)
    ]
    return float(np.mean(slopes)), float(_T95 * np.std(slopes, ddof=1) / math.sqrt(_BATCHES))


def _label(
    course: np.ndarray,
    value: float,
    error: float,
    paces: Sequence[float],
    spreads: Sequence[float],
    turned: float,
) -> str:
    """Tell what the cell does for good."""
    if max(paces) < _RESTS:
        if max(spreads) < _ROUND:
            return "at rest"
        spin = abs(turned) / (_PAUSE * course.size)
        return "steady spin" if spin > 1e-3 else "steady glide"
    if max(spreads) < _ROUND:
        return "breathing at rest"
    clear = max(error, _CLEAR)
    wide = round(_WHILE / _PAUSE)
    smooth = np.convolve(course, np.full(wide, 1.0 / wide), mode="valid")
    third = max(smooth.size // 3, 1)
    wild, calm = np.max(smooth[: 2 * third]) > _WILD, np.max(smooth[-third:]) < _WILD / 2.0
    if wild and calm and value < _WILD:
        return "irregular for a while"
    if value > clear:
        return "chaotic"
    if value < -clear:
        return "periodic"
    return "quasi-periodic" if clear < 3.0 * _CLEAR else "undecided"
