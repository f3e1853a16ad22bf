"""Every picture of the repository has a step of tools/remake_pictures.py that makes it."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "tools"))

from remake_pictures import STEPS, made_by, pictures


def test_every_picture_is_made_by_one_step():
    made = [path for step in STEPS for path in made_by(step)]
    assert len(made) == len(set(made))
    assert set(made) == pictures()
