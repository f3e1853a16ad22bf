"""The page's modules run in node, without a browser."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from cellcrawl.explorer import bundle

needs_node = pytest.mark.skipif(shutil.which("node") is None, reason="node is not on this machine")


def run(first: str, content: dict[str, Any], code: str, given: Any, folder: Path) -> Any:
    """Return what ``code`` gives for ``given``, a function body with the module ``$first``."""
    (folder / "given.json").write_text(json.dumps(given))
    (folder / "content.json").write_text(json.dumps(content))
    text = f"""
import fs from "fs";
const content = fs.readFileSync("content.json", "utf8");
globalThis.document = {{ getElementById: () => ({{ textContent: content }}) }};
{bundle.script(first)}
const given = JSON.parse(fs.readFileSync("given.json", "utf8"));
const result = await (async () => {{ {code} }})();
fs.writeFileSync("result.json", JSON.stringify(result));
"""
    (folder / "run.mjs").write_text(text)
    done = subprocess.run(
        ["node", "run.mjs"], cwd=folder, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return json.loads((folder / "result.json").read_text())
