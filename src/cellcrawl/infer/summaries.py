"""A film in a few hundred numbers: what does not depend on place, direction or handedness.

The vector is the same function of a film whether the film is a run's or a cell's. Lengths are in
the unit of the film: its own radius (median of the square root of area over pi) where there are
outlines, else the usual R_0. Times are in the usual 1/k_off0. ``VERSION`` changes with any of it.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from cellcrawl.infer import films
from cellcrawl.infer.correlations import TINY, correlation, lags, ratio, together

VERSION: Final = 3
FEWEST_FRAMES: Final = 16
"""Fewer frames than this show no turn and no beat."""
_NODES: Final = 32
_SMALL: Final = 1e-3  # of a mean: a spread below is as good as none
_SLOW: Final = 0.05  # of a spread, in a unit of time: a pace below is as good as none
_BANDS: Final = 6
_SHAPES: Final = (-1, 2, -2, 3, -3, 4, -4, 5, -5)
_QUANTILES: Final = (0.02, 0.1, 0.25, 0.5, 0.75, 0.9, 0.98)


class Summary(NamedTuple):
    """One number of the vector."""

    name: str
    unit: str
    outlines: bool
    """Whether it takes outlines; the others come from the track alone."""


class Films(NamedTuple):
    """Films of one camera: the same number of frames, the same time between them.

    Attributes
    ----------
    step : float
        Time between frames.
    path : ndarray of complex, shape (film, frame)
        Centroid.
    modes : ndarray of complex, shape (film, frame, wave), or None
        Outline about the centroid; see `films.modes_of_edge`.
    """

    step: float
    path: np.ndarray
    modes: np.ndarray | None


def summaries(seen: Films) -> tuple[list[Summary], np.ndarray]:
    """Return what the numbers are, and the numbers, shape (film, number); all finite."""
    gathered = _Gathered()
    path, modes = seen.path, seen.modes
    if modes is not None:
        area = math.pi * np.sum(films.WAVES * np.abs(modes) ** 2, axis=-1)
        radius = np.sqrt(np.maximum(np.median(area, axis=1), TINY) / math.pi)
        path, modes = path / radius[:, None], modes / radius[:, None, None]
    lag = max(1, min(round(1.0 / seen.step), path.shape[1] // 6))
    # Along x on the whole, so that points along an outline lie on the cell, not on the picture.
    back = np.exp(-1j * np.angle(path[:, -1] - path[:, 0]))
    path = path * back[:, None]
    modes = None if modes is None else modes * back[:, None, None]
    _of_track(gathered, path, seen.step, lag)
    if modes is not None:
        _of_outlines(gathered, path, modes, seen.step, lag)
    values = np.column_stack(gathered.columns)
    return gathered.told, np.nan_to_num(values, nan=0.0, posinf=1e6, neginf=-1e6)


class _Gathered:
    """Numbers as they come, with what they are."""

    def __init__(self) -> None:
        self.told: list[Summary] = []
        self.columns: list[np.ndarray] = []

    def add(self, name: str, unit: str, values: np.ndarray, outlines: bool) -> None:
        self.told.append(Summary(name, unit, outlines))
        self.columns.append(np.asarray(values, float))

    def add_log(self, name: str, unit: str, values: np.ndarray, outlines: bool) -> None:
        self.add(f"log {name}", unit, np.log(np.maximum(values, TINY)), outlines)


def _of_track(to: _Gathered, path: np.ndarray, step: float, lag: int) -> None:
    for number in lags(path.shape[1]):
        moved = np.abs(path[:, number:] - path[:, :-number])
        rms = np.sqrt((moved**2).mean(axis=1))
        to.add_log(f"rms displacement in {number} frames", "length", rms, False)
        to.add(
            f"spread of displacement in {number} frames", "", ratio(moved.std(axis=1), rms), False
        )
    velocity = (path[:, lag:] - path[:, :-lag]) / (lag * step)
    speed = np.abs(velocity)
    for quantile in (0.1, 0.5, 0.9):
        to.add_log(
            f"speed, quantile {quantile:g}",
            "length/time",
            np.quantile(speed, quantile, axis=1),
            False,
        )
    _series(to, "speed", "length/time", speed, step, lag, False)
    steps = np.diff(path, axis=1)
    for number in lags(steps.shape[1]):
        to.add(f"velocity correlation at {number} frames", "", correlation(steps, number), False)
    turn = np.angle(velocity[:, lag:] * np.conj(velocity[:, :-lag])) / (lag * step)
    rms = np.sqrt((turn**2).mean(axis=1))
    to.add_log("rms turning rate", "rad/time", rms, False)
    to.add("net turn over rms", "", ratio(np.abs(turn.mean(axis=1)), rms), False)
    to.add("kurtosis of turns", "", np.log(ratio((turn**4).mean(axis=1), rms**4) + 1.0), False)
    for quantile in (0.5, 0.9):
        to.add_log(
            f"turning rate, quantile {quantile:g}",
            "rad/time",
            np.quantile(np.abs(turn), quantile, axis=1),
            False,
        )
    for number in lags(turn.shape[1]):
        to.add(f"turn correlation at {number} frames", "", correlation(turn, number), False)
    length = np.abs(steps).sum(axis=1)
    net = np.abs(path[:, -1] - path[:, 0])
    to.add("net over path", "", ratio(net, length), False)
    _spectrum(to, "velocity", steps - steps.mean(axis=1, keepdims=True), step, False)
    _spectrum(to, "turns", turn - turn.mean(axis=1, keepdims=True), step, False)


def _of_outlines(to: _Gathered, path: np.ndarray, modes: np.ndarray, step: float, lag: int) -> None:
    # What is below the steps of a bank is rounding, and its logarithm no shape.
    size = {k: np.hypot(np.abs(modes[..., films.MODES + k]), films.QUANTUM) for k in _SHAPES}
    waves = np.abs(modes[..., np.abs(films.WAVES) > 5]) ** 2
    fine = np.sqrt(waves.sum(axis=-1) + films.QUANTUM**2)
    area = math.pi * np.sum(films.WAVES * np.abs(modes) ** 2, axis=-1)
    # A start point that turns with the shape, and not with where a tracing began.
    first = np.angle(modes[..., films.MODES + 1])
    placed = modes * np.exp(-1j * first[..., None] * films.WAVES)
    edge = films.edge_of_modes(placed, _NODES)
    slope = films.edge_of_modes(1j * films.WAVES * placed, _NODES)
    bend = films.edge_of_modes(-(films.WAVES**2) * placed, _NODES)
    along = np.maximum(np.abs(slope), TINY)
    length = 2.0 * math.pi * along.mean(axis=-1)
    curvature = (np.conj(slope) * bend).imag / along**3
    series = {
        "area": area,
        "length of the edge": length,
        "circularity": 4.0 * math.pi * area / np.maximum(length, TINY) ** 2,
        **{f"wave {k:+d}": size[k] for k in _SHAPES},
        "waves beyond 5": fine,
    }
    for name, values in series.items():
        _series(to, name, "length" if "wave" in name else "", values, step, lag, True)
    for quantile in (0.05, 0.25, 0.5, 0.75, 0.95):
        value = np.quantile(curvature, quantile, axis=(1, 2))
        to.add(f"curvature, quantile {quantile:g}", "1/length", np.clip(value, -50, 50), True)
    heading = np.angle(path[:, lag:] - path[:, :-lag])
    half = lag // 2
    middle = slice(half, half + heading.shape[1])
    _in_direction(to, modes[:, middle], heading)
    for number in dict.fromkeys((1, lag)):
        velocity = (edge[:, number:] - edge[:, :-number]) + (path[:, number:] - path[:, :-number])[
            ..., None
        ]
        normal = -1j * (slope[:, number:] + slope[:, :-number])
        normal /= np.maximum(np.abs(normal), TINY)
        outward = (np.conj(normal) * velocity).real / (number * step)
        _edge_motion(to, outward, f"over {number} frames")
        if number == lag:
            where = np.angle(normal) - heading[..., None]
            for m in range(5):
                mean = (outward * np.cos(m * where)).mean(axis=(1, 2))
                name = f"edge velocity, cos {m} of the angle to the front"
                to.add(name, "length/time", mean, True)
            bent = 0.5 * (curvature[:, number:] + curvature[:, :-number])
            with_curvature = together(outward, np.clip(bent, -20, 20))
            to.add("edge velocity with curvature", "", with_curvature, True)
    speed = np.abs(path[:, lag:] - path[:, :-lag])
    for name in ("area", "circularity", "wave -1", "wave -2"):
        seen = series[name][:, middle]
        to.add(f"{name} with speed", "", together(speed, seen), True)
    usual = area.mean(axis=1, keepdims=True)
    _spectrum(to, "area", area - usual, step, True, _SMALL * usual)
    stretch = size[-1] - size[-1].mean(axis=1, keepdims=True)
    _spectrum(to, "wave -1", stretch, step, True, _SMALL)


def _in_direction(to: _Gathered, modes: np.ndarray, heading: np.ndarray) -> None:
    """The mean shape as the cell's own front sees it, and how much single frames differ."""
    turned = modes * np.exp(-1j * heading)[..., None]
    first = np.angle(turned[..., films.MODES + 1])
    turned = turned * np.exp(-1j * first[..., None] * films.WAVES)
    mean = turned.mean(axis=1)
    spread = np.sqrt((np.abs(turned - mean[:, None]) ** 2).mean(axis=1) + films.QUANTUM**2)
    for k in _SHAPES:
        to.add(f"mean wave {k:+d} along the front", "length", mean[:, films.MODES + k].real, True)
        across = np.abs(mean[:, films.MODES + k].imag)
        to.add(f"mean wave {k:+d} across the front", "length", across, True)
        to.add_log(
            f"spread of wave {k:+d} about its mean along the front",
            "length",
            spread[:, films.MODES + k],
            True,
        )


