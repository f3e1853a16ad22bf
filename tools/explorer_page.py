"""Put the figures of ``benchmarks/results/explorer.json`` into docs/explore.md, between its marks.

``python tools/explorer_page.py``
"""

from __future__ import annotations

from typing import Any

from performance_page import ROOT, load, table

PAGE = ROOT / "docs" / "explore.md"
BEGIN, END = "<!-- measured: begin -->", "<!-- measured: end -->"


def figures(found: dict[str, Any]) -> str:
    """Return a table of what is asked and what was measured."""
    crawling, memory = found["crawling"], found["memory"]
    heap, arrays = zip(*memory["heap_and_arrays_MiB"], strict=True)
    under = ", ".join(
        f"{min(speeds):.0f} under `{law}`"
        for law, speeds in found["time_units_per_second_under_laws"].items()
    )
    rows = [
        ("first picture after opening, cold", "1 s", _range(found["first_picture_ms"], "ms")),
        (
            "frames a second at 5 time units a second",
            "50, worst 50 ms",
            f"{crawling['frames_per_second']:.0f}, worst {crawling['worst_frame_ms']:.0f} ms",
        ),
        (
            "time units a second, (26, 600)",
            "150",
            f"{_range(found['time_units_per_second'])}; the slowest of four: {under}",
        ),
    ]
    if found.get("time_units_per_second_in_node"):
        rows.append(("the same in node", "300", _range(found["time_units_per_second_in_node"])))
    rows += [
        (
            "memory at full speed",
            "held",
            f"heap {min(heap):.1f} to {max(heap):.1f} MiB, arrays {min(arrays):.1f} to "
            f"{max(arrays):.1f} MiB all through {memory['simulated']:.0f} time units, an hour's "
            f"at 5 a second, in {memory['seconds']:.0f} s",
        ),
        ("whole page, compressed", "300 KB", f"{found['page_bytes_compressed'] / 1e3:.0f} KB"),
    ]
    lines = [
        f"{found['version'].replace('Chrome/', 'Chromium ').split('.')[0]}, {found['cores']} "
        f"cores, load {found['load']:.1f} (`benchmarks/explorer.py`):",
        "",
        table(["what", "asked", "measured"], [list(row) for row in rows]).rstrip(),
    ]
    return "\n".join(lines)


def _range(values: list[float], unit: str = "") -> str:
    return f"{min(values):.0f} to {max(values):.0f} {unit}".rstrip()


def main() -> None:
    """Write them."""
    text = PAGE.read_text("utf-8")
    before, rest = text.split(BEGIN)
    _, after = rest.split(END)
    made = figures(load("explorer"))
    PAGE.write_text(f"{before}{BEGIN}\n\n{made}\n\n{END}{after}", "utf-8")


if __name__ == "__main__":
    main()
