"""Patterned grounds: places to bind, and others where the linkers find nothing."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.laws.expressions import cos, sin, sqrt, tanh
from cellcrawl.laws.law import Parameter
from cellcrawl.surroundings.base import Place, Surrounding
from cellcrawl.validation import real_array, real_number

_TWO_PI = 2.0 * np.pi


class Stripes(Surrounding):
    """Parallel stripes of adhesive ground: the on-rate is ``between`` times as large elsewhere."""

    period = Parameter(2.0, 0.05, 1e3, "distance from stripe to stripe, in cell radii")
    width = Parameter(0.5, 0.0, 1.0, "part of the period that is adhesive")
    between = Parameter(0.0, 0.0, 10.0, "on-rate between the stripes over that on them")
    angle = Parameter(0.0, -10.0, 10.0, "angle of the stripes from the x axis, in radians")
    shift = Parameter(0.0, -1e3, 1e3, "where the middle of a stripe is, across them")
    edge = Parameter(0.05, 1e-3, 10.0, "distance over which the ground changes, in cell radii")

    def change(self, at: Place, p: Any) -> Mapping[str, Any]:
        across = at.y * cos(self.angle) - at.x * sin(self.angle) - self.shift
        wave = cos(_TWO_PI * across / self.period) - cos(np.pi * self.width)
        steepness = self.period / (_TWO_PI * self.edge)
        on = 0.5 * (1.0 + tanh(steepness * wave))
        return {"r_on": p.r_on * (self.between + (1.0 - self.between) * on)}


class Island(Surrounding):
    """A disc of adhesive ground: outside the on-rate is ``outside`` times as large."""

    radius = Parameter(1.5, 0.05, 1e3, "radius of the disc, in cell radii")
    x = Parameter(0.0, -1e6, 1e6, "middle of the disc")
    y = Parameter(0.0, -1e6, 1e6, "middle of the disc")
    outside = Parameter(0.0, 0.0, 10.0, "on-rate outside over that on the disc")
    edge = Parameter(0.05, 1e-3, 10.0, "distance over which the ground changes, in cell radii")

    def change(self, at: Place, p: Any) -> Mapping[str, Any]:
        x, y = at.x - self.x, at.y - self.y
        on = 0.5 * (1.0 + tanh((self.radius - sqrt(x * x + y * y + 1e-12)) / self.edge))
        return {"r_on": p.r_on * (self.outside + (1.0 - self.outside) * on)}


@checked
class Pattern(Surrounding):
    """A local parameter from an image, such as the mask of a micropattern.

    Parameters
    ----------
    image : array, shape (rows, columns)
        Factors of the parameter, from 0. The first row is at the lowest y.
    pixel : float
        Size of a pixel in cell radii.
    parameter : str
        What is multiplied, ``"r_on"`` unless given.
    x, y : float
        Middle of the image.

    Notes
    -----
    Between pixels the image is interpolated by cubic convolution; outside, its border goes on.

    Raises
    ------
    InputError
        For an image that is not two-dimensional, holds what is no number, or has no scale.
    """

    x = Parameter(0.0, -1e6, 1e6, "middle of the image")
    y = Parameter(0.0, -1e6, 1e6, "middle of the image")

    def __init__(
        self, image: Any, pixel: float | None = None, parameter: str = "r_on", **values: float
    ) -> None:
        if pixel is None:
            raise InputError("Pattern needs the size of a pixel in cell radii: give pixel=")
        made = real_array("image", image, (None, None))
        if min(made.shape) < 2:
            raise InputError(f"image has shape {made.shape}: it must have 2 by 2 pixels or more")
        if made.min() < 0.0:
            raise InputError("image holds values below 0: they are factors of a rate")
        super().__init__(**values)
        self.image = made
        self.pixel = real_number("pixel", pixel, 0.0, 1e6, open_low=True)
        self.parameter = parameter

    def table(self) -> np.ndarray:
        rows, columns = self.image.shape
        left = self.values["x"] - 0.5 * (columns - 1) * self.pixel
        low = self.values["y"] - 0.5 * (rows - 1) * self.pixel
        head = [rows, columns, left, low, self.pixel]
        return np.concatenate([head, self.image.ravel()])

    def describe(self) -> dict[str, Any]:
        found = super().describe()
        own = {"image": self.image.tolist(), "pixel": self.pixel, "parameter": self.parameter}
        return {**found, "values": {**own, **found["values"]}}

    def change(self, at: Place, p: Any) -> Mapping[str, Any]:
        return {self.parameter: getattr(p, self.parameter) * self.look_up("image_value", at)}
