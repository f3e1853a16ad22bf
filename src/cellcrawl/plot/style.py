"""The look of the pictures: sizes for a page of a paper, never the user's global settings."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Final, Literal

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

COLUMN: Final = 3.4
"""Width of one column, in inches."""
PAGE: Final = 7.0
"""Width of a page, in inches."""

INK: Final = "#222222"
TRACK: Final = "#b5338a"
BODY: Final = "#f1f1f1"
RIM: Final = "#8c8c8c"

STYLE: Final[Any] = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],  # comes with matplotlib: the same picture everywhere
    "font.size": 7.5,
    "axes.labelsize": 7.5,
    "axes.titlesize": 7.5,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "legend.fontsize": 7.0,
    "figure.titlesize": 8.0,
    "mathtext.fontset": "dejavusans",
    "axes.linewidth": 0.6,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "axes.labelpad": 2.5,
    "axes.titlepad": 4.0,
    "axes.formatter.useoffset": False,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "xtick.minor.size": 1.5,
    "ytick.minor.size": 1.5,
    "xtick.minor.width": 0.4,
    "ytick.minor.width": 0.4,
    "lines.linewidth": 1.0,
    "figure.dpi": 150.0,
    "figure.constrained_layout.h_pad": 0.03,
    "figure.constrained_layout.w_pad": 0.03,
}


class PaperFigure(Figure):
    """A figure that is drawn in the house style, whatever the user's settings, without pyplot."""

    def __init__(
        self, width: float, height: float, layout: Literal["constrained", "compressed"] | None
    ) -> None:
        with mpl.rc_context(STYLE):
            super().__init__(figsize=(width, height), layout=layout)
        FigureCanvasAgg(self)

    def draw(self, renderer: RendererBase) -> None:
        """Draw; ticks made only now get the house style too."""
        with mpl.rc_context(STYLE):
            super().draw(renderer)

    def _repr_png_(self) -> bytes:
        """Show the figure in a notebook, which knows only the figures of pyplot."""
        import io

        image = io.BytesIO()
        self.savefig(image, format="png")
        return image.getvalue()


@contextmanager
def paper_figure(width: float, height: float, *, equal: bool = False) -> Iterator[PaperFigure]:
    """Give a new figure, in inches; what is drawn on it meanwhile is in the house style.

    ``equal`` packs axes of equal aspect closely.
    """
    with mpl.rc_context(STYLE):
        yield PaperFigure(width, height, "compressed" if equal else "constrained")


@contextmanager
def fixed_figure(width: float, height: float) -> Iterator[PaperFigure]:
    """Like `paper_figure`, but axes stay where they are put: nothing is measured to place them."""
    with mpl.rc_context(STYLE):
        yield PaperFigure(width, height, None)


@contextmanager
def axes_or_new(
    ax: Axes | None, width: float, height: float, *, equal: bool = False
) -> Iterator[Axes]:
    """Give ``ax`` with the user's settings, or the axes of a new figure in the house style."""
    if ax is not None:
        yield ax
        return
    with paper_figure(width, height, equal=equal) as figure:
        yield figure.add_subplot()


def figure_of(ax: Axes) -> Figure:
    """Return the figure an axes is on, also from within subfigures."""
    figure = ax.get_figure(root=True)
    assert figure is not None
    return figure
