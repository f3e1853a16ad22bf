"""The small parts of a sweep: chunk sizes, journals."""

from __future__ import annotations

import pytest

from cellcrawl.sweeps.chunking import ChunkSize
from cellcrawl.sweeps.journal import Journal, read_journal


@pytest.mark.parametrize(("runs", "cost"), [(1430, 0.1), (100_000, 0.1), (50, 60.0), (5000, 1e-4)])
def test_chunks_are_long_enough_to_be_cheap_and_short_enough_to_end_together(runs, cost):
    workers, left, seconds = 2, runs, []
    size = ChunkSize(workers)
    while left:
        count = size.next(left)
        assert 1 <= count <= left
        left -= count
        seconds.append(count * cost)
        size.learn(count, count * cost)
    overhead = 0.03 * len(seconds)
    assert overhead <= 0.05 * runs * cost or runs * cost < 2.0
    assert max(seconds) <= max(20.0 + cost, cost)
    assert seconds[-1] <= max(0.02 * runs * cost, 1.5, cost)


def test_a_journal_cut_short_loses_its_last_entry_only(tmp_path):
    path = tmp_path / "j.jsonl"
    with Journal(path) as journal:
        journal.begin("a")
        journal.finish({"key": "a", "status": "completed"})
        journal.begin("b")
        journal.finish({"key": "b", "status": "completed"})
    whole = path.read_bytes()
    for cut in range(len(whole)):
        path.write_bytes(whole[:cut])
        with Journal(path) as journal:  # another worker goes on with it
            journal.finish({"key": "c", "status": "completed"})
        found = read_journal(path)
        keys = [row["key"] for row in found.rows]
        assert keys in (["c"], ["a", "c"], ["a", "b", "c"])
        assert set(found.unfinished) <= {"a", "b"} - set(keys)


def test_runs_begun_and_not_finished_are_counted(tmp_path):
    path = tmp_path / "j.jsonl"
    for _ in range(3):
        with Journal(path) as journal:
            journal.begin("a")
    assert read_journal(path).unfinished == {"a": 3}
    assert read_journal(tmp_path / "none").rows == []
