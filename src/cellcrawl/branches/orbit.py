"""Cells whose shape repeats: zigzag, rotation and figure-eights as relative periodic orbits."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.branches.flow import Flow
from cellcrawl.branches.setting import Setting
from cellcrawl.branches.shooting import (
    COARSE,
    Basis,
    Found,
    close,
    multipliers,
)
from cellcrawl.branches.starting import last_of
from cellcrawl.branches.system import NotFound
from cellcrawl.curve import Curve
from cellcrawl.errors import InputError
from cellcrawl.numerics import fourier
from cellcrawl.parameters import Parameters
from cellcrawl.starts.base import CellState
from cellcrawl.threads import on_one_thread
from cellcrawl.validation import whole_number

if TYPE_CHECKING:
    from cellcrawl.branches.orbit_branch import OrbitBranch

ZIGZAG, FIGURE_EIGHT, ROTATION, BREATHING = "zigzag", "figure-eight", "rotation", "breathing"
LOPSIDED = "lopsided zigzag"
_LOOK = 0.1  # time between two looks for a return
_QUICK = 0.02
_PATIENCE = 150.0
_AHEAD = 40.0
_SHORTEST = 0.5
_NEAR, _NEAREST = 0.08, 0.3  # of the largest distance on the way
_RESTS = 1e-3
_FAR = 0.3
_ROUND = 1e-5  # spread of the bound fraction along the edge
_SAMPLES: Final = 256
_FINER = 64
_STRAIGHT = 1e-6  # rad a period
_BOTH_WAYS = 0.1
_MARGINAL = 1e-5
_MOMENT = 1e-5  # time over which rates of a moving cell are taken


class _Flown(NamedTuple):
    """An orbit's states at equal times over one return, and how far the cell has turned."""

    states: list[np.ndarray]
    turn: float
    """Of the front over a return, in rad."""
    both_ways: float
    """Share of its turning that goes against the rest."""
    paces: np.ndarray
    """Speed of the centroid and rate of turning of the front, shape (states, 2)."""


