"""The picture in a movie: built once, then only what moves is drawn again."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.patches import Polygon
from matplotlib.text import Text

from cellcrawl.plot.colouring import Colouring, colouring
from cellcrawl.plot.edge import length_text, rim, round_length, segments
from cellcrawl.plot.ground import draw_ground
from cellcrawl.plot.labels import time_text
from cellcrawl.plot.scales import Limits, extend_for, ticks_for
from cellcrawl.plot.style import BODY, GUIDE, INK, STYLE, TRACK, house_style, on

_PIXELS_A_PIECE = 3.5  # an edge is thinned until its pieces are about this long on the screen
_DPI_OF_480_LINES = 110.0  # text and lines grow with the smaller side of the picture
_STRIP = 0.13  # of the height, below the view: time, scale bar, colour bar
_MIDDLE = 0.62  # of the strip
_ROOM = 2.1  # half the view of a camera that follows, in cell radii
_FAINT = 0.35  # of the colour of guides, for the grid
_TEXT, _SMALL = 10.0, 8.5  # sizes at the house's font size


class Scene:
    """A cell on its path, ready to be drawn at each of some records.

    Parameters
    ----------
    dataset : Dataset
        A run, in memory or on disk; only what is shown is read.
    records : array of int, shape (frames,)
        The records to show.
    field : str
        The field that colours the edge.
    limits : (float, float) or None
        Ends of the colour scale.
    view : {"follow", "path"}
        The camera stays with the cell, or shows the whole path.
    size : (int, int)
        Width and height in pixels.
    colormap : str, optional
        Another colour map than the field's own.
    """

    def __init__(
        self,
        dataset: xr.Dataset,
        records: np.ndarray,
        field: str,
        limits: Limits | None,
        view: str,
        size: tuple[int, int],
        colormap: str | None = None,
    ) -> None:
        shown = dataset.isel(time=records)
        self._points = np.stack([shown["x"].values, shown["y"].values], axis=-1)
        self._values = shown[field].values
        self._longest = float(shown["length"].values.max())
        self._records = records
        self._run = shown
        self._colours = colouring(shown, field, self._values, limits, colormap)
        self._follows = view == "follow"
        self._track = np.column_stack([dataset["centroid_x"].values, dataset["centroid_y"].values])
        self._times = shown["time"].values
        self._digits = _digits(dataset["time"].values)
        with mpl.rc_context(house_style()):
            self._build(size)

    def _build(self, size: tuple[int, int]) -> None:
        dpi = _DPI_OF_480_LINES * min(size) / 480.0
        # a bit of a pixel more, which canvases cut off: some would cut 119.99.. off to 119
        inches = ((size[0] + 1e-3) / dpi, (size[1] + 1e-3) / dpi)
        figure = Figure(figsize=inches, dpi=dpi)
        canvas: Any = FigureCanvasAgg(figure)
        self._canvas = canvas
        self._ax = figure.add_axes((0.0, _STRIP, 1.0, 1.0 - _STRIP), xticks=[], yticks=[])
        self._ax.spines[["left", "right", "top"]].set_visible(False)
        strip = figure.add_axes((0.0, 0.0, 1.0, _STRIP))
        strip.set_axis_off()
        view = np.array([size[0], size[1] * (1.0 - _STRIP)])
        self._frame(view)
        self._ground = self._add_ground()
        guide = on(self._ax, GUIDE)
        self._grid = LineCollection([], colors=guide, alpha=_FAINT, linewidths=0.6, zorder=0)
        self._line = self._ax.plot([], [], color=TRACK, linewidth=1.2, zorder=1)[0]
        self._dot = self._ax.plot([], [], "o", color=TRACK, markersize=3.0, zorder=4)[0]
        self._body = Polygon(np.zeros((3, 2)), facecolor=on(self._ax, BODY), alpha=0.8, zorder=2)
        self._edge = LineCollection(
            [],
            cmap=self._colours.colormap,
            norm=self._colours.norm,
            linewidths=2.2,
            capstyle="round",
            zorder=3,
        )
        self._ax.add_collection(self._grid, autolim=False)
        self._ax.add_patch(self._body)
        self._rim = rim(self._ax, np.zeros((3, 2)), self._colours, 2.2, 3)
        self._ax.add_patch(self._rim)
        self._ax.add_collection(self._edge, autolim=False)
        grown = float(mpl.rcParams["font.size"]) / STYLE["font.size"]
        self._last = float(self._times[-1])
        self._clock, free_from = self._add_clock(strip, _TEXT * grown)
        self._stride = self._thinning(size[0])
        pieces = len(range(0, self._points.shape[1], self._stride))
        self._edge.set_segments(list(np.zeros((pieces, 3, 2))))
        self._moving = [
            *([self._ground] if self._ground is not None and self._follows else []),
            self._grid,
            self._body,
            self._line,
            self._rim,
            self._edge,
            self._dot,
            self._clock,
        ]
        for artist in self._moving:
            artist.set_animated(True)
        free_from = self._add_scale_bar(strip, free_from, _SMALL * grown)
        self._add_colour_bar(figure, self._colours, free_from, _SMALL * grown)
        canvas.draw()
        self._background = canvas.copy_from_bbox(figure.bbox)

    def _frame(self, view: np.ndarray) -> None:
        """Set what is in view: half its width and height is `_reach`, its middle `_middle`."""
        shape = view / view[1]
        points = self._points
        if self._follows:
            widest = float(np.abs(points - self._track[self._records, None]).max())
            self._middle = np.zeros(2)
            self._reach = _ROOM * widest * shape / shape.min()
        else:
            low, high = points.min(axis=(0, 1)), points.max(axis=(0, 1))
            self._middle = 0.5 * (low + high)
            self._reach = float(np.max(0.5 * (high - low) / shape)) * 1.15 * shape
        self._ax.set_xlim(self._middle[0] - self._reach[0], self._middle[0] + self._reach[0])
        self._ax.set_ylim(self._middle[1] - self._reach[1], self._middle[1] + self._reach[1])

    def _add_ground(self) -> AxesImage | None:
        """Draw what surrounds the cell, over all the way that it goes."""
        camera = self._track if self._follows else np.zeros((1, 2))
        low, high = camera.min(axis=0) - self._reach, camera.max(axis=0) + self._reach
        if not self._follows:
            low, high = low + self._middle, high + self._middle
        pixels = round(320.0 * float(np.max(high - low) / (2.0 * self._reach.max())))
        ground = draw_ground(self._ax, self._run, low, high, min(pixels, 2000))
        if ground is not None:
            self._extent = np.array(ground.get_extent())
        return ground

    def _thinning(self, width: float) -> int:
        """Return of how many nodes one is drawn."""
        per_unit = width / (2.0 * float(self._reach[0]))
        pixels_a_node = self._longest * per_unit / self._points.shape[1]
        return max(1, round(float(_PIXELS_A_PIECE / pixels_a_node)))

    def _add_clock(self, ax: Axes, size: float) -> tuple[Text, float]:
        """Write ``t =`` and the unit once, and return the text between them, empty yet.

        Mathematics is slow to set. Also return, of the width, where the text ends.
        """
        latest = f"{self._last:.{self._digits}f}"
        place: Any = {"transform": ax.transAxes, "va": "center_baseline", "size": size}
        name = ax.text(0.03, _MIDDLE, "$t$ =", **place)
        clock = ax.text(_end(name) + 0.01, _MIDDLE, latest, ha="left", **place)
        unit = time_text(self._run, 0.0, ".0f")[1:]
        after = _end(clock) + (0.008 if unit.startswith(" ") else 0.0)
        unit_text = ax.text(after, _MIDDLE, unit.strip(), **place)
        clock.set_position((_end(clock), _MIDDLE))
        clock.set_horizontalalignment("right")  # against the unit
        clock.set_text("")
        return clock, _end(unit_text)

    def _add_scale_bar(self, ax: Axes, free_from: float, size: float) -> float:
        """Draw a bar of a round length on the strip, which is as wide as the view.

        Return, of the width, where its text ends.
        """
        reach = float(self._reach[0])
        length = round_length(0.3 * reach)
        low = free_from + 0.04
        high = low + length / (2.0 * reach)
        ink = on(self._ax, INK)
        ax.plot([low, high], [_MIDDLE, _MIDDLE], color=ink, lw=1.6, transform=ax.transAxes)
        text = ax.text(
            high + 0.015,
            _MIDDLE,
            length_text(self._run, length),
            transform=ax.transAxes,
            va="center",
            size=size,
        )
        return _end(text)

    def _add_colour_bar(
        self, figure: Figure, colours: Colouring, free_from: float, size: float
    ) -> None:
        """Draw the colour bar at the right, with as much of its label as there is room for."""
        left, right = 0.66, 0.97
        box = figure.add_axes((left, 0.52 * _STRIP, right - left, 0.2 * _STRIP))
        bar = figure.colorbar(
            self._edge,
            cax=box,
            orientation="horizontal",
            extend=extend_for(colours.norm, self._values),
        )
        ticks = ticks_for(colours.norm)
        if ticks is not None:
            bar.set_ticks(ticks, labels=[f"{tick:g}" for tick in ticks])
            box.minorticks_off()
        away = -0.09 if bar.extend in ("min", "both") else -0.03  # an arrow stands out
        label = box.text(
            away, 0.5, colours.label, transform=box.transAxes, ha="right", va="center", size=size
        )
        start = free_from + 0.03
        if _start(label, figure) < start:
            label.set_text(colours.short_label)
        missing = start - _start(label, figure)
        if missing > 0.0:  # the bar gives way
            left = min(left + missing, right - 0.12)
            box.set_position((left, 0.52 * _STRIP, right - left, 0.2 * _STRIP))

    def draw(self, frame: int) -> np.ndarray:
        """Return the picture of a frame, shape (height, width, 4), 8 bits each.

        The array is the canvas itself: the next call overwrites it.
        """
        record = self._records[frame]
        camera = self._track[record] if self._follows else np.zeros(2)
        points = self._points[frame, :: self._stride] - camera
        for path, piece in zip(self._edge.get_paths(), segments(points), strict=True):
            np.copyto(np.asarray(path.vertices), piece)  # far quicker than new paths
        self._edge.set_array(self._values[frame, :: self._stride])
        self._body.set_xy(points)
        self._rim.set_xy(points)
        past = self._track[: record + 1] - camera
        self._line.set_data(past[:, 0], past[:, 1])
        self._dot.set_data(past[-1:, 0], past[-1:, 1])
        if self._follows and self._ground is not None:
            shifted = self._extent - np.repeat(camera, 2)
            self._ground.set_extent(tuple(shifted.tolist()))
        if self._follows:
            self._grid.set_segments(self._grid_lines(camera))
        self._clock.set_text(f"{self._times[frame]:.{self._digits}f}")
        self._canvas.restore_region(self._background)
        for artist in self._moving:
            self._ax.draw_artist(artist)
        return np.asarray(self._canvas.buffer_rgba())

    def _grid_lines(self, camera: np.ndarray) -> list[Any]:
        """Lines on the substrate, so that the cell is seen to move."""
        apart = 2.0 * round_length(0.35 * float(self._reach.min()))
        lines = []
        for axis in (0, 1):
            low, high = camera[axis] - self._reach[axis], camera[axis] + self._reach[axis]
            across = self._reach[1 - axis]
            for place in apart * np.arange(np.ceil(low / apart), np.floor(high / apart) + 1):
                at = place - camera[axis]
                ends = np.array([[at, -across], [at, across]])
                lines.append(ends if axis == 0 else ends[:, ::-1])
        return lines


def _end(text: Text) -> float:
    """Return where a text ends, of the width of its axes."""
    assert text.axes is not None
    return float(text.get_window_extent().transformed(text.axes.transAxes.inverted()).x1)


def _start(text: Text, figure: Figure) -> float:
    """Return where a text begins, of the width of the figure."""
    return float(text.get_window_extent().x0 / figure.bbox.width)


def _digits(times: np.ndarray) -> int:
    """Decimals that tell records apart, at most three."""
    step = float(np.median(np.diff(times))) if times.size > 1 else 1.0
    return int(np.clip(np.ceil(-np.log10(max(step, 1e-3)) - 1e-9), 0, 3))
