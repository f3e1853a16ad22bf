"""Advice fits the error."""

from __future__ import annotations

import errno

import pytest

import cellcrawl as cc
from cellcrawl.errors import nearest_name, what_would_help


@pytest.mark.parametrize(
    ("error", "reason", "advice"),
    [
        (OSError(errno.ENOSPC, "full"), "", "once there is room"),
        (OSError("HDF5's own words"), "No space left on device", "once there is room"),
        (PermissionError(errno.EACCES, "denied"), "Permission denied", "once it can be written"),
        (OSError(errno.EROFS, "read-only"), "", "once it can be written"),
    ],
)
def test_only_a_full_disk_waits_for_room(error, reason, advice):
    assert what_would_help(error, reason) == advice


def test_names_are_guessed_or_listed_once():
    assert nearest_name("zeta1", ["zeta_1", "D"]) == "did you mean 'zeta_1'?"
    assert nearest_name("d", ["zeta_1", "D"]) == "did you mean 'D'?"
    assert nearest_name("qqq", ["zeta_1", "D"]) == "known names: D, zeta_1"
    assert nearest_name(["D"], ["zeta_1", "D"]) == "known names: D, zeta_1"


@pytest.mark.parametrize("door", [cc.open_run, cc.open_sweep, cc.read_tracks, cc.read_outlines])
def test_a_message_is_one_line_whatever_a_file_is_called(door):
    with pytest.raises(cc.CellcrawlError, match=r"a\\nb") as error:
        door("a\nb\r")
    assert len(str(error.value).splitlines()) == 1


def test_a_long_list_of_names_is_cut():
    told = nearest_name("?", [f"name{i:03}" for i in range(200)])
    assert len(told) < 450
    assert told.startswith("known names: name000, name001")
    assert int(told.split()[-2]) + told.count("name") - 1 == 200
