"""Take the pictures of the live cell's page at three widths, in Chromium."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from tests.explorer.browser import Browser  # noqa: E402

import cellcrawl as cc  # noqa: E402

FOLDER = ROOT / "docs" / "images" / "explore"
SIZES = {"wide": (1400, 900), "tablet": (820, 1100), "phone": (390, 844)}
LINK = "#v=1&r_on=26&zeta_1=600&seed=2&paused=true&to=62"


def main() -> None:
    """Write one picture for each size."""
    page = cc.explore(view="full").save(Path(tempfile.mkdtemp()) / "cell.html")
    FOLDER.mkdir(exist_ok=True)
    for name, (width, height) in SIZES.items():
        with Browser(width, height) as browser:
            browser.open(page.as_uri() + LINK)
            browser.wait("window.page && page.run.now >= 62", 60.0)
            browser.value("page.fresh = true, page.tell(page.place), 0")
            browser.wait("page.frames > 20")
            browser.picture(FOLDER / f"{name}.png")


if __name__ == "__main__":
    main()