@dataclass(frozen=True, eq=False)
class Orbit:
    """A cell whose shape comes back after a period, moved, turned, and perhaps as its mirror image.

    Made by `orbit` and as a point of an `OrbitBranch`; immutable. As a start it is the cell at the
    orbit's first instant.

    Attributes
    ----------
    setting : Setting
        Parameters, laws and the family of tension and area.
    reflected : bool
        Whether the cell comes back as its mirror image: left and right alike, as in a zigzag. All
        times, turns and multipliers are those of one such return, half a cycle from left to left.
    period : float
        Time of one return: the period of the tension.
    nodes : int
        Even nodes along the edge on which it closes.
    residual : float
        By how much it misses itself, in the mean over the edge.
    """

    setting: Setting
    reflected: bool
    shape: np.ndarray
    period: float
    nodes: int
    steps: int
    residual: float
    basis: Basis = field(repr=False)
    _kept: dict[str, Any] = field(default_factory=dict, repr=False)

    @classmethod
    def of(cls, setting: Setting, reflected: bool, found: Found) -> Orbit:
        """Return the orbit that shooting found."""
        return cls(
            setting, reflected, found.shape, found.period, found.nodes, found.steps,
            found.residual, found.basis,
        )  # fmt: skip

    @property
    def parameters(self) -> Parameters:
        """Parameters of the cell."""
        return self.setting.parameters

    @property
    def cycle(self) -> float:
        """Time until the cell does the same to the same side: two periods of a zigzag."""
        return 2.0 * self.period if self.reflected else self.period

    def _spectrum(self) -> None:
        if "multipliers" not in self._kept:
            found = Found(
                self.shape, self.period, 0.0, self.nodes, self.steps, self.residual, 0.0, 0.0,
                self.basis,
            )  # fmt: skip
            self._kept["multipliers"], self._kept["neutral"], _ = _multipliers(
                self.setting, self.reflected, found
            )

    @property
    def multipliers(self) -> np.ndarray:
        """Floquet multipliers of one return, complex, the largest first; those that last.

        Without those of time, rotation and relabelling, which are 1 (-1 for the last two of a
        reflected orbit) and are taken out; `neutral_multipliers` says how well the first is met.
        """
        self._spectrum()
        return np.asarray(self._kept["multipliers"])

    @property
    def neutral_multipliers(self) -> np.ndarray:
        """Multiplier measured for a shift in time: 1 but for the error of the computation."""
        self._spectrum()
        return np.array([self._kept["neutral"]])

    @property
    def stable(self) -> bool:
        """Whether all small changes decay."""
        return bool(np.all(np.abs(self.multipliers) < 1.0 + _MARGINAL))

    @property
    def unstable_modes(self) -> int:
        """Number of multipliers of modulus above 1."""
        return int(np.sum(np.abs(self.multipliers) > 1.0 + _MARGINAL))

    @cached_property
    @on_one_thread
    def _flown(self) -> _Flown:
        flow = Flow(self.setting, self.nodes)
        state = flow.state_of(self.shape)
        states, turns = [state], [flow.shape_of(state).turn]
        steps = math.ceil(self.steps / _SAMPLES)
        for _ in range(_SAMPLES):
            state = flow.state_after(state, self.period / _SAMPLES, steps)
            states.append(state)
            turns.append(flow.shape_of(state).turn)
        unwrapped = np.unwrap(turns)
        parts = np.diff(unwrapped)
        ways = float(np.sum(parts[parts > 0.0])), float(-np.sum(parts[parts < 0.0]))
        share = min(ways) / max(sum(ways), 1e-300)
        paces = np.array([_pace(flow, state) for state in states])
        return _Flown(states, float(unwrapped[-1] - unwrapped[0]), share, paces)

    @cached_property
    def _cells(self) -> list[CellState]:
        flow = Flow(self.setting, self.nodes)
        return [flow.cell(state, self.nodes) for state in self._flown.states]

    @property
    def turn(self) -> float:
        """Angle by which the front turns in one return, in rad, positive to the left."""
        return self._flown.turn

    @property
    def turning_rate(self) -> float:
        """Mean rate of turning, in rad: 0 where left and right are alike."""
        return 0.0 if self.reflected else self.turn / self.period

    @property
    def kind(self) -> str:
        """What the cell does.

        "zigzag" or, where it turns by more than half a circle to each side, "figure-eight";
        "lopsided zigzag" if it turns both ways, not alike; "rotation" if one way; "breathing" if it
        goes straight or rests.
        """
        if self.reflected:
            return FIGURE_EIGHT if abs(self.turn) > math.pi else ZIGZAG
        if abs(self.turn) < _STRAIGHT:
            return BREATHING
        return LOPSIDED if self._flown.both_ways > _BOTH_WAYS else ROTATION

    @property
    def speed_range(self) -> tuple[float, float]:
        """Least and largest speed of the centroid."""
        return _extremes(self._flown.paces[:, 0])

    @property
    def turning_rate_range(self) -> tuple[float, float]:
        """Least and largest rate at which the front turns, in rad, over a whole `cycle`."""
        low, high = _extremes(self._flown.paces[:, 1])
        if self.reflected:
            most = max(-low, high)
            return -most, most
        return low, high

    @property
    def tension_range(self) -> tuple[float, float]:
        """Least and largest membrane tension."""
        low, high = _extremes(np.array([cell.tension for cell in self._cells]))
        return low, high

    @property
    def tension(self) -> float:
        """Mean membrane tension."""
        return float(np.mean([cell.tension for cell in self._cells[:-1]]))

    @property
    def circularity(self) -> float:
        """Mean of ``4 pi A / L^2``."""
        return float(np.mean([cell.curve.circularity for cell in self._cells[:-1]]))

    @property
    def circularity_range(self) -> tuple[float, float]:
        """Least and largest ``4 pi A / L^2``."""
        return _extremes(np.array([cell.curve.circularity for cell in self._cells]))

    @cached_property
    def speed(self) -> float:
        """Mean speed of the centroid along its path."""
        places = np.array([cell.curve.centroid for cell in self._cells])
        chords = np.hypot(*np.diff(places, axis=0).T)
        doubled = np.hypot(*np.diff(places[::2], axis=0).T)
        # chords of half the step tell by how much the chords cut the curve short
        return float((4.0 * chords.sum() - doubled.sum()) / (3.0 * self.period))

    @checked
    def state(self, parameters: Parameters, nodes: int) -> CellState:
        """Return the cell at the orbit's first instant, as a start for `simulate`."""
        whole_number("nodes", nodes, 16, 1_000_000)
        flow = Flow(self.setting, self.nodes)
        even = nodes + nodes % 2
        cell = flow.cell(flow.state_of(self.shape), even)
        if even != nodes:
            from cellcrawl.branches.mesh import even_samples

            angle = 2.0 * math.pi * np.arange(nodes) / nodes
            n = even_samples(cell.bound_fraction, angle)
            cell = CellState(cell.curve.resampled(nodes), np.clip(n, 0.0, 1.0), cell.tension)
        return CellState(cell.curve.moved(-cell.curve.centroid), cell.bound_fraction, cell.tension)

    def describe(self) -> dict[str, Any]:
        """Return what this start is, as plain values for JSON."""
        return {
            "kind": "Orbit",
            "parameters": self.parameters.to_dict(),
            "laws": self.setting.laws.describe(),
            "rest_area": self.setting.rest_area,
            "period": self.period,
            "reflected": self.reflected,
        }

    @checked
    @on_one_thread
    def dataset(self, nodes: int = 256, records: int = 65) -> xr.Dataset:
        """Return a whole `cycle` as a run, for pictures and observables.

        Parameters
        ----------
        nodes, records : int
            Nodes along the edge and instants, both ends included, 3 to 10000.
        """
        from cellcrawl.branches.records import record_of, run_of

        even = whole_number("nodes", nodes, 16, 1_000_000)
        count = whole_number("records", records, 3, 10_000)
        if even % 2:
            raise InputError(f"nodes = {nodes} must be even")
        flow = Flow(self.setting, self.nodes)
        state = flow.state_of(self.shape)
        centre = flow.cell(state, self.nodes).curve.centroid
        pause = self.cycle / (count - 1)
        steps = math.ceil(self.steps * pause / self.period)
        made = []
        for k in range(count):
            if k > 0:
                state = flow.state_after(state, pause, steps)
            cell = flow.cell(state, even)
            cell = CellState(cell.curve.moved(-centre), cell.bound_fraction, cell.tension)
            made.append(record_of(self.setting, cell, 3.0))
        return run_of(
            made, pause * np.arange(count), self.setting, self.describe(), "orbit",
            "a periodic orbit, by Newton's method",
        )  # fmt: skip

    def continue_in(self, name: str, to: float, **options: Any) -> OrbitBranch:
        """Follow the orbit as a parameter changes; see `continue_orbit`."""
        from cellcrawl.branches.orbit_branch import continue_orbit

        return continue_orbit(self, name, to, **options)

    def __repr__(self) -> str:
        p = self.parameters
        spin = "" if self.reflected else f", {self.turn:.5g} rad a period"
        return (
            f"Orbit({self.kind}, r_on={p.r_on:g}, zeta_1={p.zeta_1:g}: period {self.period:.6g}"
            f"{spin}, speed {self.speed:.5g})"
        )


