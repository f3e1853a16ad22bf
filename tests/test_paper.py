"""The short paper says the numbers of the record, and cites what its bibliography holds."""

from __future__ import annotations

import json
import re
from pathlib import Path

ROOT = Path(__file__).parent.parent
PAPER = (ROOT / "paper" / "paper.md").read_text("utf-8")


def test_every_citation_is_in_the_bibliography_and_every_entry_is_cited():
    cited = set(re.findall(r"@([a-z]+\d{4})", PAPER))
    held = re.findall(r"^@\w+\{(\w+),", (ROOT / "paper" / "paper.bib").read_text("utf-8"), re.M)
    assert cited == set(held)
    assert len(held) == len(set(held))


def test_numbers_of_the_verification_are_those_of_its_record():
    record = json.loads((ROOT / "benchmarks/results/verification.json").read_text("utf-8"))
    results = record["results"]
    claims = [row for row in results if row["part"].startswith("claims")]
    fallen = [row for row in claims if row["known_not_to_hold"]]
    text = " ".join(PAPER.split())
    assert f"{len(results)} results" in text
    assert f"{len(claims)} statements of the paper" in text
    assert (len(claims) - len(fallen), len(fallen)) == (64, 10)


def test_every_part_that_a_journal_asks_for_is_there():
    for heading in ("Summary", "Statement of need", "State of the field", "References"):
        assert f"\n# {heading}\n" in PAPER
    assert len(PAPER.split()) < 1000
