"""``python -m cellcrawl.explorer.build``: make the module that the page carries anew."""

from __future__ import annotations

from pathlib import Path

from cellcrawl.explorer.module import build
from cellcrawl.explorer.show import MODULE
from cellcrawl.explorer.sources import FILE, digest


def main() -> None:
    """Write the module beside this file."""
    made = build()
    Path(__file__).with_name(MODULE).write_bytes(made)
    Path(__file__).with_name(FILE).write_text(digest() + "\n", "utf-8")
    print(f"{MODULE}: {len(made)} bytes")


if __name__ == "__main__":
    main()
