from __future__ import annotations

import gzip

import pytest

import cellcrawl as cc
from cellcrawl.command_line.main import run as command
from cellcrawl.explorer import cards, links, presets
from cellcrawl.explorer.content import content
from tests.explorer import node
from tests.explorer.browser import Browser, chromium


def test_the_whole_page_is_small(page):
    assert len(gzip.compress(page.read_bytes(), 9)) < 300_000


def test_the_page_asks_the_network_for_nothing(page):
    text = page.read_text("utf-8")
    assert "fetch(" not in text
    assert "<script src" not in text
    assert "<link" not in text


def test_a_link_read_and_written_is_the_same_cell():
    p = cc.Parameters(r_on=30.5, zeta_1=570, D=0.1, elasticity="consistent")
    found = links.read("#" + links.write(p, 7))
    assert (found.parameters, found.seed, found.schedule) == (p, 7, None)
    soft = links.read(links.write(p, 7, cc.laws.Stiffness(chi=0.6)))
    assert (soft.parameters, soft.laws) == (p, cc.laws.Stiffness(chi=0.6))


def test_a_link_holds_ramps_and_the_times_of_discs():
    found = links.read(
        "v=2&r_on=20&law=stiffness&laws.chi=0.8&changes=1~3,r_on:26,laws.chi:1;5,r_on:30"
        "&islands=0,0,3;1,2,1,4.5&pillars=3,0,1,2,6"
    )
    ramp = {"r_on": [(1, 20), (3, 26), (5, 26), (5, 30)], "laws.chi": [(1, 0.8), (3, 1)]}
    assert found.schedule == cc.Schedule(ramp)
    islands, pillars = found.surroundings
    assert islands.discs.tolist() == [[0, 0, 3, -1e12, 1e12], [1, 2, 1, 4.5, 1e12]]
    assert pillars.discs.tolist() == [[3, 0, 1, 2, 6]]


def test_a_law_of_ones_own_is_not_on_the_page():
    class Own(cc.laws.Law):
        def off_rate(self, phi, p):
            return 2.0 * cc.laws.exp(phi)

    with pytest.raises(cc.InputError, match="catch-slip"):
        cc.explore(laws=Own())
    with pytest.raises(cc.InputError, match="sweep"):
        cc.explore(laws=cc.laws.SweptMyosin(sweep=5.0))
    assert "law=stiffness&laws.chi=0.5" in cc.explore(laws=cc.laws.Stiffness(chi=0.5)).text


@pytest.mark.parametrize(
    "link",
    [
        "v=3&r_on=3",
        "law=none",
        "law=stiffness&laws.chi=9",
        "changes=1~x,r_on:3",
        "r_on=x",
        "r_on=1e9",
        "islands=1,2",
        "pokes=kick,1,2,3",
        "changes=1,q:2",
    ],
)
def test_a_bad_link_is_one_line(link):
    with pytest.raises(cc.InputError):
        links.read(link)


@node.needs_node
def test_the_page_reads_every_link_that_is_offered_as_the_package_does(tmp_path):
    offered = [one.link for one in (*presets.PRESETS, *cards.CARDS)]
    code = "return given.map((link) => $link.read(link));"
    for link, seen in zip(
        offered, node.run("link", content(), code, offered, tmp_path), strict=True
    ):
        assert seen["complaints"] == []
        asked, setup = links.read(link), seen["setup"]
        numbers = {f"laws.{name}": value for name, value in asked.laws.values.items()}
        assert setup["parameters"] == {**asked.parameters.to_dict(), **numbers}
        assert (setup["seed"], setup["rtol"]) == (asked.seed, asked.rtol)
        count = len(setup["pokes"]) + sum(bool(setup[kind]) for kind in ("islands", "pillars"))
        assert count == len(asked.surroundings)


def quick_or_slow(preset: presets.Preset) -> object:
    """Surroundings are compiled first, which takes most of a minute."""
    ground = "islands" in preset.link or "pillars" in preset.link
    return pytest.param(preset, id=preset.key, marks=[pytest.mark.slow] if ground else [])


@pytest.mark.parametrize("preset", [quick_or_slow(preset) for preset in presets.OTHERS])
def test_what_the_page_says_of_a_preset_is_so(preset):
    found = links.read(preset.link)
    run = cc.simulate(found.parameters, t_end=preset.until, **found.options())
    if found.schedule is not None:
        run = run.sel(time=slice(found.schedule.breaks[-1] + 5.0, None))
    if preset.mode:
        assert cc.classify(run).mode == preset.mode


@pytest.mark.parametrize("card", cards.CARDS, ids=lambda card: card.title)
def test_the_expected_outcome_of_a_card_comes(card):
    links.read(card.link)
    assert card.check()


def test_the_command_writes_the_page(tmp_path, capsys):
    assert command(["explore", "--r-on", "24", "--output", str(tmp_path / "cell.html")]) == 0
    assert "r_on=24" in (tmp_path / "cell.html").read_text("utf-8")
    assert command(["explore", "--view", "huge"]) == 2


def test_a_notebook_shows_the_page():
    assert cc.explore(view="bare")._repr_html_().startswith("<iframe srcdoc=")
    with pytest.raises(cc.InputError):
        cc.explore(3)


@pytest.mark.skipif(chromium() is None, reason="chromium is not on this machine")
def test_a_saved_run_is_played_back(tmp_path):
    p = cc.Parameters(r_on=26, zeta_1=600)
    run = cc.simulate(p, t_end=4.0, start=cc.RandomPerturbation(seed=2))
    place = cc.explore(run, view="full").save(tmp_path / "run.html")
    with Browser() as browser:
        browser.open(place)
        browser.wait("window.page && page.run.now > 0.5")
        browser.value("page.run.advance(4)")
        assert browser.value("page.run.seen.tension") == pytest.approx(float(run["tension"][-1]))
        browser.value("document.querySelector('[data-take=python]').click()")
        assert "saved run" in browser.value("document.getElementById('notice').textContent")
        x = browser.value("[...page.run.cell.fields.x]")
        assert x == pytest.approx(run["x"].values[-1].tolist(), abs=2e-4)
        assert browser.errors == []
