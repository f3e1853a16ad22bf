"""How many runs go to a worker at a time."""

from __future__ import annotations

import math

_SHORTEST, _LONGEST = 1.5, 20.0  # seconds of work: less is overhead, more is coarse
_SHARE = 0.02  # of a worker's whole work
_FORGET = 0.7  # of what was learnt, with each chunk: the first ones load the kernels
_MOST = 1000
_ROUNDS = 2  # chunks per worker that should be left when the end is near


class ChunkSize:
    """Sizes chunks by the time that runs have taken so far.

    A chunk is about 2 % of what a worker has to do, 1.5 to 20 s long: starting one costs some
    10 ms, and what a killed worker or a full disk can spoil is one chunk. Near the end chunks
    shrink, so that the workers finish together.
    """

    def __init__(self, workers: int) -> None:
        self.workers = max(workers, 1)
        self._runs = self._seconds = 0.0

    def learn(self, runs: int, seconds: float) -> None:
        """Take note of a finished chunk."""
        self._runs = _FORGET * self._runs + runs
        self._seconds = _FORGET * self._seconds + seconds

    def next(self, left: int) -> int:
        """Return the size of the next chunk with ``left`` runs to give out."""
        fair = math.ceil(left / (_ROUNDS * self.workers))
        if self._runs == 0.0:
            return 1
        each = max(self._seconds / self._runs, 1e-6)
        target = min(max(_SHARE * left * each / self.workers, _SHORTEST), _LONGEST)
        return max(1, min(math.ceil(target / each), fair, _MOST))
