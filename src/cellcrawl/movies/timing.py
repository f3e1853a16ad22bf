"""Which records become frames."""

from __future__ import annotations

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.validation import real_number

_USUAL_SECONDS = 10.0
_MOST_FRAMES = 100_000
_SHORTEST_IN_GIF = 2  # hundredths of a second


def frame_records(
    times: np.ndarray, fps: float, seconds: float | None, every: float | None
) -> np.ndarray:
    """Return the record of each frame. Every frame is a saved record, none is interpolated.

    ``seconds`` spreads the run over that length, ``every`` shows one record in that time; given
    neither, a whole number of records is left out between frames so that it takes about ten
    seconds, or less for a short run. The last record is always the last frame.
    """
    if seconds is not None and every is not None:
        raise InputError("seconds and every both set the length of the movie: give one of them")
    first, last = float(times[0]), float(times[-1])
    if seconds is not None:
        frames = max(round(fps * real_number("seconds", seconds, 0.0, 1e5, open_low=True)), 1)
        return _nearest(times, np.linspace(first, last, _allowed(frames)))
    if every is not None:
        step = real_number("every", every, 0.0, 1e9, open_low=True)
        finest = float(np.min(np.diff(times[:-1]))) if times.size > 2 else 0.0
        if step < finest * (1.0 - 1e-6):
            raise InputError(f"every = {step:g} is less than the time between records, {finest:g}")
        count = _allowed((last - first) / step * (1.0 + 1e-9) + 1)
        records = _nearest(times, first + step * np.arange(count))
    else:
        stride = max(1, round((times.size - 1) / (_USUAL_SECONDS * fps)))
        records = np.arange(0, times.size, stride)
    return records if records[-1] == times.size - 1 else np.append(records, times.size - 1)


def gif_times(frames: int, fps: float) -> tuple[np.ndarray, list[int]]:
    """Return which frames a GIF shows and for how many milliseconds each.

    A GIF counts in hundredths of a second, and players slow down frames of less than two: each
    frame that is shown begins at the hundredth nearest its time, and the last ends at the nearest.
    """
    begins = np.rint(np.arange(frames + 1) * 100.0 / fps).astype(int)
    shown = [0]
    for frame in range(1, frames):
        if begins[frame] - begins[shown[-1]] >= _SHORTEST_IN_GIF:
            shown.append(frame)
    shown[-1] = frames - 1  # the last record is always the last frame
    starts = begins[[0, *shown[1:]]]
    ends = np.append(starts[1:], max(begins[frames], starts[-1] + _SHORTEST_IN_GIF))
    return np.array(shown), (10 * (ends - starts)).tolist()


def _allowed(frames: float) -> int:
    if frames > _MOST_FRAMES:
        raise InputError(f"this movie would have {frames:.0f} frames; {_MOST_FRAMES} is the most")
    return int(frames)


def _nearest(times: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    if times.size == 1:
        return np.zeros(wanted.size, dtype=int)
    after = np.clip(np.searchsorted(times, wanted), 1, times.size - 1)
    nearer: np.ndarray = np.where(
        wanted - times[after - 1] <= times[after] - wanted, after - 1, after
    )
    return nearer
