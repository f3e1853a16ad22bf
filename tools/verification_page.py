"""Write docs/verification.md and docs/claims.md from the recorded verification.

cellcrawl verify --full --output DIR
cp DIR/verification.json benchmarks/results
python tools/verification_page.py
"""

from __future__ import annotations

import json
from pathlib import Path

from cellcrawl.verification import report

ROOT = Path(__file__).resolve().parent.parent


def main() -> None:
    """Write the pages."""
    record = ROOT / "benchmarks" / "results" / "verification.json"
    content = json.loads(record.read_text("utf-8"))
    (ROOT / "docs" / "verification.md").write_text(report.page(content), "utf-8")
    (ROOT / "docs" / "claims.md").write_text(report.claims_page(content), "utf-8")


if __name__ == "__main__":
    main()
