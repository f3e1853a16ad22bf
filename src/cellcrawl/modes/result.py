"""What the classifier returns."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

from cellcrawl.records import EqualWithNaN

MODES: Final = ("gliding", "rotational", "zigzag", "other", "stationary", "fragmented")
"""Modes of a single run; a set of runs can also be "mixed"."""

STEADY_SPIN: Final = "steady spin"
DETAILS: Final = ("", STEADY_SPIN)
"""Finer words beside a mode. A cell in a steady spin turns to one side all the time, as a rotating
one does, but within its own outline: the paper calls it "other"."""


@dataclass(frozen=True, eq=False)
class Measures(EqualWithNaN):
    """What the rule looks at; angles in rad, times and lengths in the units of the track.

    Attributes
    ----------
    start : float
        Time at which the transient ends; all that follows is measured from there on.
    turned : float
        Net change of heading, positive to the left.
    swings : int
        How often the heading swings to one side or the other.
    swing : float
        Mean size of a swing, without the two cut off at the ends when there are others.
    widest_swing : float
        The larger of the mean swings to the left and to the right.
    one_sidedness : float
        From 0, as much to the left as to the right, to 1, all to one side: of complete swings.
    counter_turn : float
        Largest swing against the net change of heading.
    angle_spread, interval_spread : float
        Standard deviation over mean of the sizes of swings and of the times between them.
    wander : float
        Range of the heading around its straight line in time.
    unevenness : float
        That range over the net change of heading: 0 for a circle, 1/n for n equal turns at equal
        times, 1 for a single turn.
    turning_rate : float
        Net change of heading over time, positive to the left.
    circling_radius : float
        Path length over the net change of heading: the radius of the circle that turns as much.
        Infinite without turning.
    period : float
        Time of a full left-right cycle, or of a turn of 2 pi for a rotating cell; NaN else.
    speed : float
        Median speed.
    straightness : float
        Net distance over path length.
    extent : float
        Twice the largest distance from the mean position, after the first quarter of the time.
    late_extent : float
        The same over the extent of the whole track.
    disorder : float
        Mean square distance of successive positions over their variance, after the first quarter:
        2 for positions without order, near 0 for a path.
    noise : float
        Estimated error of a recorded position.
    heading_error : float
        Expected error of the heading after smoothing.
    """

    start: float = math.nan
    turned: float = math.nan
    swings: int = 0
    swing: float = math.nan
    widest_swing: float = math.nan
    one_sidedness: float = math.nan
    counter_turn: float = math.nan
    angle_spread: float = math.nan
    interval_spread: float = math.nan
    wander: float = math.nan
    unevenness: float = math.nan
    turning_rate: float = math.nan
    circling_radius: float = math.nan
    period: float = math.nan
    speed: float = math.nan
    straightness: float = math.nan
    extent: float = math.nan
    late_extent: float = math.nan
    disorder: float = math.nan
    noise: float = math.nan
    heading_error: float = math.nan


@dataclass(frozen=True, eq=False)
class Classification(EqualWithNaN):
    """The mode of one run, and how sure.

    Attributes
    ----------
    mode : str
        One of `MODES`.
    confidence : float
        From 0 to 1: of answers with confidence p to tracks of known mode, p are right. What the
        size of the cell or a tear says is not a matter of chance and enters as it fits the rule.
    memberships : dict
        How well gliding, rotational and zigzag each fit, from 0 to 1.
    measures : Measures
        What the rule looked at.
    doubt : str
        The condition that holds least and, of an answer that is not sure, what speaks against it,
        in words; "" if all hold fully.
    detail : str
        A finer word beside the mode, one of `DETAILS`; "" if there is none.
    """

    mode: str
    confidence: float
    memberships: dict[str, float]
    measures: Measures
    doubt: str
    detail: str = ""

    def as_row(self) -> dict[str, Any]:
        """Return mode, confidence and measures as one flat row of a table."""
        row = {"mode": self.mode, "confidence": self.confidence, **vars(self.measures)}
        return {**row, "doubt": self.doubt, "detail": self.detail}

    def summary(self, *, y_down: bool = False) -> str:
        """Return what the mode was seen by, in a few words.

        Left and right are those of the screen: with ``y_down``, as in an image, a positive net
        change of heading is a turn to the right.
        """
        told = self._told(y_down)
        return "; but ".join(part for part in (told, self.doubt) if part)

    def _told(self, y_down: bool) -> str:
        seen = self.measures
        side = "left" if (seen.turned > 0.0) != y_down else "right"
        match self.mode:
            case "gliding":
                return f"turned {abs(math.degrees(seen.turned)):.0f} degrees in all"
            case "rotational":
                return f"turns {side} only, once round in {seen.period:.3g}"
            case "zigzag":
                swing = f"{seen.swings} swings of {math.degrees(seen.swing):.0f} degrees"
                return f"{swing}, left and right in {seen.period:.3g}"
            case "other" if self.detail == STEADY_SPIN:
                period = 2.0 * math.pi / abs(seen.turning_rate)
                return f"spins to the {side} on the spot, once round in {period:.3g}"
            case _:
                return ""
