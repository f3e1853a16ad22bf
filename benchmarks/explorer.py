"""Measure the live cell in Chromium: first picture, frames, speed, size, memory; and in node.

``python benchmarks/explorer.py`` writes ``benchmarks/results/explorer.json``; it takes two minutes
on a quiet machine. Memory is looked at while the page computes, at full speed, as much as it shows
in an hour. ``python tools/explorer_page.py`` puts the figures into the page on the live cell.
"""

from __future__ import annotations

import gzip
import json
import os
import platform
import shutil
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT))

from tests.explorer import node  # noqa: E402
from tests.explorer.browser import Browser, chromium  # noqa: E402

import cellcrawl as cc  # noqa: E402
from cellcrawl.explorer.content import content  # noqa: E402
from cellcrawl.explorer.show import shipped_module  # noqa: E402

HOUR = 5.0 * 3600.0  # time units that the page shows in an hour
LOOKS = 12
LAWS = {
    "stiffness": "#v=2&seed=2&law=stiffness&laws.chi=0.8",
    "catch-slip": "#v=2&seed=2&law=catch-slip&laws.catch=5",
    "load": "#v=2&seed=2&law=load&laws.stall=3000",
    "swept-myosin": "#v=2&seed=2&law=swept-myosin&laws.sweep=0.2",
}
LINK = "#v=1&r_on=26&zeta_1=600&seed=2"
FRAMES = """new Promise((done) => {
  const gaps = []; let before = 0; const began = performance.now(), t = page.run.now;
  const step = (now) => {
    if (before) gaps.push(now - before);
    before = now;
    if (now - began < 10000) return requestAnimationFrame(step);
    const worst = Math.max(...gaps), rate = 1000 * gaps.length / gaps.reduce((a, b) => a + b);
    const late = gaps.filter((gap) => gap > 50).length;
    const simulated = (page.run.now - t) / (now - began) * 1000;
    done({
      frames_per_second: rate, worst_frame_ms: worst, frames_above_50_ms: late,
      simulated_per_second: simulated,
    });
  };
  requestAnimationFrame(step);
})"""
SPEED = """(() => {
  page.run.cell.begin(page.run.setup.parameters, 2);
  const began = performance.now();
  page.run.cell.advance(100);
  return 100000 / (performance.now() - began);
})()"""


IN_NODE = """
const module = new WebAssembly.Module(fs.readFileSync(given.module));
const {setup} = $link.read(given.link);
const {cell} = new $run.Run(module, setup);
return [0, 1, 2, 3].map(() => {
  cell.begin(setup.parameters, 2);
  const began = performance.now();
  cell.advance(100);
  return 100000 / (performance.now() - began);
});
"""


def measure() -> dict[str, Any]:
    """Return all numbers."""
    page = cc.explore(view="full").save(Path(tempfile.mkdtemp()) / "cell.html")
    found: dict[str, Any] = {
        "machine": platform.machine(),
        "cores": os.cpu_count(),
        "load": os.getloadavg()[0],
        "page_bytes": page.stat().st_size,
        "page_bytes_compressed": len(gzip.compress(page.read_bytes(), 9)),
    }
    cold = []
    for _ in range(3):
        with Browser() as browser:
            browser.open(page.as_uri() + LINK)
            browser.wait("window.page && page.frames > 1")
            cold.append(browser.value("page.firstPicture"))
    found["first_picture_ms"] = cold
    with Browser() as browser:
        browser.open(page.as_uri() + LINK)
        browser.wait("window.page && page.run.now > 10")
        found["crawling"] = browser.value(FRAMES)
        found["time_units_per_second"] = _speeds(browser, LINK)
        found["version"] = browser.send("Browser.getVersion")["product"]
        found["time_units_per_second_under_laws"] = {
            law: _speeds(browser, link) for law, link in LAWS.items()
        }
        found["memory"] = _memory(browser)
        found["errors"] = browser.errors
    found["time_units_per_second_in_node"] = _in_node()
    return found


def _in_node() -> list[float] | None:
    """Return time units a second without a browser, None where node is not on the machine."""
    if shutil.which("node") is None:
        return None
    with tempfile.TemporaryDirectory() as folder:
        module = Path(folder) / "module.wasm"
        module.write_bytes(shipped_module())
        given = {"module": str(module), "link": LINK.removeprefix("#")}
        return node.run("link", content(), IN_NODE, given, Path(folder))


def _speeds(browser: Browser, link: str) -> list[float]:
    """Return time units a second, from the round cell to t = 100, a few times."""
    browser.value(f"page.open({link!r}), page.playing = false")
    return [browser.value(SPEED) for _ in range(4)]


def _memory(browser: Browser) -> dict[str, Any]:
    """Let a cell run at full speed and look at the memory of the page now and then."""
    browser.value(f"page.open({LINK!r}), page.view.speed = 1000, 0")
    sizes = []
    began = time.monotonic()
    for look in range(LOOKS + 1):
        browser.wait(f"page.run.now >= {look * HOUR / LOOKS}", limit=300.0)
        browser.send("HeapProfiler.collectGarbage")
        heap = browser.send("Runtime.getHeapUsage")
        sizes.append([round(heap[name] / 2**20, 2) for name in ("usedSize", "backingStorageSize")])
    return {
        "simulated": browser.value("page.run.now"),
        "seconds": time.monotonic() - began,
        "heap_and_arrays_MiB": sizes,
    }


def main() -> None:
    """Measure and keep."""
    if chromium() is None:
        sys.exit("chromium is not on this machine")
    found = measure()
    text = json.dumps(found, indent=1)
    (ROOT / "benchmarks" / "results" / "explorer.json").write_text(text + "\n", "utf-8")
    print(text)


if __name__ == "__main__":
    main()
