"""What a verification found, as a table, as JSON and as a page of the documentation."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from cellcrawl.bench import machine
from cellcrawl.errors import StorageError
from cellcrawl.verification.check import AS_DOCUMENTED, FAILS, HOLDS, Outcome, Result
from cellcrawl.verification.registry import PARTS

CLAIMS: Final = "claims"
"""Parts whose names begin so are about the paper, and told with where each claim stands."""

_HEAD = """# Verification

This page is written by `cellcrawl verify --full`, which anyone can rerun; `cellcrawl verify` takes
a few minutes on two cores. It measures geometry, invariants, orders of accuracy, growth rates
against linear theory, agreement between solvers that share no geometry, and restarts. Then it goes
through the paper (Chen, Saintillan & Rangamani 2023) claim by claim. A claim that does not hold is
told with the reason; should it hold one day, the verification fails, for then what is said here is
wrong.

"""


_CLAIMS_HEAD: Final = """# The paper's claims

Each statement of the paper (Chen, Saintillan & Rangamani 2023) that can be computed, measured anew
by `cellcrawl verify --full`: {all} in all, of which {no} do not hold as written. Those come first,
with the reason. How each was measured: [verification](verification.md).

"""


def record(
    outcomes: Sequence[Outcome], *, full: bool, complete: bool, seconds: float
) -> dict[str, Any]:
    """Return a verification as plain values: how it ended, the machine, and every result."""
    rows = [
        {"part": outcome.part, "check": outcome.check, **result.to_dict()}
        for outcome in outcomes
        for result in outcome.results
    ]
    passed = complete and all(row["passed"] for row in rows)
    return {
        "status": "interrupted" if not complete else "passed" if passed else "failed",
        "full": full,
        "seconds": round(seconds, 1),
        "machine": machine.record(),
        "counts": {
            verdict: sum(row["verdict"] == verdict for row in rows)
            for verdict in (HOLDS, AS_DOCUMENTED, FAILS)
        },
        "check_seconds": {outcome.check: round(outcome.seconds, 1) for outcome in outcomes},
        "results": rows,
    }


def lines(outcome: Outcome) -> list[str]:
    """Return the rows of one check for the terminal."""
    shown = [f"{outcome.part}: {outcome.check} ({outcome.seconds:.1f} s)"]
    for result in outcome.results:
        shown.append(f"  {_mark(result)}  {result.what}")
        shown.append(f"         expected {result.expected}; measured {result.measured}")
        if result.known_not_to_hold:
            shown.append(f"         {result.known_not_to_hold}")
    return shown


def summary(content: dict[str, Any]) -> str:
    """Return the verdict of a whole verification in one line."""
    counts = content["counts"]
    told = f"{counts[HOLDS]} hold, {counts[AS_DOCUMENTED]} do not hold as documented"
    return f"{content['status']}: {told}, {counts[FAILS]} fail; {content['seconds']:.0f} s"


def page(content: dict[str, Any]) -> str:
    """Return the page of the documentation for a verification's record."""
    text = [_HEAD, f"**{_sentence(summary(content))}** ", _machine(content), "\n\n"]
    text += ["## In short\n\n", _overview(content), "\n"]
    for part, title in PARTS.items():
        rows = [row for row in content["results"] if row["part"] == part]
        if rows:
            text += [f"## {title}\n\n", _claims(rows) if part.startswith(CLAIMS) else _table(rows)]
            text.append("\n")
    return "".join(text).rstrip() + "\n"


def claims_page(content: dict[str, Any]) -> str:
    """Return the page of the documentation on the paper's claims: what does not hold, then all."""
    rows = [row for row in content["results"] if row["part"].startswith(CLAIMS)]
    fallen = [row for row in rows if row["known_not_to_hold"]]
    body = [
        [f"{row['what']} (*{row['where']}*)", _with_note(row), row["known_not_to_hold"]]
        for row in fallen
    ]
    text = [_CLAIMS_HEAD.format(all=len(rows), no=len(fallen))]
    text += [f"## The {len(fallen)} that do not hold as written\n\n"]
    text += [_markdown(["claim", "measured", "why"], body), "\n"]
    text += ["## All claims\n\n"]
    every = [[row["what"], row["where"], "no" if row in fallen else "holds"] for row in rows]
    text += [_markdown(["claim", "where in the paper", "verdict"], every)]
    return "".join(text).rstrip() + "\n"


def write(folder: Path, content: dict[str, Any]) -> None:
    """Write ``verification.json`` and ``verification.md``, each whole or not at all.

    Raises
    ------
    StorageError
        If they cannot be written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        replace_text(folder / "verification.json", json_text(content))
        replace_text(folder / "verification.md", page(content))
    except OSError as error:
        raise StorageError(f"cannot write to {folder}: {error.strerror or error}") from None


def json_text(content: dict[str, Any]) -> str:
    """Return the record as JSON, with null for what is not finite."""
    return json.dumps(machine.without_nan(content), indent=1, allow_nan=False) + "\n"


def replace_text(path: Path, text: str) -> None:
    """Write a file under another name and move it into place."""
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        temporary.write_text(text, "utf-8")
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def _mark(result: Result) -> str:
    if not result.passed:
        return "FAILS"
    return "ok   " if result.holds else "no   "


def _sentence(text: str) -> str:
    return text[0].upper() + text[1:] + "."


def _machine(content: dict[str, Any]) -> str:
    version = "Long version" if content["full"] else "Short version"
    return f"{version}; {machine.describe(content['machine'])}."


def _overview(content: dict[str, Any]) -> str:
    """Return a table with a line for each part: how much of it holds."""
    body = []
    for part, title in PARTS.items():
        verdicts = [row["verdict"] for row in content["results"] if row["part"] == part]
        if verdicts:
            counts = [str(verdicts.count(one)) for one in (HOLDS, AS_DOCUMENTED, FAILS)]
            body.append([title, *counts])
    return _markdown(["part", "hold", "do not hold as documented", "fail"], body)


def _table(rows: list[dict[str, Any]]) -> str:
    body = [[row["what"], row["expected"], _with_note(row), _verdict(row)] for row in rows]
    return _markdown(["what", "expected", "measured", "verdict"], body)


def _claims(rows: list[dict[str, Any]]) -> str:
    body = [
        [row["what"], row["where"], row["expected"], _with_note(row), _verdict(row)] for row in rows
    ]
    return _markdown(["claim", "where", "our check", "measured", "verdict"], body)


def _with_note(row: dict[str, Any]) -> str:
    return f"{row['measured']} ({row['note']})" if row["note"] else str(row["measured"])


def _verdict(row: dict[str, Any]) -> str:
    if row["verdict"] == FAILS:
        return "**fails**"
    return f"**no**: {row['known_not_to_hold']}" if row["known_not_to_hold"] else "holds"


def _markdown(names: list[str], rows: list[list[str]]) -> str:
    escaped = [[cell.replace("|", "\\|") for cell in line] for line in (names, *rows)]
    table = [escaped[0], ["---"] * len(names), *escaped[1:]]
    return "\n".join("| " + " | ".join(line) + " |" for line in table) + "\n"
