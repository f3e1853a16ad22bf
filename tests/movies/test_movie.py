"""Movies: what is in the file, and what is left when there is none."""

from __future__ import annotations

import builtins
import contextlib
import itertools
import os
import pickle
import signal
import subprocess
import sys
import time

import imageio_ffmpeg
import numpy as np
import pytest
from PIL import Image

import cellcrawl as cc
from cellcrawl.movies.scene import Scene
from cellcrawl.movies.timing import gif_times
from cellcrawl.plot.inputs import drawable
from tests.runs import circling, straight

RUN = circling(0.3, records=101)
SMALL = (160, 120)


def read_mp4(path, size: tuple[int, int]) -> tuple[str, np.ndarray]:
    """What ffmpeg says of a movie, and its frames, shape (frames, height, width, 3)."""
    command = [imageio_ffmpeg.get_ffmpeg_exe(), "-i", str(path), "-f", "rawvideo"]
    read = subprocess.run([*command, "-pix_fmt", "rgb24", "-"], capture_output=True, check=True)
    width, height = size
    frames = np.frombuffer(read.stdout, np.uint8).reshape(-1, height, width, 3)
    return read.stderr.decode(), frames


def test_mp4_has_the_frames_size_and_rate_asked_for(tmp_path):
    path = cc.movie(RUN, tmp_path / "cell.mp4", fps=20, seconds=1.5, size=SMALL)
    assert path == tmp_path / "cell.mp4"
    said, frames = read_mp4(path, SMALL)
    assert len(frames) == 30
    stream = next(line for line in said.splitlines() if "Video:" in line)
    for fact in ("h264", "yuv420p", "160x120", "20 fps"):
        assert fact in stream
    assert list(tmp_path.iterdir()) == [path]


def test_mp4_shows_what_was_drawn(tmp_path):
    path = cc.movie(RUN, tmp_path / "cell.mp4", every=5.0, size=SMALL, view="path")
    frames = read_mp4(path, SMALL)[1]
    scene = Scene(RUN, np.array([0, 50, 100]), "bound_fraction", None, "path", SMALL)
    for number, frame in enumerate(frames.astype(float)):
        drawn = scene.draw(number)[..., :3]
        away = np.abs(frames - drawn.astype(float)).mean(axis=(1, 2, 3))
        assert np.argmin(away) == number
        assert np.abs(frame - drawn).mean() < 3.0  # of 255: colour has half the resolution


def test_gif_has_the_frames_size_and_rate_asked_for(tmp_path):
    path = cc.movie(RUN, tmp_path / "cell.gif", fps=20, seconds=1.5, size=(161, 121))
    with Image.open(path) as gif:
        assert (gif.n_frames, gif.size) == (30, (161, 121))
        assert gif.info["duration"] == 50
        assert gif.info["loop"] == 0
        colours = gif.convert("RGB").getcolors()
        assert max(colours)[1] == (255, 255, 255)
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    ("options", "frames"),
    [
        ({"every": 1.0}, 11),
        ({"every": 3.0}, 5),  # 0, 3, 6, 9 and the end
        ({"fps": 5}, 51),  # every second record makes ten seconds
        ({}, 101),  # a short run: every record once
    ],
)
def test_length_follows_from_every_or_from_the_records(tmp_path, options, frames):
    path = cc.movie(RUN, tmp_path / "cell.mp4", size=(64, 64), **options)
    assert imageio_ffmpeg.count_frames_and_secs(str(path))[0] == frames


def test_a_path_view_shows_the_cell_where_it_is(tmp_path):
    run = straight((0.5, 0.0))
    scene = Scene(run, np.array([0, 10]), "bound_fraction", None, "path", (300, 200))
    left, right = (int(np.argmax(_body(scene, frame))) for frame in (0, 1))
    per_unit = 300 / (2 * 1.15 * 3.5)  # the path and the cell are 7 wide
    assert right - left == pytest.approx(5.0 * per_unit, abs=3)


