"""How pictures and movies appear in a notebook."""

from __future__ import annotations

import io
import sys
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure


def shown_by_pyplot(figure: Figure) -> bool:
    """Whether pyplot itself shows the figure: at the end of a notebook's cell, or in a window."""
    pyplot: Any = sys.modules.get("matplotlib.pyplot")
    if pyplot is None or not _is_managed(figure):
        return False
    backend = str(mpl.get_backend(auto_select=False) or "").casefold()
    return "inline" in backend or pyplot.isinteractive()


def _is_managed(figure: Figure) -> bool:
    from matplotlib import _pylab_helpers

    return any(
        manager.canvas.figure is figure for manager in _pylab_helpers.Gcf.get_all_fig_managers()
    )


def png_of(figure: Figure) -> bytes:
    """Return the figure as a PNG."""
    image = io.BytesIO()
    figure.savefig(image, format="png")
    return image.getvalue()
