"""How a sweep shows where it is."""

from __future__ import annotations

from collections.abc import Mapping
from types import TracebackType
from typing import Any, Self

from cellcrawl.data import MODEL_ENDINGS


class RunsBar:
    """A bar of runs with the time left and how many failed; nothing unless ``show``."""

    def __init__(self, show: bool, runs: int, left: int) -> None:
        self._show = show
        self._runs = runs
        self._left = left
        self._failed = 0
        self._bar: Any = None

    def __enter__(self) -> Self:
        if self._show:
            from tqdm.auto import tqdm

            self._bar = tqdm(
                total=self._runs,
                initial=self._runs - self._left,
                unit="run",
                bar_format="{n} of {total} runs |{bar}| {remaining} left{postfix}",
            )
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._bar is not None:
            self._bar.close()

    def update(self, runs: int, outcomes: Mapping[str, int]) -> None:
        """Count runs that are done, with how many ended with each status."""
        self._failed += sum(n for status, n in outcomes.items() if status not in MODEL_ENDINGS)
        if self._bar is not None:
            if self._failed:
                self._bar.set_postfix_str(f"{self._failed} failed", refresh=False)
            self._bar.update(runs)