_multipliers = on_one_thread(multipliers)


def _pace(flow: Flow, state: np.ndarray) -> tuple[float, float]:
    """Return the speed of a cell's centroid and the rate at which its front turns."""
    rates, nodes = flow.rates(state), flow.nodes
    ends = [state + sign * _MOMENT * rates for sign in (1.0, -1.0)]
    places = [flow.cell(end, nodes).curve.centroid for end in ends]
    turns = [flow.shape_of(end).turn for end in ends]
    apart = float(np.hypot(*(places[0] - places[1])))
    turned = (turns[0] - turns[1] + math.pi) % (2.0 * math.pi) - math.pi
    return apart / (2.0 * _MOMENT), turned / (2.0 * _MOMENT)


def _extremes(values: np.ndarray) -> tuple[float, float]:
    """Least and largest over a period of samples with both ends, between the samples too."""
    fine = fourier.resample(values[:-1], _FINER * (values.size - 1))
    return float(fine.min()), float(fine.max())


def nodes_or_none(nodes: int | None) -> int | None:
    """Return a number of even nodes that the kernels take, if any is given."""
    if nodes is None:
        return None
    whole_number("nodes", nodes, 64, 4096)
    if nodes % 8:
        raise InputError(f"nodes = {nodes} must be a multiple of 8")
    return nodes


