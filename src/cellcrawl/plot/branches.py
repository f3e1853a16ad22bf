"""Branches of steady cells and orbits in one parameter, and the boundaries they draw over two."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cellcrawl.arguments import checked
from cellcrawl.branches import Branch, OrbitBranch, PointCurve
from cellcrawl.branches.state import TURNING
from cellcrawl.errors import InputError
from cellcrawl.laws.law import PAPER
from cellcrawl.linear import marginal_curves
from cellcrawl.parameters import DESCRIPTIONS
from cellcrawl.plot.mode_symbols import MODE_SYMBOLS
from cellcrawl.plot.style import COLUMN, INK, axes_or_new, paper_figure
from cellcrawl.plot.symbols import PARAMETER_NAMES, parameter_label
from cellcrawl.validation import one_of

_QUANTITIES: Final = {
    "speed": "speed",
    "turning_rate": "turning rate",
    "tension": "tension",
    "circularity": "circularity",
    "length": "length",
    "area": "area",
    "largest_curvature": "sharpest bend",
}
_POINTS: Final = {
    "fold": ("s", "fold"),
    "Hopf": ("o", "Hopf point"),
    "pitchfork": ("^", "pitchfork"),
    "circle": ("D", "meets the circle"),
    "branch point": ("v", "branch point"),
    "period doubling": ("P", "period doubling"),
    "torus": ("*", "torus point"),
}
_OF_ORBITS: Final = ("speed", "turning_rate", "tension", "circularity")
_GLIDING = MODE_SYMBOLS["gliding"].colour
_TURNING = MODE_SYMBOLS["rotational"].colour
ORBIT = "#8c510a"  # orbits that come back without a mirror
_CURVES: Final = {
    ("Hopf", "antisymmetric"): (MODE_SYMBOLS["zigzag"].colour, "-", "gliding begins to wobble"),
    ("Hopf", "symmetric"): ("#7a7a7a", "--", "gliding begins to breathe"),
    ("Hopf", ""): (_TURNING, ":", "steady turning begins to wobble"),
    ("pitchfork", "antisymmetric"): (_TURNING, "-", "gliding begins to turn"),
    ("fold", "symmetric"): (_GLIDING, "--", "gliding ends (fold)"),
    ("fold", ""): (_TURNING, "--", "turning ends (fold)"),
}


@checked
def branch(
    branches: Branch | OrbitBranch | Sequence[Branch | OrbitBranch],
    quantity: str = "speed",
    *,
    legend: bool = True,
    ax: Axes | None = None,
) -> Axes:
    """Draw a measure of steady cells and orbits along branches: solid where stable, else dotted.

    Of orbits the least and the largest over a period are drawn.

    Parameters
    ----------
    branches : Branch, OrbitBranch or sequence of them
        Followed in the same parameter.
    quantity : str
        "speed", "turning_rate", "tension", "circularity", "length", "area" or "largest_curvature";
        one of the first four where there are orbits.
    legend : bool
        Say what the markers of special points are.
    ax : Axes, optional
        Where to draw; the only axes of a new figure unless given.

    Returns
    -------
    Axes

    Raises
    ------
    InputError
        For branches in different parameters, or another quantity.
    """
    many = _alike(branches)
    orbits = any(isinstance(one, OrbitBranch) for one in many)
    quantity = one_of("quantity", quantity, _OF_ORBITS if orbits else _QUANTITIES)
    seen: dict[str, Any] = {}
    with axes_or_new(ax, COLUMN, 0.75 * COLUMN) as axes:
        _draw(axes, many, quantity, seen)
        if legend and seen:
            axes.legend(list(seen.values()), list(seen), fontsize="small")
    return axes


@checked
def branch_panels(
    branches: Branch | OrbitBranch | Sequence[Branch | OrbitBranch],
    *,
    title: str = "",
) -> Figure:
    """Draw speed, turning rate and tension along branches, one above the other.

    Parameters
    ----------
    branches : Branch, OrbitBranch or sequence of them
        Followed in the same parameter; drawn as in `branch`.
    title : str
        Above the panels.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        For branches in different parameters.
    """
    many = _alike(branches)
    keys: dict[str, Any] = {}
    with paper_figure(COLUMN, 2.0 * COLUMN, shown=True) as figure:
        panels = figure.subplots(3, 1, sharex=True)
        for panel, quantity in zip(panels, ("speed", "turning_rate", "tension"), strict=True):
            _draw(panel, many, quantity, keys)
            panel.label_outer()
        if title:
            panels[0].set_title(title, loc="left")
        if keys:
            figure.legend(
                list(keys.values()), list(keys), loc="outside lower center", ncols=3, frameon=False
            )
    return figure


def _alike(
    branches: Branch | OrbitBranch | Sequence[Branch | OrbitBranch],
) -> list[Branch | OrbitBranch]:
    """Return branches as a list, or raise `InputError` for none and for different parameters."""
    many = [branches] if isinstance(branches, Branch | OrbitBranch) else list(branches)
    if not many or len({one.name for one in many}) > 1:
        raise InputError("give one branch or more, all followed in the same parameter")
    return many


def _draw(
    axes: Axes, many: list[Branch | OrbitBranch], quantity: str, seen: dict[str, Any]
) -> None:
    """Draw branches with labelled axes; markers of special points are gathered by name."""
    for one in many:
        if isinstance(one, OrbitBranch):
            _draw_orbits(axes, one, quantity, seen)
        else:
            _draw_states(axes, one, quantity, seen)
    axes.set_xlabel(_label(many[0].name))
    axes.set_ylabel(_QUANTITIES[quantity])


def _draw_states(axes: Axes, one: Branch, quantity: str, seen: dict[str, Any]) -> None:
    values = np.array([abs(getattr(state, quantity)) for state in one])
    colour = _TURNING if one[0].kind == TURNING else _GLIDING
    stable = np.array([one.spectra and state.stable for state in one])
    points = one.special_points
    heights = np.array([abs(getattr(point.state, quantity)) for point in points])
    _draw_line(axes, one, values, points, heights, stable, colour)
    for point, height in zip(points, heights, strict=True):
        _mark(axes, point.kind, point.value, height, seen)


def _draw_orbits(axes: Axes, one: OrbitBranch, quantity: str, seen: dict[str, Any]) -> None:
    colour = MODE_SYMBOLS["zigzag"].colour if one[0].reflected else ORBIT
    stable = np.array([one.spectra and orbit.stable for orbit in one])
    points = one.special_points
    both = np.array([_of_orbit(orbit, quantity) for orbit in one]).reshape(-1, 2)
    at_points = np.array([_of_orbit(point.orbit, quantity) for point in points]).reshape(-1, 2)
    for values, heights in zip(both.T, at_points.T, strict=True):
        _draw_line(axes, one, values, points, heights, stable, colour)
        for point, height in zip(points, heights, strict=True):
            _mark(axes, point.kind, point.value, height, seen)


def _of_orbit(orbit: Any, quantity: str) -> tuple[float, float]:
    """Return the least and the largest; of the two mirror images that which turns to the left."""
    low, high = getattr(orbit, f"{quantity}_range")
    mirrored = quantity == "turning_rate" and orbit.turning_rate < 0.0
    return (-high, -low) if mirrored else (low, high)


def _draw_line(
    axes: Axes,
    one: Branch | OrbitBranch,
    values: np.ndarray,
    points: Sequence[Any],
    heights: np.ndarray,
    stable: np.ndarray,
    colour: Any,
) -> None:
    """Draw a measure along a branch, through its special points, where stability changes."""
    places = np.append(np.arange(stable.size), [point.position for point in points])
    order = np.argsort(places, kind="stable")
    across = np.append(one.values, [point.value for point in points])[order]
    along = np.append(values, heights)[order]
    state = (np.arange(places.size) < stable.size)[order]
    holds = np.append(stable, np.full(len(points), True))[order]
    solid = holds[:-1] & holds[1:] & (state[:-1] | state[1:])  # unknown between two points: dotted
    for first, last, whole in _pieces(solid):
        axes.plot(
            across[first : last + 1], along[first : last + 1],
            color=colour, linestyle="-" if whole else ":", linewidth=1.4 if whole else 1.0,
        )  # fmt: skip


def _mark(axes: Axes, kind: str, value: float, height: float, seen: dict[str, Any]) -> None:
    marker, label = _POINTS[kind]
    seen[label] = axes.plot(
        value, height, marker=marker, color=INK, markersize=4.0, markerfacecolor="white",
        linestyle="none", zorder=3,
    )[0]  # fmt: skip


@checked
def boundaries(
    curves: Sequence[PointCurve],
    *,
    onset: bool = True,
    legend: bool = True,
    ax: Axes | None = None,
) -> Axes:
    """Draw curves of special points over two parameters, in words of what happens there.

    Parameters
    ----------
    curves : sequence of PointCurve
        Over the same two parameters; the first is drawn to the right.
    onset : bool
        Draw too where the resting circle begins to glide, under the paper's laws.
    legend : bool
        Say what each is.
    ax : Axes, optional
        Such as that of `cellcrawl.plot.diagram`, whose symbols lie under the curves then.

    Returns
    -------
    Axes

    Raises
    ------
    InputError
        For curves over different parameters.
    """
    if not curves or len({curve.names for curve in curves}) > 1:
        raise InputError("give one curve or more, all over the same two parameters")
    seen: dict[str, Any] = {}
    with axes_or_new(ax, COLUMN, COLUMN) as axes:
        left, right = (axes.get_xlim(), axes.get_ylim()) if ax is not None else (None, None)
        for curve in curves:
            colour, style, label = _CURVES.get(
                (curve.kind, curve.symmetry), (INK, "-", f"{curve.kind}")
            )
            values = curve.values
            seen[label] = axes.plot(
                values[:, 0], values[:, 1], color=colour, linestyle=style, linewidth=1.4, zorder=4
            )[0]
        box = axes.get_xlim(), axes.get_ylim()
        setting = curves[0].points[0].state.setting
        if onset and setting.laws == PAPER and set(curves[0].names) <= set(DESCRIPTIONS):
            ranges = dict(zip(curves[0].names, box, strict=True))
            for line in marginal_curves(setting.parameters, 1, **_within(ranges)):
                label = "the round cell begins to glide"
                seen[label] = axes.plot(*line.T, color=INK, linewidth=1.0, zorder=3)[0]
            axes.set_xlim(box[0])
            axes.set_ylim(box[1])
        if left is not None and right is not None:
            axes.set_xlim(left)
            axes.set_ylim(right)
        else:
            axes.set_xlabel(_label(curves[0].names[0]))
            axes.set_ylabel(_label(curves[0].names[1]))
        if legend:
            keys, labels = list(seen.values()), list(seen)
            if ax is None:
                axes.figure.legend(
                    keys, labels, loc="outside upper center", fontsize="small", frameon=False
                )
            else:
                axes.legend(keys, labels, fontsize="small")
    return axes


def _within(ranges: dict[str, tuple[float, float]]) -> dict[str, tuple[float, float]]:
    """Return ranges of parameters cut to what they may be."""
    return {
        name: (max(low, DESCRIPTIONS[name].low), min(high, DESCRIPTIONS[name].high))
        for name, (low, high) in ranges.items()
    }


def _label(name: str) -> str:
    """Return the label of a parameter; a law's own has its name."""
    return parameter_label(name) if name in PARAMETER_NAMES else name


def _pieces(solid: np.ndarray) -> list[tuple[int, int, bool]]:
    """Return first and last place of each piece whose stretches are alike."""
    made: list[tuple[int, int, bool]] = []
    for k, one in enumerate(solid.tolist()):
        if made and made[-1][2] == one:
            made[-1] = (made[-1][0], k + 1, one)
        else:
            made.append((k, k + 1, one))
    return made
