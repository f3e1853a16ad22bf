"""The area of an outline from its points alone."""

from __future__ import annotations

import numpy as np
import pytest

from cellcrawl.numerics import fourier


@pytest.mark.parametrize("points", [24, 25])
def test_an_ellipse_has_its_area_whatever_its_place_and_sense(points):
    angle = 2.0 * np.pi * np.arange(points) / points
    x, y = 5.0 + 2.0 * np.cos(angle), -3.0 + 0.5 * np.sin(angle)
    assert fourier.area(x, y) == pytest.approx(np.pi, rel=1e-13)
    assert fourier.area(x, -y) == pytest.approx(-np.pi, rel=1e-13)


def test_many_outlines_at_once():
    angle = 2.0 * np.pi * np.arange(32) / 32
    sizes = np.array([1.0, 2.0])[:, None]
    assert np.allclose(
        fourier.area(sizes * np.cos(angle), sizes * np.sin(angle)), [np.pi, 4.0 * np.pi]
    )
