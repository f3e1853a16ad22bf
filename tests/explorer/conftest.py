from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import cellcrawl as cc
from tests.explorer.browser import Browser, chromium


@pytest.fixture(scope="session")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page as `cellcrawl explore` writes it."""
    return cc.explore(view="full").save(tmp_path_factory.mktemp("page") / "cell.html")


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    if chromium() is None:
        pytest.skip("chromium is not on this machine")
    with Browser() as made:
        made.send(
            "Network.emulateNetworkConditions",
            offline=True,
            latency=0,
            downloadThroughput=0,
            uploadThroughput=0,
        )
        yield made
