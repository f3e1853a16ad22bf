"""Starting where no compiled kernel can be kept."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import cellcrawl
from cellcrawl.numerics import kernels

PACKAGE = Path(cellcrawl.__file__).parent


@pytest.fixture
def environment(tmp_path):
    """A copy of the package and a home in which nothing can be written, not even by root."""
    copy = tmp_path / "site" / "cellcrawl"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    for folder in [copy, *(path for path in copy.rglob("*") if path.is_dir())]:
        (folder / "__pycache__").write_text("a file where the folder would be")
    nowhere = tmp_path / "home"
    nowhere.write_text("a file")
    kept = {n: v for n, v in os.environ.items() if n not in ("NUMBA_CACHE_DIR", "PYTHONPATH")}
    return kept | {
        "HOME": str(nowhere),
        "XDG_CACHE_HOME": str(nowhere / "cache"),
        "LOCALAPPDATA": str(nowhere / "cache"),
        "PYTHONPATH": str(copy.parent),
        "TMPDIR": str(tmp_path),
    }


def start(environment):
    """Import the package and define a kernel; return what was said on stderr."""
    code = (
        "import cellcrawl, cellcrawl.laws.force_balance as physics; "
        f"assert {str(PACKAGE)!r} not in cellcrawl.__file__; "
        "from cellcrawl.one_dimensional import front_speed"
    )
    done = subprocess.run(
        [sys.executable, "-B", "-c", code], env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return done.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="TMPDIR and HOME are POSIX's")
def test_without_a_cache_it_starts_and_says_so_once(environment, tmp_path):
    told = start(environment)
    assert told.count("no folder for compiled kernels can be written") == 1
    (folder,) = tmp_path.glob("cellcrawl-kernels-*")
    assert str(folder) in told
    assert folder.stat().st_mode & 0o077 == 0


@pytest.mark.skipif(sys.platform == "win32", reason="permissions are POSIX's")
def test_a_temporary_folder_of_another_is_not_trusted(environment, tmp_path, monkeypatch):
    monkeypatch.setattr(kernels.tempfile, "gettempdir", lambda: str(tmp_path))
    folder = kernels._temporary_folder()
    folder.chmod(0o777)  # what anybody could write would be run
    assert kernels._temporary_folder() is None
    assert "every start compiles anew" in start(environment)


def test_with_a_cache_nothing_is_said(recwarn):
    assert kernels._keeps_kernels()
    assert not recwarn.list
