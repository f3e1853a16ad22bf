"""Every script of the gallery runs, meets the number it asserts, and leaves its picture."""

from __future__ import annotations

import runpy
import sys
from pathlib import Path

import matplotlib as mpl
import pytest

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT / "tools"))

import gallery_page  # noqa: E402

# Short enough for every day; the others are asked for by `-m slow tests/test_gallery.py`.
QUICK = {"24_linear_theory", "06_kymograph"}
PLAN = [
    pytest.param(script, id=script.stem, marks=[] if script.stem in QUICK else pytest.mark.slow)
    for script in gallery_page.scripts()
]


@pytest.mark.filterwarnings("ignore::ResourceWarning")
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("script", PLAN)
def test_script_meets_its_number_and_leaves_its_picture(script, tmp_path, monkeypatch):
    if "distributed" in script.read_text("utf-8"):
        pytest.importorskip("distributed")
    monkeypatch.chdir(tmp_path)
    with mpl.rc_context():
        runpy.run_path(str(script), run_name="__main__")
    assert (tmp_path / f"{script.stem}.png").stat().st_size > 5_000


def test_page_is_that_of_the_scripts():
    assert gallery_page.PAGE.read_text("utf-8") == gallery_page.page()


def test_every_script_asserts_and_has_a_picture_in_the_documentation():
    assert len(gallery_page.scripts()) >= 25
    for script in gallery_page.scripts():
        assert "\nassert " in script.read_text("utf-8").replace("    assert", "assert"), script.name
        assert (gallery_page.PICTURES / f"{script.stem}.png").exists(), script.name
