"""The look of the pictures: sizes for a page of a paper, and what the user chose instead.

The house style fills in what the user has not set: a value of ``matplotlib.rcParams`` that differs
from matplotlib's own default is the user's, from a style sheet, a matplotlibrc or a notebook.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, replace
from typing import Any, Final

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.plot.notebook import png_of, shown_by_pyplot
from cellcrawl.validation import known_names, real_number, shown, table

COLUMN: Final = 3.4
"""Width of one column, in inches."""
PAGE: Final = 7.0
"""Width of a page, in inches."""

INK: Final = "#222222"
TRACK: Final = "#b5338a"
BODY: Final = "#f1f1f1"
RIM: Final = "#8c8c8c"
GUIDE: Final = "#999999"
_ON_DARK: Final = {INK: "#e8e8e8", BODY: "#2c2c2c", RIM: "#a8a8a8", GUIDE: "#8c8c8c"}

STYLE: Final[Any] = {
    "font.family": ["sans-serif"],
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
_TEXT_SIZES: Final = tuple(
    name for name in STYLE if name.endswith("size") and "major" not in name and "minor" not in name
)


@dataclass(frozen=True)
class _Chosen:
    """What `styled` asks of the pictures made within it."""

    width: float | None = None
    colormap: str | None = None


_NOTHING: Final = _Chosen()
_chosen: ContextVar[_Chosen] = ContextVar("chosen", default=_NOTHING)


@checked
@contextmanager
def styled(
    rc: Mapping[str, Any] | None = None,
    *,
    width: float | None = None,
    font_size: float | None = None,
    colormap: str | None = None,
) -> Iterator[None]:
    """Change the look of all pictures and movies made meanwhile.

    Parameters
    ----------
    rc : mapping, optional
        Any of ``matplotlib.rcParams``.
    width : float, optional
        Width of new figures in inches, 1 to 40: 3.4 for one column, 7.0 for a page.
    font_size : float, optional
        Size of the text in points, 1 to 100; labels, ticks and legends keep their proportions.
    colormap : str, optional
        Name of a colour map of matplotlib's for every field and measure.

    Raises
    ------
    InputError
        For a value that cannot be used.

    Notes
    -----
    What you set in ``matplotlib.rcParams``, by a style sheet or otherwise, is kept as well.

    Examples
    --------
    >>> with styled(width=3.3, font_size=9):
    ...     pass  # cc.plot.path(run)
    """
    settings = _checked_settings({} if rc is None else rc)
    if font_size is not None:
        settings["font.size"] = real_number("font_size", font_size, 1.0, 100.0)
    now = _chosen.get()
    if width is not None:
        now = replace(now, width=real_number("width", width, 1.0, 40.0))
    if colormap is not None:
        now = replace(now, colormap=checked_colormap(colormap))
    token = _chosen.set(now)
    try:
        with mpl.rc_context(settings):
            yield
    finally:
        _chosen.reset(token)


def _checked_settings(rc: Any) -> Any:
    settings: Any = dict(table("rc", rc))
    known_names("matplotlib.rcParams", settings, mpl.rcParams)
    for name, value in settings.items():
        try:
            mpl.RcParams({name: value})
        except ValueError as error:
            raise InputError(f"rc: {name} = {shown(value)}: {error}") from None
    return settings


def checked_colormap(name: Any) -> str:
    """Return ``name`` if it is one of matplotlib's colour maps, or raise `InputError`."""
    if not isinstance(name, str):
        raise InputError(f"colormap is the name of a colour map, not {shown(name)}")
    known_names("matplotlib", [name], mpl.colormaps)
    return name


def colormap_for(usual: str, given: str | None = None) -> str:
    """Return the colour map given, the one of `styled`, or the usual one."""
    return checked_colormap(given) if given is not None else _chosen.get().colormap or usual


@checked
def house_style() -> Any:
    """Return the settings that pictures of this package have, for figures of your own.

    Returns
    -------
    dict
        Settings for ``matplotlib.rcParams``. What you have set there yourself is left out.

    See Also
    --------
    styled : Change the look of all pictures for a while.

    Examples
    --------
    >>> import matplotlib as mpl
    >>> with mpl.rc_context(house_style()):
    ...     pass  # draw
    """
    users = {name for name in STYLE if mpl.rcParams[name] != mpl.rcParamsDefault[name]}
    size = mpl.rcParams["font.size"] if "font.size" in users else STYLE["font.size"]
    grown = float(size) / STYLE["font.size"]
    return {
        name: value * grown if name in _TEXT_SIZES else value
        for name, value in STYLE.items()
        if name not in users
    }


