"""A solver, followed from saved time to saved time until the run ends."""

from __future__ import annotations

import math
import time as clock
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar

from cellcrawl.curve import first_crossing
from cellcrawl.errors import InputError
from cellcrawl.simulation.events import crossing_at, locate_crossing
from cellcrawl.simulation.explaining import explained
from cellcrawl.simulation.interruption import Interruption
from cellcrawl.simulation.progress import Progress
from cellcrawl.simulation.recorder import Checkpoint, Recorder
from cellcrawl.simulation.tension_law import KEY, TensionLaw
from cellcrawl.solvers import Breakdown, Frame, Instant, Solver

Kept = TypeVar("Kept")
_CHECK_EVERY = 0.1  # longest time between two looks for a self-crossing
_CHECKS_PER_CHECKPOINT = 10  # a crossing is traced back from the last checkpoint
_SAME_TIME = 1e-9  # relative
_MOST_RECORDS = 1e7


@dataclass
class Follower(Generic[Kept]):
    """One run on its way: the only place where solver, events, recorder and progress meet."""

    solver: Solver
    law: TensionLaw
    recorder: Recorder[Kept]
    identity: dict[str, Any]
    save_every: float
    progress: Progress
    records: int = 0
    wall_time: float = 0.0
    interruption: Interruption = field(default_factory=Interruption)

    def follow(self, t_end: float) -> Kept:
        """Go on to ``t_end`` or to whatever ends the run first; return what was recorded."""
        check_records(t_end, self.save_every)
        self._began = clock.monotonic()
        with self.interruption as interruption, self.progress:
            ended, closing = self._follow(t_end, interruption)
            last = None if closing is None else self._record_at(closing)
            reached = self._last_record() if closing is None else closing
            attributes = self._attributes(ended, reached)
            return self.recorder.finish(last, self._checkpoint(), attributes)

    def _follow(self, t_end: float, interruption: Interruption) -> tuple[Breakdown, float | None]:
        """Return how the run ended and the time of a closing record, None if it is on the grid."""
        now = max(self._last_record(), self.law.time) if self.records else -0.5 * _CHECK_EVERY
        valid, age = self._checkpoint(), 0
        while True:
            targets = self._next_targets(now, t_end)
            instants, ended = self.solver.instants([time for time, _ in targets])
            commits = False
            for (target, on_grid), seen in zip(targets, instants, strict=False):
                looked = self._looked_at(seen)
                if looked is None:
                    return self._torn(valid, now, target)
                broken = self.law.check(looked)
                if broken is not None:
                    return broken, None
                now = target
                if on_grid:
                    self.records += 1
                    self.progress.update(target, looked.tension)
                    commits = self.recorder.record(self._record_at(target, looked))
            if ended is not None:
                last = self.solver.time
                if crossing_at(self.solver, last) is not None:
                    return self._torn(valid, now, last)
                ended = explained(ended, self.solver, self.law.conditions)
                return ended, self._off_grid(max(last, now))
            age += len(instants)
            if commits or age >= _CHECKS_PER_CHECKPOINT:
                valid, age = self._checkpoint(), 0
            if commits:
                running = Breakdown("running", now, f"has reached t = {now:g}")
                self.recorder.commit(valid, self._attributes(running, now))
            if now >= t_end or same_time(now, t_end):
                done = Breakdown("completed", t_end, f"reached t_end = {t_end:g}")
                return done, self._off_grid(now)
            if interruption.requested:
                message = f"stopped at t = {now:.6g} by {interruption.requested}: can be resumed"
                return Breakdown("interrupted", now, message), self._off_grid(now)

    def _looked_at(self, seen: Instant) -> Instant | None:
        """Return the cell, as little of it as will do, or None if its edge crosses itself."""
        if seen.surely_simple:
            return seen
        frame = seen if isinstance(seen, Frame) else self.solver.frame(seen.time)
        return frame if first_crossing(frame.points) is None else None

    def _torn(
        self, valid: Checkpoint, last_valid: float, crossed: float
    ) -> tuple[Breakdown, float | None]:
        """Return how and when a run ends whose edge has crossed itself."""
        found = locate_crossing(self.solver, valid, last_valid, crossed)
        return found.breakdown, self._off_grid(found.last_valid)

    def _record_at(self, time: float, seen: Instant | None = None) -> Instant:
        """Return what the recorder asks for at ``time``, of which ``seen`` is known."""
        if isinstance(seen, Frame) or (seen is not None and not self.recorder.edges):
            return seen
        return self.solver.frame(time) if self.recorder.edges else self.solver.instant(time)

    def _next_targets(self, now: float, t_end: float) -> list[tuple[float, bool]]:
        """Return the next times to look at and whether they are on the grid of saved times.

        Where whole frames are recorded they end with one: it must be of the solver's last step.
        """
        targets: list[tuple[float, bool]] = []
        records, to_frame = self.records, self.recorder.edges
        jump = self.law.next_look(max(now, 0.0))
        before_end, after_end = t_end * (1.0 - _SAME_TIME), t_end * (1.0 + _SAME_TIME)
        while len(targets) < self.solver.TIMES_AT_ONCE:
            if now >= jump:
                jump = self.law.next_look(now)
            record = records * self.save_every
            check = (math.floor(now / _CHECK_EVERY + _SAME_TIME) + 1) * _CHECK_EVERY
            check = min(check, jump)
            on_grid = record <= check or same_time(record, check)
            now = record if on_grid else check
            if now > after_end:
                now, on_grid = t_end, False
            targets.append((now, on_grid))
            if now >= before_end or (on_grid and to_frame):
                break
            records += on_grid
        return targets

    def _checkpoint(self) -> Checkpoint:
        return {**self.solver.checkpoint(), KEY: self.law.checkpoint()}

    def _last_record(self) -> float:
        return (self.records - 1) * self.save_every

    def _off_grid(self, time: float) -> float | None:
        last = self._last_record()
        return None if time <= last or same_time(time, last) else time

    def _attributes(self, ended: Breakdown, reached: float) -> dict[str, Any]:
        spent = self.wall_time + clock.monotonic() - self._began
        return {
            "title": "cellcrawl run",
            "status": ended.status,
            "status_message": ended.message,
            "end_time": float(ended.time if ended.status == "completed" else reached),
            **self.identity,
            "records_on_grid": self.records,
            "diagnostics": {**self.solver.diagnostics(), "wall_time": round(spent, 3)},
        }


def check_records(t_end: float, save_every: float) -> None:
    """Raise `InputError` if a run to ``t_end`` would have more records than can be kept."""
    records = t_end / save_every
    if records > _MOST_RECORDS:
        raise InputError(
            f"save_every = {save_every:g} makes {records:.3g} records up to t_end = {t_end:g}: at "
            f"most {_MOST_RECORDS:.0e} can be kept, with save_every = {t_end / _MOST_RECORDS:g}"
        )


def same_time(a: float, b: float) -> bool:
    """Whether two times differ by rounding only."""
    return abs(a - b) <= _SAME_TIME * max(abs(a), abs(b))
