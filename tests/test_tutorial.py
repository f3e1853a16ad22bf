"""The tutorial runs as it stands, from its file to its pictures."""

from __future__ import annotations

import re
import shlex
import shutil
from pathlib import Path

from cellcrawl.command_line.main import run

ROOT = Path(__file__).resolve().parents[1]
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```", re.M | re.S)


def test_every_block_of_the_tutorial_runs_and_says_what_the_page_says(
    tmp_path, monkeypatch, capsys
):
    shutil.copy(ROOT / "examples" / "cells.xml", tmp_path)
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    blocks = BLOCK.findall((ROOT / "docs" / "trackmate.md").read_text("utf-8"))
    assert {kind for kind, _ in blocks} == {"console", "python"}
    for kind, text in blocks:
        if kind == "python":
            exec(compile(text, "trackmate.md", "exec"), names)
            continue
        commands = re.split(r"^\$ ", text, flags=re.M)[1:]
        for command in commands:
            line, _, said = command.partition("\n")
            program, *words = shlex.split(line)
            assert program == "cellcrawl"
            capsys.readouterr()
            assert run(words) == 0
            if said.strip():
                assert said.strip() in capsys.readouterr().out
    for made in ("modes.csv", "sheet.png", "side-by-side.png"):
        assert (tmp_path / made).stat().st_size > 0