def _edge_motion(to: _Gathered, outward: np.ndarray, when: str) -> None:
    unit = "length/time"
    rms = np.sqrt((outward**2).mean(axis=(1, 2)))
    to.add_log(f"rms edge velocity {when}", unit, rms, True)
    for quantile in _QUANTILES:
        value = np.quantile(outward, quantile, axis=(1, 2))
        to.add(f"edge velocity {when}, quantile {quantile:g}", "", ratio(value, rms), True)
    fastest, slowest = outward.max(axis=2), outward.min(axis=2)
    for name, values in (("fastest", fastest), ("slowest", slowest)):
        to.add(f"mean of the {name} edge {when}", "", ratio(values.mean(axis=1), rms), True)
        to.add(f"spread of the {name} edge {when}", "", ratio(values.std(axis=1), rms), True)
    waves = np.abs(np.fft.rfft(outward, axis=2)) ** 2
    for low, high in ((1, 2), (2, 3), (3, 4), (4, 6), (6, 11)):
        power = waves[:, :, low:high].sum(axis=2).mean(axis=1)
        part = ratio(power, waves[:, :, 1:].sum(axis=2).mean(axis=1))
        to.add_log(f"edge velocity {when} in waves {low} to {high - 1}", "", part, True)
    for number in lags(outward.shape[1])[:5]:
        product = (outward[:, number:] * outward[:, :-number]).mean(axis=(1, 2))
        name = f"edge velocity {when}, correlation at {number} frames"
        to.add(name, "", ratio(product, rms**2), True)


