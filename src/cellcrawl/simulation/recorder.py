"""Where the records of a running simulation go: to memory, or to a store on disk in blocks."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any, ClassVar, Protocol, TypeVar

import numpy as np
import xarray as xr

from cellcrawl.simulation.dataset import encode_attributes, frames_to_dataset
from cellcrawl.simulation.storage import RunStore, open_run
from cellcrawl.solvers import Frame

Checkpoint = dict[str, np.ndarray]
Kept_co = TypeVar("Kept_co", covariant=True)
BLOCK_BYTES = 8_000_000
BLOCK_SECONDS = 1.0


class Recorder(Protocol[Kept_co]):
    """Takes records in order of time and gives back what it kept of them."""

    edges: ClassVar[bool]
    """Whether it needs each record's whole `Frame`; without, it is given the `Instant`."""

    def record(self, record: Any) -> bool:
        """Take a record; True when it is time for a `commit`."""
        ...

    def commit(self, checkpoint: Checkpoint, attributes: Mapping[str, Any]) -> None:
        """Make what was recorded safe, with the state to go on from."""
        ...

    def finish(
        self, closing: Any, checkpoint: Checkpoint, attributes: Mapping[str, Any]
    ) -> Kept_co:
        """End the run and return what was kept. ``closing`` is a last record off the time grid."""
        ...


class MemoryRecorder:
    """Keeps every frame in memory."""

    edges: ClassVar[bool] = True

    def __init__(self) -> None:
        self._frames: list[Frame] = []

    def record(self, frame: Frame) -> bool:
        self._frames.append(frame)
        return False

    def commit(self, checkpoint: Checkpoint, attributes: Mapping[str, Any]) -> None:
        return

    def finish(
        self, closing: Frame | None, checkpoint: Checkpoint, attributes: Mapping[str, Any]
    ) -> xr.Dataset:
        frames = [*self._frames, closing] if closing is not None else self._frames
        return frames_to_dataset(frames, encode_attributes(attributes))


class StoreRecorder:
    """Writes blocks of frames to a `RunStore`: memory stays flat and a kill loses little."""

    edges: ClassVar[bool] = True

    def __init__(self, store: RunStore, records: int) -> None:
        self._store = store
        self._records = records
        self._frames: list[Frame] = []
        self._flushed = -np.inf  # the first frame is made safe at once

    def record(self, frame: Frame) -> bool:
        self._frames.append(frame)
        size = len(self._frames) * frame.x.nbytes * 8
        return size > BLOCK_BYTES or time.monotonic() - self._flushed > BLOCK_SECONDS

    def commit(self, checkpoint: Checkpoint, attributes: Mapping[str, Any]) -> None:
        block = frames_to_dataset(self._frames, {}) if self._frames else None
        self._store.write_block(self._records, block, checkpoint, encode_attributes(attributes))
        self._records += len(self._frames)
        self._frames = []
        self._flushed = time.monotonic()

    def finish(
        self, closing: Frame | None, checkpoint: Checkpoint, attributes: Mapping[str, Any]
    ) -> xr.Dataset:
        frames = [*self._frames, closing] if closing is not None else self._frames
        on_grid = self._records + len(self._frames)
        last = {**encode_attributes(attributes), "records_on_grid": on_grid}
        block = frames_to_dataset(frames, {}) if frames else None
        self._store.finish(self._records, block, checkpoint, last)
        return open_run(self._store.path)
