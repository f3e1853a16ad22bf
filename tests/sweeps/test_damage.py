"""A sweep's files, damaged or from another version."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

import cellcrawl as cc
from cellcrawl.sweeps.executors import InProcess
from cellcrawl.sweeps.journal import Journal, read_journal
from cellcrawl.sweeps.parts import find_part

OLD = Path(__file__).parents[1] / "old_files"
FLIPS = 40


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    made = tmp_path_factory.mktemp("sweep") / "out"
    cc.sweep({"r_on": [20, 30]}, made, InProcess(), t_end=0.1, keep="tracks", nodes=48)
    return made


def content(folder: Path) -> list[object]:
    """All that can be read of a sweep."""
    sweep = cc.open_sweep(folder)
    table = sweep.table().sort_by("r_on")
    return [table, sweep.grid.describe(), *(sweep.run(r_on=value) for value in (20, 30))]


def same(one: list, other: list) -> bool:
    return (
        one[0].equals(other[0])
        and one[1] == other[1]
        and all(a.identical(b) for a, b in zip(one[2:], other[2:], strict=True))
    )


def read_or_refused(folder: Path, whole: list) -> str | None:
    try:
        assert same(content(folder), whole)
    except cc.StorageError as error:
        return str(error)
    return None


@pytest.mark.parametrize("kind", ["rows/*.parquet", "runs/*.nc", "sweep.json"])
def test_a_flipped_bit_changes_nothing_readable_or_is_refused(folder, kind):
    files = sorted(folder.glob(kind))
    whole = content(folder)
    chance = random.Random(kind)
    refused = 0
    for _ in range(FLIPS):
        file = chance.choice(files)
        good = file.read_bytes()
        damaged = bytearray(good)
        damaged[chance.randrange(len(good))] ^= 1 << chance.randrange(8)
        file.write_bytes(damaged)
        said = read_or_refused(folder, whole)
        assert said is None or (file.name in said and "\n" not in said)
        refused += said is not None
        file.write_bytes(good)
    assert refused >= (FLIPS if kind == "rows/*.parquet" else FLIPS // 8)
    assert same(content(folder), whole)


def test_a_flipped_bit_in_a_journal_loses_its_entry_only(tmp_path):
    path = tmp_path / "chunk.jsonl"
    with Journal(path) as journal:
        for key in ("a", "b"):
            journal.begin(key)
            journal.finish({"key": key, "speed": 0.125})
    good = path.read_bytes()
    for place in range(len(good)):
        damaged = bytearray(good)
        damaged[place] ^= 1 << place % 8
        path.write_bytes(damaged)
        rows = read_journal(path).rows
        assert all(row["speed"] == 0.125 and row["key"] in ("a", "b") for row in rows)
        assert len(rows) >= 1


def test_rows_that_a_merge_puts_together_keep_a_checksum(folder, tmp_path):
    from cellcrawl.sweeps.parts import merge_parts, read_part

    parts = sorted((folder / "rows").glob("*.parquet"))
    merge_parts(tmp_path / "together.parquet", parts)
    found = find_part(tmp_path / "together.parquet")
    assert found is not None
    assert ".crc-" in found.name
    assert len(read_part(found)) == 2


def test_a_sweep_of_version_0_1_0_opens():
    sweep = cc.open_sweep(OLD / "sweep-0.1.0")
    assert sweep.table(["r_on"])["r_on"].to_pylist() == [20.0, 30.0]
    run = sweep.run(r_on=20)
    assert run.sizes["time"] == 2
    assert run.attrs["status"] == "completed"
    with pytest.raises(cc.InputError, match="made by another version"):
        cc.sweep({"r_on": [20, 30]}, OLD / "sweep-0.1.0", InProcess(), t_end=0.1)
