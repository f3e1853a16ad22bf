"""What the command line says when something is wrong: one line, the right code, nothing whole."""

from __future__ import annotations

import signal
import subprocess
import sys
import time

import pytest

import cellcrawl as cc
from cellcrawl.command_line.bench import _times
from cellcrawl.command_line.main import _COMMANDS, run
from tests.command_line.test_classify import write
from tests.tracks import circle_track


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("run") / "run.nc"
    cc.simulate(t_end=0.2, nodes=32, output=path)
    return str(path)


@pytest.fixture
def nowhere(tmp_path):
    """A path below a file: nothing can be written there, not even by root."""
    blocking = tmp_path / "file"
    blocking.write_text("a file where a folder would be")
    return blocking / "below"


@pytest.mark.parametrize(
    "command",
    [
        ["simulate", "--t-end", "0.1", "--output", "{nowhere}"],
        ["plot", "{file}", "--output", "{nowhere}/cell.png"],
        ["movie", "{file}", "--output", "{nowhere}/cell.mp4"],
        ["dispersion", "--output", "{nowhere}/rates.pdf"],
        ["stability", "--data", "{nowhere}/map.nc"],
        ["verify", "--only", "growth", "--output", "{nowhere}"],
        ["bench", "--quick", "--output", "{nowhere}"],
        ["classify", "{track}", "--output", "{nowhere}/table.csv"],
    ],
    ids=lambda command: command[0],
)
def test_what_cannot_be_written_is_a_failure_and_no_mistake(
    command, file, nowhere, tmp_path, capsys
):
    track = write(tmp_path / "track.csv", circle_track())
    names = {"file": file, "nowhere": nowhere, "track": track}
    assert run([word.format(**names) for word in command]) == 3
    told = capsys.readouterr().err
    assert told.startswith("cellcrawl: ")
    assert len(told.splitlines()) == 1


@pytest.mark.parametrize(
    "command",
    [
        ["plot", "{file}", "--output", "cell.xlsx"],
        ["dispersion", "--output", "rates"],
        ["classify", "{track}", "--output", "modes.xlsx"],
        ["plot", "{file}", "--kind", "x" * 5000],
        ["x" * 5000],
        ["info", "x" * 5000 + ".nc"],
        ["dispersion", "--vary", "x" * 5000],
        ["simulate", "--solver", "x" * 5000],
        ["simulate", "--output", "x" * 5000],
        ["simulate", "--save-every", "1e-8"],
    ],
)
def test_a_mistake_is_answered_in_a_short_line(command, file, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    track = write(tmp_path / "track.csv", circle_track())
    assert run([word.format(file=file, track=track) for word in command]) == 2
    told = capsys.readouterr().err
    assert len(told.splitlines()) == 1
    assert len(told) < 400
    assert [path.name for path in tmp_path.iterdir()] == ["track.csv"]


def test_choices_are_listed_once(file, capsys):
    run(["plot", file, "--kind", "sideways"])
    assert capsys.readouterr().err.count("kymographs") == 1


@pytest.mark.parametrize("command", _COMMANDS)
def test_help_shows_its_examples_line_by_line(command, capsys):
    run([command, "--help"])
    told = capsys.readouterr().out
    assert "\\b" not in told
    lines = [line for line in told.splitlines() if line.startswith("    cellcrawl ")]
    assert all(line.count(f"cellcrawl {command}") <= 1 for line in lines)


def test_speeds_that_were_not_reached_are_no_numbers():
    assert _times(float("nan")) == "not reached"
    assert _times(2.04) == "2.0x"


@pytest.mark.skipif(sys.platform == "win32", reason="sends POSIX's SIGINT")
def test_ctrl_c_while_starting_ends_in_one_line():
    script = (
        "import signal, sys; import cellcrawl.start\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"  # ignored in the background
        "print('ready', flush=True)\n"
        "sys.argv = ['cellcrawl', 'verify', '--full']; cellcrawl.start.main()"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    process.stdout.readline()
    time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    _, told = process.communicate(timeout=60)
    assert process.returncode == 130
    assert told.lstrip() == "cellcrawl: stopped\n"  # click ends the line of ^C where it started


def test_a_wait_for_the_compiler_is_told_once(capsys, monkeypatch):
    import numba

    from cellcrawl.command_line import compiling

    compiling.announce_compilation.__wrapped__()
    monkeypatch.setattr(compiling, "_PATIENCE", -1.0)  # from the first moment on
    numba.njit(lambda x: x)(1)
    assert "compiling the solver for this machine" in capsys.readouterr().err
    numba.njit(lambda x: x + 1)(1)
    assert "compiling" not in capsys.readouterr().err


def test_what_is_compiled_beside_is_what_a_run_calls():
    from cellcrawl.solvers.adaptive import ahead

    cc.simulate(cc.Parameters(r_on=26, zeta_1=600), t_end=0.2)
    assert ahead.FOLLOW in ahead.follow.signatures
    assert ahead.FILL_FRAME in ahead.fill_frame.signatures
    assert not ahead.nothing_kept()


def test_a_run_waits_for_what_is_compiled_beside_and_does_without_it_if_it_dies(monkeypatch):
    from cellcrawl.solvers.adaptive import ahead

    for code in ("import time; time.sleep(0.5)", "raise SystemExit(1)"):
        process = subprocess.Popen([sys.executable, "-c", code])
        monkeypatch.setattr(ahead, "_beside", process)
        assert cc.simulate(t_end=0.05).attrs["status"] == "completed"
        assert process.poll() is not None
