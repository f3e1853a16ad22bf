"""Frames into a file: H.264 in MP4 by ffmpeg, GIF by Pillow."""

from __future__ import annotations

import contextlib
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from cellcrawl.errors import MissingExtraError, StorageError

_COLOURS = 128


def write_mp4(path: Path, frames: Iterable[np.ndarray], size: tuple[int, int], fps: float) -> None:
    """Write frames, shape (height, width, 4), as H.264 that every player plays.

    Whatever stops it, no encoder is left running.
    """
    command = [
        encoder(), "-y", "-v", "error",
        "-f", "rawvideo", "-pix_fmt", "rgba", "-s", f"{size[0]}x{size[1]}", "-r", f"{fps:.6f}",
        "-i", "-", "-an",
        "-c:v", "libx264", "-preset", "veryfast", "-crf", "18", "-pix_fmt", "yuv420p",
        "-movflags", "+faststart",
        str(path),
    ]  # fmt: skip
    with tempfile.TemporaryFile() as complaints:
        process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=complaints,
            **_out_of_reach_of_ctrl_c(),
        )
        assert process.stdin is not None
        try:
            for frame in frames:
                process.stdin.write(frame.data)
            process.stdin.close()
            process.wait()
        except BrokenPipeError:
            process.wait()
        finally:
            if process.poll() is None:
                process.kill()
                process.wait()
            with contextlib.suppress(OSError):
                process.stdin.close()
        if process.returncode != 0:
            complaints.seek(0)
            lines = complaints.read().decode(errors="replace").strip().splitlines()
            reason = lines[-1].strip() if lines else f"exit code {process.returncode}"
            raise StorageError(f"the movie could not be encoded: {reason}")


def write_gif(path: Path, frames: Iterable[np.ndarray], durations: Sequence[int]) -> None:
    """Write frames, shape (height, width, 4), as a GIF that repeats; all share one palette.

    ``durations`` are in milliseconds, one for each frame.
    """
    images = _palette_images(iter(frames))
    first = next(images)
    with path.open("wb") as file:
        first.save(
            file,
            format="GIF",
            save_all=True,
            append_images=images,
            duration=list(durations),
            loop=0,
            optimize=False,
        )


def encoder() -> str:
    """Return the path of ffmpeg, or raise `MissingExtraError`."""
    try:
        from imageio_ffmpeg import get_ffmpeg_exe

        return str(get_ffmpeg_exe())
    except (ImportError, RuntimeError):
        raise MissingExtraError(
            "MP4 movies need ffmpeg: pip install imageio-ffmpeg, or write a .gif"
        ) from None


def _palette_images(frames: Iterator[np.ndarray]) -> Iterator[Image.Image]:
    palette: Image.Image | None = None
    for frame in frames:
        image = Image.fromarray(frame[..., :3])
        if palette is None:
            palette = _with_white(image.quantize(_COLOURS, dither=Image.Dither.NONE))
        yield image.quantize(palette=palette, dither=Image.Dither.NONE)


def _with_white(image: Image.Image) -> Image.Image:
    """Make all nearly white colours of the palette white, so that the background stays white.

    Pillow finds the nearest colour only up to a few levels.
    """
    colours = np.array(image.getpalette(), dtype=np.uint8).reshape(-1, 3)
    colours[colours.min(axis=1) >= 248] = 255
    image.putpalette(colours.tobytes())
    return image


def _out_of_reach_of_ctrl_c() -> dict[str, Any]:
    """Start the encoder in its own process group: Ctrl-C is ours to act on."""
    if sys.platform == "win32":
        return {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP}
    return {"process_group": 0}