@checked
@on_one_thread
def orbit(run: xr.Dataset, *, rest_area: float | None = None, nodes: int | None = None) -> Orbit:
    """Return the periodic orbit at the end of a run: a cell whose shape repeats.

    Parameters
    ----------
    run : Dataset
        A run that ends near such an orbit, stable or not: a zigzag, a rotation, a figure-eight.
    rest_area : float, optional
        As in `from_run`.
    nodes : int, optional
        Even nodes along the edge, a multiple of 8 from 64; as many as the shape asks for unless
        given, 256 to 1024.

    Raises
    ------
    InputError
        If the run has torn, rests or glides steadily, does not come back near itself, or Newton's
        method leads elsewhere.
    """
    nodes = nodes_or_none(nodes)
    setting, theta, n, length, sigma = last_of(run, "orbit", rest_area)
    if np.ptp(n) < _ROUND:
        raise InputError(
            "the cell is round at the end of this run: it rests or breathes in place, and has no "
            "front by which an orbit is held"
        )
    flow = Flow(setting, COARSE)
    try:
        cell = CellState(Curve(theta, length).closed(), n, sigma)
        shape = flow.from_cell(cell)
        if flow.norm(flow.pace(shape)) < _RESTS:
            raise InputError(
                "this run is steady at its end: cellcrawl.branches.from_run finds its state"
            )
        shape = _telling(flow, shape)
        period, reflected = _return_of(flow, shape)
        found = close(setting, reflected, shape, period, nodes=nodes)
    except NotFound as error:
        raise InputError(
            f"no orbit was found at the end of this run ({error}): run longer, so that it is nearer"
        ) from None
    made = Orbit.of(setting, reflected, found)
    ended = found.shape
    if found.nodes != COARSE:
        ended = Flow(setting, found.nodes).resampled(ended, COARSE)
    if flow.norm(ended - shape) > _FAR:
        raise InputError(
            f"this run is not near an orbit at its end: the nearest found has period "
            f"{found.period:.6g}; run longer"
        )
    return made


def _telling(flow: Flow, shape: np.ndarray) -> np.ndarray:
    """Return the least symmetric shape ahead: there left and right are told apart most surely.

    Between the turns of a slow zigzag both differ by a millionth only.
    """
    fastest = flow.stiffness(shape)
    best, chosen = -1.0, shape
    for _ in range(round(_AHEAD / _LOOK)):
        shape = flow.after_stabilised(shape, _LOOK, _QUICK, fastest).shape
        lopsided = flow.norm(shape - flow.mirrored(shape))
        if lopsided > best:
            best, chosen = lopsided, shape
    return chosen


def _return_of(flow: Flow, shape: np.ndarray) -> tuple[float, bool]:
    """Return after what time a shape is back, and whether as its mirror image."""
    fastest = flow.stiffness(shape)
    mirrored = flow.mirrored(shape)
    apart: list[tuple[float, float]] = []
    here, farthest = shape, 0.0
    best: tuple[float, float, bool] | None = None
    for k in range(round(_PATIENCE / _LOOK)):
        here = flow.after_stabilised(here, _LOOK, _QUICK, fastest).shape
        apart.append((flow.norm(here - shape), flow.norm(here - mirrored)))
        farthest = max(farthest, apart[-1][0])
        if k < 2 or (k - 1) * _LOOK < _SHORTEST:
            continue
        for side in (1, 0):
            a, b, c = (apart[k - j][side] for j in (2, 1, 0))
            if not (b <= a and b < c):
                continue
            bend = a * a - 2.0 * b * b + c * c
            shift = 0.5 * (a * a - c * c) / bend if bend > 0.0 else 0.0
            time = (k + shift) * _LOOK
            if best is None or b < best[0]:
                best = (b, time, side == 1)
            if b < _NEAR * farthest:
                return time, side == 1
    if best is not None and best[0] < _NEAREST * farthest:
        return best[1], best[2]
    raise NotFound(f"its shape does not come back within {_PATIENCE:g} time units")