def test_a_camera_that_follows_keeps_the_cell_in_the_middle():
    scene = Scene(RUN, np.array([0, 60]), "bound_fraction", None, "follow", (300, 200))
    middles = [np.average(np.arange(300), weights=_body(scene, frame)) for frame in (0, 1)]
    np.testing.assert_allclose(middles, 149.5, atol=3.0)


def _body(scene: Scene, frame: int) -> np.ndarray:
    """How many pixels of each column have a colour of the edge, above the strip."""
    picture = scene.draw(frame)[:160, :, :3].astype(int)
    coloured = (np.ptp(picture, axis=2) > 60) & (picture[..., 1] > picture[..., 0])
    return coloured.sum(axis=0)


def test_frames_show_saved_records_only():
    from cellcrawl.movies.timing import frame_records

    times = np.array([0.0, 0.1, 0.2, 0.3, 0.37])
    np.testing.assert_array_equal(frame_records(times, 25, None, None), np.arange(5))
    np.testing.assert_array_equal(frame_records(times, 25, None, 0.2), [0, 2, 4])
    np.testing.assert_array_equal(frame_records(times, 10, 1.0, None)[[0, -1]], [0, 4])


def test_progress_bar_counts_the_frames(tmp_path, capsys):
    cc.movie(RUN, tmp_path / "cell.mp4", every=5.0, size=(64, 64), progress=True)
    assert "3/3" in capsys.readouterr().err
    cc.movie(RUN, tmp_path / "cell.mp4", every=5.0, size=(64, 64))
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("suffix", ["mp4", "gif"])
def test_a_cancelled_movie_leaves_no_file_and_keeps_the_old_one(tmp_path, monkeypatch, suffix):
    path = tmp_path / f"cell.{suffix}"
    path.write_text("old")
    draw = Scene.draw

    def cancelled(self, frame):
        if frame == 5:
            raise KeyboardInterrupt
        return draw(self, frame)

    monkeypatch.setattr(Scene, "draw", cancelled)
    with pytest.raises(KeyboardInterrupt):
        cc.movie(RUN, path, size=(64, 64))
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.skipif(sys.platform == "win32", reason="signals to a process group")
def test_ctrl_c_on_the_terminal_leaves_no_file_and_no_encoder(tmp_path):
    code = (
        "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "from tests.runs import circling; import cellcrawl as cc\n"
        f"cc.movie(circling(0.3), {str(tmp_path / 'cell.mp4')!r}, seconds=3000)"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", code], stderr=subprocess.PIPE, process_group=0
    )
    unfinished = tmp_path / f".cell.{process.pid}.part.mp4"
    try:
        give_up = time.monotonic() + 60.0
        while not (unfinished.exists() and unfinished.stat().st_size):
            assert process.poll() is None, process.stderr.read().decode()
            assert time.monotonic() < give_up
            time.sleep(0.05)
        os.killpg(process.pid, signal.SIGINT)
        _, said = process.communicate(timeout=30)
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
    assert b"KeyboardInterrupt" in said
    assert list(tmp_path.iterdir()) == []
    assert str(unfinished) not in _command_lines()


def _command_lines() -> str:
    return subprocess.run(["ps", "-eo", "args"], capture_output=True, text=True, check=True).stdout


@pytest.mark.parametrize(
    ("name", "options", "said"),
    [
        ("cell.avi", {}, r"ends in \.mp4 or \.gif"),
        ("cell", {}, r"ends in \.mp4 or \.gif"),
        ("cell.mp4", {"view": "top"}, "must be one of 'follow', 'path'"),
        ("cell.mp4", {"field": "bound"}, "did you mean 'bound_fraction'"),
        ("cell.mp4", {"fps": 0}, "movie fps = 0 is out of range"),
        ("cell.mp4", {"seconds": -1}, "seconds = -1 is out of range"),
        ("cell.mp4", {"seconds": 1, "every": 1}, "give one of them"),
        ("cell.mp4", {"every": 0.01}, "less than the time between records, 0.1"),
        ("cell.mp4", {"seconds": 9e4}, "100000 is the most"),
        ("cell.mp4", {"size": (161, 120)}, "needs even width and height"),
        ("cell.mp4", {"size": 300}, "two whole numbers"),
        ("cell.mp4", {"size": (8, 8)}, "from 64 to 4096"),
    ],
)
def test_mistakes_are_refused_in_one_line_before_anything_is_written(tmp_path, name, options, said):
    with pytest.raises(cc.InputError, match=said) as error:
        cc.movie(RUN, tmp_path / name, **options)
    assert "\n" not in str(error.value)
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_is_not_there_is_named(tmp_path):
    with pytest.raises(cc.StorageError, match="nowhere does not exist"):
        cc.movie(RUN, tmp_path / "nowhere" / "cell.mp4")


