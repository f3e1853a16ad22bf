"""How a running simulation shows where it is."""

from __future__ import annotations

from types import TracebackType
from typing import Any, Protocol, Self


class Progress(Protocol):
    """Told of each saved time; a context that cleans up after itself."""

    def __enter__(self) -> Self: ...

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None: ...

    def update(self, time: float, tension: float) -> None:
        """Show that ``time`` is reached with this tension."""
        ...


class Silent:
    """Shows nothing."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        return

    def update(self, time: float, tension: float) -> None:
        return


class Bar:
    """A bar with time reached, time left and tension, on a terminal or in a notebook."""

    def __init__(self, start: float, end: float) -> None:
        self._range = (start, end)
        self._bar: Any = None

    def __enter__(self) -> Self:
        from tqdm.auto import tqdm

        start, end = self._range
        self._bar = tqdm(
            total=end,
            initial=start,
            unit="",
            bar_format="t = {n:.1f} of {total:g} |{bar}| {remaining} left{postfix}",
        )
        return self

    def __exit__(self, *_: object) -> None:
        self._bar.close()

    def update(self, time: float, tension: float) -> None:
        self._bar.set_postfix_str(f"tension {tension:.0f}", refresh=False)
        self._bar.update(time - self._bar.n)


def make_progress(show: bool, start: float, end: float) -> Progress:
    """Return a bar from ``start`` to ``end``, or nothing visible."""
    return Bar(start, end) if show else Silent()
