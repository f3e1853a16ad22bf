"""Look at the built site as a desk and a phone show it: what is too wide, dark mode, the search.

    sphinx-build -q -W docs docs/_build/html
    python tools/look_at_site.py docs/_build/html [FOLDER for pictures]

Ends with 1 and a line for each fault: a page wider than the screen, a picture or frame that sticks
out, a table or code block that cannot be scrolled, dark pages with a light ground, words that the
search does not find.
"""

from __future__ import annotations

import sys
import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from tests.explorer.browser import Browser  # noqa: E402

SIZES = {"desk": (1400, 900), "phone": (390, 844)}
WORDS = {
    "TrackMate": "trackmate.html",
    "catch bond": "laws.html",
    "area": "faq.html",
    "MSD": "measuring.html",
    "cite": "citing.html",
}
TOO_WIDE = """(() => {
  const wide = window.innerWidth, found = [];
  if (document.documentElement.scrollWidth > wide + 1)
    found.push('the page is ' + document.documentElement.scrollWidth + ' wide');
  for (const one of document.querySelectorAll('article img, article iframe, article video'))
    if (one.getBoundingClientRect().right > wide + 1) found.push('picture ' + (one.src || ''));
  for (const one of document.querySelectorAll('article table, article pre')) {
    if (one.getBoundingClientRect().right <= wide + 1) continue;
    let box = one, scrolls = false;
    for (; box && box.tagName !== 'ARTICLE'; box = box.parentElement)
      if (['auto', 'scroll'].includes(getComputedStyle(box).overflowX)) scrolls = true;
    if (!scrolls) found.push(one.tagName.toLowerCase() + ' ' + one.innerText.slice(0, 40));
  }
  return found;
})()"""
DARK = """(() => {
  document.body.dataset.theme = 'dark';
  const light = colour => Math.max(...(colour.match(/[0-9.]+/g) || [255]).slice(0, 3));
  const found = [];
  if (light(getComputedStyle(document.body).backgroundColor) > 60) found.push('light ground');
  for (const one of document.querySelectorAll('article img, article iframe, article video'))
    if (getComputedStyle(one).filter === 'none') found.push('glaring ' + one.src);
  return found;
})()"""


class Quiet(SimpleHTTPRequestHandler):
    """Serves files and says nothing."""

    def log_message(self, format: str, *given: Any) -> None:
        """Keep still."""


def faults_of(browser: Browser, address: str, name: str, pictures: Path | None) -> list[str]:
    """Return what is wrong with one page at either size."""
    found = []
    for size, (width, height) in SIZES.items():
        browser.size(width, height)
        browser.open(address + name)
        found += [f"{name} on a {size}: {fault}" for fault in browser.value(TOO_WIDE)]
        if pictures:
            browser.picture(pictures / f"{Path(name).stem}-{size}.png")
    found += [f"{name} in the dark: {fault}" for fault in browser.value(DARK)]
    if pictures:
        browser.picture(pictures / f"{Path(name).stem}-dark.png")
    return found


def not_found(browser: Browser, address: str) -> list[str]:
    """Return a line for each word whose page does not come first in the search."""
    found = []
    for word, page in WORDS.items():
        browser.open(f"{address}search.html?q={word.replace(' ', '+')}")
        try:
            browser.wait("document.querySelectorAll('ul.search li a').length > 0", 20.0)
            first = browser.value("document.querySelector('ul.search li a').href")
        except Exception:  # whatever the browser says, the word was not found
            first = "nothing"
        if f"/{page}" not in first:
            found.append(f"the search for {word!r} leads to {first} and not to {page}")
    return found


def main() -> int:
    """Look at every page; return the exit code."""
    site = Path(sys.argv[1])
    pictures = Path(sys.argv[2]) if len(sys.argv) > 2 else None
    if pictures:
        pictures.mkdir(parents=True, exist_ok=True)
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(site)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    address = f"http://127.0.0.1:{server.server_address[1]}/"
    faults: list[str] = []
    with Browser(1400, 900) as browser:
        for page in sorted(site.glob("*.html")):
            if page.stem not in ("cell", "search", "genindex", "py-modindex"):
                faults += faults_of(browser, address, page.name, pictures)
        faults += not_found(browser, address)
    server.shutdown()
    print("\n".join(faults) or "nothing is too wide, dark is dark, and the search finds its words")
    return bool(faults)


if __name__ == "__main__":
    raise SystemExit(main())
