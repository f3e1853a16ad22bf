"""Every block of every page of the documentation runs as it stands, one after another."""

from __future__ import annotations

import importlib
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import matplotlib as mpl
import pytest

import cellcrawl as cc
from cellcrawl.command_line.main import _COMMANDS, run

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```", re.M | re.S)
QUICK = {"trackmate", "citing", "picture"}
"""Pages for every day; the others are asked for by `-m slow tests/test_pages.py`."""
LEFT = {
    "trackmate": ("modes.csv", "sheet.png", "side-by-side.png"),
    "start-modeller": ("summary.png", "growth.png", "modes.png"),
    "start-experimenter": ("modes.csv", "sheet.png", "side-by-side.png"),
    "start-teacher": ("cell.html", "slide.png", "slide.gif", "task.png"),
}
"""What a reader has in hand at the end of a page."""
ONLY_READ = {"bank", "bench", "branches", "explore", "fit", "reproduce", "sweep", "verify"}
"""Commands that take minutes, or open a browser: their options are held to what there is."""
SETTING_UP = ("python3 -m venv", "source .venv/bin/activate", "pip install")
NOT_HERE = ("dask_jobqueue", "open_bank")
"""Blocks that need a cluster, or a bank of half an hour, must be Python and no more."""


def blocks(page: Path) -> list[tuple[str, str]]:
    """Return the blocks of a page that a reader may run: their language and text."""
    found = BLOCK.findall(page.read_text("utf-8"))
    return [(kind, text) for kind, text in found if kind in ("python", "console", "toml")]


PAGES = [page for page in sorted(DOCS.glob("*.md")) if blocks(page)]
PLAN = [
    pytest.param(page, id=page.stem, marks=[] if page.stem in QUICK else pytest.mark.slow)
    for page in PAGES
]


@pytest.fixture(scope="module")
def shelf(tmp_path_factory):
    """Files that a reader brings along: a run, tracks and outlines of one film, a small grid."""
    folder = tmp_path_factory.mktemp("shelf")
    shutil.copy(ROOT / "examples" / "cells.xml", folder)
    shutil.copy(ROOT / "examples" / "cells.xml", folder / "TrackMate.xml")
    return folder


@pytest.fixture(scope="module")
def full_shelf(shelf):
    """What only the pages that are not for every day ask for."""
    cell = cc.Parameters(r_on=26, zeta_1=600)
    (shelf / "cellcrawl-run").mkdir()
    made = cc.simulate(cell, t_end=60, output=shelf / "cellcrawl-run" / "run.nc")
    film = cc.observe(made, pixel=0.1, error=0.05, frame=0.5)
    tracks = cc.read_tracks(shelf / "cells.xml")
    for name in ("cells.csv", "spots.csv", "keratocytes/one.csv", "tracks/one.csv"):
        (shelf / name).parent.mkdir(exist_ok=True)
        cc.write_tracks(shelf / name, tracks)
    track = film.tracks[0]  # as a table without units: in pixels, by frame
    rows = (f"1,{i},{x},{y}" for i, (x, y) in enumerate(zip(track.x, track.y, strict=True)))
    (shelf / "positions.csv").write_text("\n".join(["track,frame,x,y", *rows]) + "\n")
    outlines = cc.read_outlines(shelf / "cells.xml")
    film.write(shelf / "labels.tif")
    cc.write_outlines(shelf / "cells_seg.npy", [outlines[0]])
    (shelf / "phase_diagram.toml").write_text("[axes]\nr_on = [16, 26]\n[run]\nt_end = 1\n")
    cc.sweep(shelf / "phase_diagram.toml", shelf / "phase_diagram", workers=1, t_end=8)
    shutil.copy(shelf / "phase_diagram.toml", shelf / "grid.toml")
    return shelf


@pytest.fixture
def desk(request, page, tmp_path, monkeypatch):
    shelf = request.getfixturevalue("shelf" if page.stem in QUICK else "full_shelf")
    shutil.copytree(shelf, tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.filterwarnings("ignore:.*outline:UserWarning")
@pytest.mark.parametrize("page", PLAN)
def test_every_block_of_a_page_runs_and_says_what_the_page_says(page, desk, capsys):
    names: dict[str, object] = {"__name__": "__main__"}
    for kind, text in blocks(page):
        if kind == "toml":
            keep_table(text)  # a reader has it before the command that reads it
    for number, (kind, text) in enumerate(blocks(page), start=1):
        where = f"{page.name}, block {number}"
        if kind == "toml":
            continue
        if kind == "console":
            for command, said in commands(text):
                run_command(command, said, where, capsys)
        elif any(name in text for name in NOT_HERE):
            compile(text, where, "exec")
        elif named := re.match(r"# (\w+\.py)\n", text):
            (desk / named[1]).write_text(text, "utf-8")
            subprocess.run([sys.executable, named[1]], cwd=desk, check=True)
        else:
            with mpl.rc_context():
                exec(compile(text, where, "exec"), names)
    for made in LEFT.get(page.stem, ()):
        assert (desk / made).stat().st_size > 0, made


def keep_table(text: str) -> None:
    """Lay a table of TOML where the page's commands look for it."""
    tomllib.loads(text)
    is_grid = "[axes]" in text
    file = Path("grid.toml" if is_grid else "cell.toml")
    file.write_text(text, "utf-8")
    if is_grid:
        assert cc.Grid.from_toml(file).shape


def commands(text: str) -> list[tuple[str, str]]:
    """Return the commands after the prompts of a block, each with what the page says it prints."""
    found = []
    for command in re.split(r"^\$ ", text, flags=re.M)[1:]:
        line, _, said = command.partition("\n")
        found.append((line, said.strip()))
    return found


def run_command(line: str, said: str, where: str, capsys: pytest.CaptureFixture[str]) -> None:
    """Run a command of ours and compare what it says; of others only those that set up."""
    words = shlex.split(line, comments=True)
    if not words or words[0] != "cellcrawl":
        assert line.startswith(SETTING_UP), f"{where}: {line}"
        return
    if ">" in words:
        words = words[: words.index(">")]
    given = [part for word in words[1:] for part in matching(word)]
    if given[0] in ONLY_READ and not ("explore" in given and "--output" in given):
        command = getattr(
            importlib.import_module(f"cellcrawl.command_line.{_COMMANDS[given[0]][0]}"), given[0]
        )
        command.make_context(given[0], given[1:])  # refuses options that there are not
        return
    capsys.readouterr()
    assert run(given) == 0, f"{where}: {line}\n{capsys.readouterr().err}"
    if said:
        assert said in capsys.readouterr().out, where


def matching(word: str) -> list[str]:
    """Return the files that a shell would put in the place of a word."""
    here = [path.as_posix() for path in sorted(Path().glob(word))] if "*" in word else []
    return here or [word]


def test_a_page_that_makes_an_environment_enters_it_before_it_is_used():
    made = [page for page in PAGES if "-m venv" in page.read_text("utf-8")]
    assert made
    for page in made:
        shown = [text for kind, text in blocks(page) if kind == "console"]
        lines = [line for text in shown for line, _ in commands(text)]
        entered = next(n for n, line in enumerate(lines) if line.startswith("source .venv/bin"))
        used = [n for n, line in enumerate(lines) if line.startswith(("pip ", "cellcrawl "))]
        assert entered < min(used), page.name


def test_links_within_the_documentation_lead_somewhere():
    """Files and headings that pages link to; the builder checks the rest."""
    link = re.compile(r"\]\((?!https?:|#|mailto:)([^)#\s]+)(?:#([\w-]+))?\)")
    for page in [*DOCS.glob("*.md"), *ROOT.glob("*.md")]:
        for target, anchor in link.findall(
            re.sub(r"```.*?```", "", page.read_text("utf-8"), flags=re.S)
        ):
            path = (page.parent / target).resolve()
            assert path.exists(), f"{page.name}: {target}"
            if anchor and path.suffix == ".md":
                assert anchor in anchors(path), f"{page.name}: {target}#{anchor}"


def anchors(page: Path) -> set[str]:
    """Return the anchors of a page's headings and of those of pages that it includes."""
    text = page.read_text("utf-8")
    for other in re.findall(r"^```\{include\} (\S+)$", text, re.M):
        text += (page.parent / other).read_text("utf-8")
    heads = re.findall(r"^#{1,4} (.+)$", text, re.M)
    plain = [re.sub(r"[^\w\- ]", "", head.lower()) for head in heads]
    return {head.strip().replace(" ", "-") for head in plain}