def test_a_folder_that_cannot_be_written_is_named(tmp_path, monkeypatch):
    def refuse(self, *_, **__):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("pathlib.Path.touch", refuse)  # root may write everywhere
    with pytest.raises(cc.StorageError, match="cannot be written: Permission denied"):
        cc.movie(RUN, tmp_path / "cell.mp4")


def test_an_encoder_that_fails_is_one_line_and_leaves_no_file(tmp_path, monkeypatch):
    broken = tmp_path / "ffmpeg"
    broken.write_text("#!/bin/sh\necho 'first trouble' >&2\necho 'no space left' >&2\nexit 1\n")
    broken.chmod(0o755)
    monkeypatch.setattr("imageio_ffmpeg.get_ffmpeg_exe", lambda: str(broken))
    with pytest.raises(cc.StorageError, match=r"could not be encoded: no space left$"):
        cc.movie(RUN, tmp_path / "cell.mp4", size=(640, 480))
    assert list(tmp_path.iterdir()) == [broken]


def test_without_an_encoder_a_gif_is_offered(tmp_path, monkeypatch):
    load = builtins.__import__

    def without_ffmpeg(name, *rest):
        if name == "imageio_ffmpeg":
            raise ImportError(name)
        return load(name, *rest)

    monkeypatch.setattr(builtins, "__import__", without_ffmpeg)
    with pytest.raises(cc.errors.MissingExtraError, match=r"write a \.gif"):
        cc.movie(RUN, tmp_path / "cell.mp4")


@pytest.mark.parametrize("fps", [7.0, 24.0, 30.0, 50.0, 60.0, 120.0])
@pytest.mark.parametrize("frames", [1, 2, 75, 600])
def test_a_gif_takes_as_long_as_its_frames(fps, frames):
    shown, durations = gif_times(frames, fps)
    assert sum(durations) == pytest.approx(1000.0 * frames / fps, abs=20.1)
    assert min(durations) >= 20
    assert shown[-1] == frames - 1
    assert np.all(np.diff(shown) > 0)
    assert len(shown) == len(durations)


def test_a_movie_shows_itself_in_a_notebook_and_is_a_path_all_the_same(tmp_path):
    made = cc.movie(RUN, tmp_path / "cell.gif", seconds=0.1, size=SMALL)
    assert made == tmp_path / "cell.gif"
    assert made._repr_html_().startswith('<img src="data:image/gif;base64,R0lGOD')
    assert pickle.loads(pickle.dumps(made)) == made
    assert made.parent._repr_html_() is None
    made.unlink()
    assert made._repr_html_() is None


@pytest.mark.parametrize("field", ["bound_fraction", "normal_velocity", "curvature", "off_rate"])
@pytest.mark.parametrize("run", [RUN, cc.Scales().dataset(RUN)], ids=["plain", "si"])
def test_time_has_its_unit_and_nothing_on_the_strip_runs_into_another(field, run):
    scene = Scene(drawable(run), np.array([0, 9]), field, None, "follow", (480, 360))
    scene.draw(1)
    strip, box = scene._ax.figure.axes[1:]
    renderer = scene._canvas.get_renderer()
    texts = [text for text in strip.texts if text.get_text()]
    spans = [text.get_window_extent(renderer) for text in (*texts, *box.texts)]
    spans += [line.get_window_extent(renderer) for line in strip.lines]
    spans.append(box.bbox)
    spans.sort(key=lambda span: span.x0)
    for left, right in itertools.pairwise(spans):
        assert left.x1 <= right.x0 + 0.5
    assert any(unit in text.get_text() for text in texts for unit in ("k_", "s"))