def _series(
    to: _Gathered,
    name: str,
    unit: str,
    values: np.ndarray,
    step: float,
    lag: int,
    outlines: bool,
) -> None:
    """Mean, spread, pace and memory of a number over time."""
    mean, spread = values.mean(axis=1), values.std(axis=1)
    to.add_log(f"mean of {name}", unit, np.abs(mean), outlines)
    part = np.hypot(ratio(spread, np.abs(mean)), _SMALL)
    to.add_log(f"spread of {name}", "", part, outlines)
    pace = (values[:, lag:] - values[:, :-lag]) / (lag * step)
    rms = np.sqrt((pace**2).mean(axis=1))
    still = np.hypot(spread, _SMALL * np.abs(mean))
    to.add_log(f"pace of {name}", "1/time", np.hypot(ratio(rms, still), _SLOW), outlines)
    centred = values - mean[:, None]
    to.add(
        f"skewness of {name}", "", np.cbrt(ratio((centred**3).mean(axis=1), spread**3)), outlines
    )
    for number in lags(values.shape[1])[1:]:
        seen = correlation(centred, number, _SMALL * mean)
        to.add(f"{name}, correlation at {number} frames", "", seen, outlines)


def _spectrum(
    to: _Gathered,
    name: str,
    values: np.ndarray,
    step: float,
    outlines: bool,
    least: np.ndarray | float = 0.0,
) -> None:
    """Where in frequency a number changes: parts of the power in bands, and its middle.

    A change below ``least`` is taken for noise, evenly spread: that of a bank's steps is there.
    """
    count = values.shape[1]
    window = np.hanning(count + 2)[1:-1]
    power = np.abs(np.fft.fft(values * window, axis=1)) ** 2 + least**2 * (window**2).sum()
    half = (count - 1) // 2
    folded = power[:, 1 : half + 1] + power[:, ::-1][:, :half]  # either sense of turning
    total = np.maximum(folded.sum(axis=1), TINY)
    frequency = np.arange(1, half + 1) / (count * step)
    edges = np.geomspace(0.999 * frequency[0], 1.001 * frequency[-1], _BANDS + 1)
    for band in range(_BANDS):
        inside = (frequency >= edges[band]) & (frequency < edges[band + 1])
        if inside.any():
            part = folded[:, inside].sum(axis=1) / total
            to.add(
                f"{name}, power in band {band + 1} of {_BANDS}", "", np.log(part + 1e-4), outlines
            )
    middle = np.exp((folded * np.log(frequency)).sum(axis=1) / total)
    to.add_log(f"middle frequency of {name}", "1/time", middle, outlines)
    to.add_log(f"peak frequency of {name}", "1/time", frequency[folded.argmax(axis=1)], outlines)
