"""The picture in a movie: built once, then only what moves is drawn again."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from matplotlib.text import Text

from cellcrawl.plot.edge import rim, round_length, segments
from cellcrawl.plot.scales import SCALES, Limits, extend_for, norm_for, ticks_for
from cellcrawl.plot.style import BODY, INK, STYLE, TRACK

_PIXELS_A_PIECE = 3.5  # an edge is thinned until its pieces are about this long on the screen
_DPI_OF_480_LINES = 110.0  # text and lines grow with the smaller side of the picture
_STRIP = 0.13  # of the height, below the view: time, scale bar, colour bar
_MIDDLE = 0.62  # of the strip
_ROOM = 2.1  # half the view of a camera that follows, in cell radii
_LIGHT = "#d9d9d9"


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
    """

    def __init__(
        self,
        dataset: xr.Dataset,
        records: np.ndarray,
        field: str,
        limits: Limits | None,
        view: str,
        size: tuple[int, int],
    ) -> None:
        shown = dataset.isel(time=records)
        self._points = np.stack([shown["x"].values, shown["y"].values], axis=-1)
        self._values = shown[field].values
        self._longest = float(shown["length"].values.max())
        self._records = records
        self._field = field
        self._follows = view == "follow"
        self._track = np.column_stack([dataset["centroid_x"].values, dataset["centroid_y"].values])
        self._times = shown["time"].values
        self._digits = _digits(dataset["time"].values)
        with mpl.rc_context(STYLE):
            self._build(size, limits)

    def _build(self, size: tuple[int, int], limits: Limits | None) -> None:
        dpi = _DPI_OF_480_LINES * min(size) / 480.0
        figure = Figure(figsize=(size[0] / dpi, size[1] / dpi), dpi=dpi)
        canvas: Any = FigureCanvasAgg(figure)
        self._canvas = canvas
        self._ax = figure.add_axes((0.0, _STRIP, 1.0, 1.0 - _STRIP), xticks=[], yticks=[])
        self._ax.spines[["left", "right", "top"]].set_visible(False)
        strip = figure.add_axes((0.0, 0.0, 1.0, _STRIP))
        strip.set_axis_off()
        view = np.array([size[0], size[1] * (1.0 - _STRIP)])
        self._frame(view)
        values = self._values
        norm = norm_for(self._field, values, limits)
        self._grid = LineCollection([], colors=_LIGHT, linewidths=0.6, zorder=0)
        self._line = self._ax.plot([], [], color=TRACK, linewidth=1.2, zorder=1)[0]
        self._dot = self._ax.plot([], [], "o", color=TRACK, markersize=3.0, zorder=4)[0]
        self._body = Polygon(np.zeros((3, 2)), facecolor=BODY, alpha=0.8, zorder=2)
        self._edge = LineCollection(
            [],
            cmap=SCALES[self._field].colormap,
            norm=norm,
            linewidths=2.2,
            capstyle="round",
            zorder=3,
        )
        self._ax.add_collection(self._grid, autolim=False)
        self._ax.add_patch(self._body)
        self._rim = rim(np.zeros((3, 2)), self._field, 2.2, 3)
        self._ax.add_patch(self._rim)
        self._ax.add_collection(self._edge, autolim=False)
        self._clock = _clock(strip)
        self._stride = self._thinning(size[0])
        pieces = len(range(0, self._points.shape[1], self._stride))
        self._edge.set_segments(list(np.zeros((pieces, 3, 2))))
        self._moving = [
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
        free_from = _scale_bar(strip, float(self._reach[0]))
        self._add_colour_bar(figure, values, norm, free_from)
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

    def _thinning(self, width: float) -> int:
        """Return of how many nodes one is drawn."""
        per_unit = width / (2.0 * float(self._reach[0]))
        pixels_a_node = self._longest * per_unit / self._points.shape[1]
        return max(1, round(float(_PIXELS_A_PIECE / pixels_a_node)))

    def _add_colour_bar(
        self, figure: Figure, values: np.ndarray, norm: Normalize, free_from: float
    ) -> None:
        scale = SCALES[self._field]
        box = figure.add_axes((0.66, 0.52 * _STRIP, 0.31, 0.2 * _STRIP))
        bar = figure.colorbar(
            self._edge, cax=box, orientation="horizontal", extend=extend_for(norm, values)
        )
        ticks = ticks_for(norm)
        if ticks is not None:
            bar.set_ticks(ticks, labels=[f"{tick:g}" for tick in ticks])
            box.minorticks_off()
        label = box.text(
            -0.03, 0.5, scale.label, transform=box.transAxes, ha="right", va="center", size=8.5
        )
        if label.get_window_extent().x0 < 1.03 * free_from:
            label.set_text(scale.short_label)

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


def _clock(ax: Axes) -> Text:
    """Write ``t =`` once and return the text after it, empty yet; mathematics is slow to set."""
    name = ax.text(0.03, _MIDDLE, "$t$ =", transform=ax.transAxes, va="center_baseline", size=10)
    after = name.get_window_extent().transformed(ax.transAxes.inverted()).x1 + 0.01
    return ax.text(after, _MIDDLE, "", transform=ax.transAxes, va="center_baseline", size=10)


def _scale_bar(ax: Axes, reach: float) -> float:
    """Draw a bar of a round length on the strip, which is as wide as the view, 2 ``reach``.

    Returns the pixel at which its text ends.
    """
    size = round_length(0.35 * reach)
    low, high = 0.2, 0.2 + size / (2.0 * reach)
    ax.plot([low, high], [_MIDDLE, _MIDDLE], color=INK, lw=1.6, transform=ax.transAxes)
    label = f"{size:g} $R_0$"
    text = ax.text(high + 0.015, _MIDDLE, label, transform=ax.transAxes, va="center", size=8.5)
    return float(text.get_window_extent().x1)


def _digits(times: np.ndarray) -> int:
    """Decimals that tell records apart, at most three."""
    step = float(np.median(np.diff(times))) if times.size > 1 else 1.0
    return int(np.clip(np.ceil(-np.log10(max(step, 1e-3)) - 1e-9), 0, 3))