class PaperFigure(Figure):
    """A figure in the house style that keeps it when drawn later, and shows in notebooks."""

    def __init__(self, *args: Any, **options: Any) -> None:
        self._settings = house_style()
        with mpl.rc_context(self._settings):
            super().__init__(*args, **options)
        # Settings of the user's may be gone when the figure is drawn.
        self._settings = {name: mpl.rcParams[name] for name in STYLE} | self._settings

    def draw(self, renderer: RendererBase) -> None:
        """Draw; ticks made only now get the same style."""
        with mpl.rc_context(self._settings):
            super().draw(renderer)

    def _repr_png_(self) -> bytes | None:
        return None if shown_by_pyplot(self) else png_of(self)

    def _ipython_display_(self) -> None:
        """Leave a figure that pyplot shows to pyplot, or it would appear twice."""
        if not shown_by_pyplot(self):
            raise NotImplementedError


class PaperAxes(Axes):
    """The only axes of a figure, which shows as its picture in notebooks."""

    def _repr_png_(self) -> bytes | None:
        figure = figure_of(self)
        return None if shown_by_pyplot(figure) else png_of(figure)


@contextmanager
def paper_figure(
    width: float, height: float, *, equal: bool = False, layout: Any = None, shown: bool = False
) -> Iterator[Figure]:
    """Give a new figure, in inches; what is drawn on it meanwhile is in the house style.

    ``equal`` packs axes of equal aspect closely, and a width from `styled` scales the height too.
    With ``shown`` the figure is one of pyplot's, if that is loaded: ``plt.show`` shows it.
    """
    wanted = _chosen.get().width or width
    size = (wanted, height * wanted / width if equal else height)
    layout = layout or ("compressed" if equal else "constrained")
    with mpl.rc_context(house_style()):
        pyplot: Any = sys.modules.get("matplotlib.pyplot") if shown else None
        if pyplot is not None:
            yield pyplot.figure(FigureClass=PaperFigure, figsize=size, layout=layout)
        else:
            figure = PaperFigure(figsize=size, layout=layout)
            FigureCanvasAgg(figure)
            yield figure


@contextmanager
def axes_or_new(ax: Any, width: float, height: float, *, equal: bool = False) -> Iterator[Axes]:
    """Give ``ax`` with the user's settings, or the axes of a new figure in the house style."""
    if ax is not None:
        yield one_axes(ax)
        return
    with paper_figure(width, height, equal=equal, shown=True) as figure:
        yield figure.add_subplot(axes_class=PaperAxes)


def one_axes(ax: Any, name: str = "ax") -> Axes:
    """Return ``ax`` if it is matplotlib's Axes, or raise `InputError`."""
    if not isinstance(ax, Axes):
        raise InputError(f"{name} must be matplotlib's Axes, not {shown(type(ax).__name__)}")
    if ax.name in ("polar", "3d"):
        raise InputError(f"{name} must be matplotlib's Axes of x and y, not {ax.name} ones")
    return ax


def several_axes(axes: Any, count: int, what: str) -> list[Axes]:
    """Return ``count`` axes from a sequence or an array of them, or raise `InputError`."""
    if isinstance(axes, Axes):
        given = [axes]
    elif hasattr(axes, "ravel"):  # plt.subplots(2, 2)[1]
        given = list(axes.ravel())
    elif isinstance(axes, (list, tuple)):
        given = list(axes)
    else:
        raise InputError(
            f"axes must be {count} of matplotlib's Axes, {what}, not {shown(type(axes).__name__)}"
        )
    if len(given) != count:
        raise InputError(f"there are {len(given)} axes for {count}: {what}")
    return [one_axes(ax, f"axes[{number}]") for number, ax in enumerate(given)]


def figure_of(ax: Axes) -> Figure:
    """Return the figure an axes is on, also from within subfigures."""
    figure = ax.get_figure(root=True)
    assert figure is not None
    return figure


def on(ax: Axes, colour: str) -> str:
    """Return one of the house's greys as it is on these axes, light on a dark background."""
    behind = [figure_of(ax).get_facecolor(), *([ax.get_facecolor()] if ax.axison else [])]
    solid = [part[:3] for part in map(to_rgba, behind) if part[3] > 0.5]
    dark = bool(solid) and sum(solid[-1]) < 1.5
    return _ON_DARK.get(colour, colour) if dark else colour
