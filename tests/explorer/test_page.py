"""The page in real Chromium, opened from disk with the network off."""

from __future__ import annotations

import json
import time

import pytest

import cellcrawl as cc
from cellcrawl.explorer import links
from tests.explorer.browser import Browser

LINK = "#v=1&r_on=26&zeta_1=600&seed=2&paused=true"


def opened(browser: Browser, page, fragment: str = LINK) -> Browser:
    browser.errors.clear()
    browser.send("Page.navigate", url="about:blank")
    browser.wait("location.href === 'about:blank'")
    browser.open(page.as_uri() + fragment)
    browser.wait("window.page && page.frames > 1")
    return browser


def run_to(browser: Browser, t: float) -> None:
    browser.value(f"page.run.advance({t}), page.run.now")


def test_a_cell_crawls_at_once_with_the_network_off_and_no_error(browser, page):
    opened(browser, page, "")
    browser.wait("page.run.now > 1")
    assert browser.value("page.run.status") == "running"
    assert browser.errors == []


def test_the_dot_on_the_map_moves_the_cell(browser, page):
    opened(browser, page)
    box = json.loads(browser.value("JSON.stringify(page.map.canvas.getBoundingClientRect())"))
    inside = json.loads(browser.value("JSON.stringify(page.map.box)"))
    x, y = box["x"] + inside["x"] + inside["w"] / 2, box["y"] + inside["y"] + inside["h"] / 4
    for kind in ("mousePressed", "mouseReleased"):
        browser.mouse(kind, x, y)
    run_to(browser, 1.0)
    assert browser.value("page.run.parameters.r_on") == pytest.approx(36.0, abs=0.5)
    assert browser.value("page.run.parameters.zeta_1") == pytest.approx(590.0, abs=2)
    browser.key("ArrowRight")
    run_to(browser, 2.0)
    assert browser.value("page.run.parameters.r_on") == pytest.approx(36.5, abs=0.5)
    assert browser.value("page.run.cell.profile[0] === page.run.parameters.r_on")


def test_every_control_does_what_it_says(browser, page):
    opened(browser, page)

    def press(selector: str) -> None:
        browser.value(f"document.querySelector({selector!r}).click()")

    def choose(name: str, value: str) -> None:
        browser.value(
            f"(() => {{ const e = document.getElementById({name!r}); e.value = {value!r}; "
            "e.dispatchEvent(new Event('input')); e.dispatchEvent(new Event('change')); })()"
        )

    press("#step")
    assert browser.value("page.run.now") == 1.0
    press("#play")
    browser.wait("page.run.now > 1.2")
    press("#play")
    held = browser.value("page.run.now")
    time.sleep(0.2)
    assert browser.value("page.run.now") == held
    press("#reset")
    assert browser.value("page.run.now") == 0
    choose("r_on", "30")
    choose("zeta_1-number", "580")
    run_to(browser, 1.0)
    assert browser.value("[page.run.parameters.r_on, page.run.parameters.zeta_1]") == [30, 580]
    choose("D", "0.1")
    run_to(browser, 2.0)
    assert browser.value("page.run.parameters.D") == 0.1
    choose("elasticity", "consistent")
    assert browser.value("page.run.setup.parameters.elasticity") == "consistent"
    press("#dice")
    assert browser.value("page.run.setup.seed") == 3
    choose("seed", "77")
    assert browser.value("page.run.setup.seed") == 77
    choose("speed", "1")
    assert browser.value("page.view.speed") == 10
    for field in ("off_rate", "friction", "curvature", "normal_velocity"):
        choose("field", field)
        browser.wait(f"page.places[0].stage.field === {field!r}")
    choose("camera", "whole")
    browser.wait("page.places[0].stage.camera === 'whole'")
    press("#units")
    browser.wait("!document.querySelector('.clock').textContent.startsWith('t =')")
    press("#pair")
    assert browser.value("page.shownPlaces.length") == 2
    press("#pair")
    assert browser.value("page.shownPlaces.length") == 1
    for number in range(browser.value("document.querySelectorAll('#shelf button').length")):
        browser.value(f"document.querySelectorAll('#shelf button')[{number}].click()")
    browser.value("document.querySelectorAll('#deck button')[1].click()")
    assert browser.value("page.run.setup.events[0].set.r_on") == 26
    assert browser.errors == []


def test_a_number_out_of_range_is_told_and_not_taken(browser, page):
    opened(browser, page)
    browser.value(
        "(() => { const e = document.getElementById('r_on-number'); e.value = '999'; "
        "e.dispatchEvent(new Event('change')); })()"
    )
    assert "from 1 to 200" in browser.value("document.getElementById('notice').textContent")
    assert browser.value("page.run.latest.r_on") == 26


def test_hands_on_the_cell_and_the_ground_change_the_run(browser, page):
    opened(browser, page)
    run_to(browser, 10.0)
    for tool in ("release", "push", "island", "wall"):
        browser.value(f"document.querySelector('[data-tool={tool}]').click()")
        place = "[page.run.cell.fields.x[3], page.run.cell.fields.y[3]]"
        browser.value(f"page.touch(page.place, {place}, true)")
        run_to(browser, browser.value("page.run.now") + 2.0)
    assert browser.value("page.run.setup.pokes.map((p) => p.kind)") == ["release", "push"]
    assert browser.value("[page.run.setup.islands.length, page.run.setup.pillars.length]") == [1, 1]
    assert browser.value("page.run.cell.onGround") is True
    browser.value("page.sync(); document.getElementById('clean').click()")
    assert browser.value("[page.run.setup.islands.length, page.run.setup.pillars.length]") == [0, 0]
    assert browser.errors == []


def test_a_link_restores_the_same_bits(browser, page):
    opened(browser, page)
    run_to(browser, 3.0)
    browser.value("page.change({r_on: 31.5})")
    run_to(browser, 6.0)
    browser.value("page.run.poke('push', 0.4, 0.6)")
    run_to(browser, 9.0)
    fields = "...page.run.cell.fields.x, ...page.run.cell.fields.bound_fraction"
    state = f"JSON.stringify([{fields}, page.run.cell.steps])"
    browser.value("page.run.sample()")
    before = browser.value(state)
    browser.value("document.querySelector('[data-take=link]').click()")
    link = browser.value("document.getElementById('taken').value")
    opened(browser, page, "#" + link.partition("#")[2] + "&paused=true")
    run_to(browser, 9.0)
    browser.value("page.run.sample()")
    assert browser.value(state) == before


def test_the_python_lines_make_the_run_of_the_page(browser, page):
    opened(browser, page)
    browser.value("page.run.advance(2); page.change({zeta_1: 570}); page.run.advance(5)")
    browser.value("document.querySelector('[data-take=python]').click()")
    lines = browser.value("document.getElementById('taken').value")
    scope: dict = {}
    exec(lines.partition("print(")[0], scope)
    run = scope["run"]
    assert float(run["time"][-1]) == 5.0
    length = browser.value("page.run.sample().length")
    assert length == pytest.approx(float(run["length"][-1]), rel=1e-8)


def test_pictures_numbers_and_embed_code_can_be_taken(browser, page):
    opened(browser, page)
    run_to(browser, 2.0)
    browser.value("window.saved = []")
    browser.value("URL.createObjectURL = (b) => { saved.push([b.type, b.size]); return '#'; }")
    for what in ("png", "csv"):
        browser.value(f"document.querySelector('[data-take={what}]').click()")
    browser.wait("saved.length === 2")
    kinds = {kind for kind, size in browser.value("saved") if size > 1000}
    assert kinds == {"image/png", "text/csv"}
    for level in ("full", "small", "bare"):
        browser.value(f"document.getElementById('level').value = {level!r}")
        browser.value("document.querySelector('[data-take=embed]').click()")
        code = browser.value("document.getElementById('taken').value")
        assert code.startswith("<iframe")
        assert (level == "full") or f"view={level}" in code


@pytest.mark.parametrize(
    ("fragment", "words"),
    [
        ("#v=99&r_on=30&paused=true", "newer page"),
        ("#r_on=banana&paused=true", "no number"),
        ("#r_on=1e9&paused=true", "out of range"),
        ("#%E0%A4%A&&&==&seed=-3&changes=;;x&islands=1,2&pokes=kick,1,2&field=none", "seed"),
    ],
)
def test_a_link_with_nonsense_is_told_and_a_cell_crawls(browser, page, fragment, words):
    opened(browser, page, fragment)
    assert words in browser.value("document.getElementById('notice').textContent")
    run_to(browser, 1.0)
    assert browser.value("page.run.now") >= 1.0
    assert browser.errors == []


def test_a_torn_cell_says_so_and_offers_another(browser, page):
    opened(browser, page, "#v=1&r_on=16&zeta_1=600&seed=7&paused=true")
    run_to(browser, 10.0)
    browser.wait("!document.querySelector('.ended').hidden")
    assert "tears" in browser.value("document.querySelector('.ended p').textContent")
    found = links.read("v=1&r_on=16&zeta_1=600&seed=7")
    run = cc.simulate(found.parameters, t_end=10.0, **found.options())
    assert browser.value("page.run.ended") == pytest.approx(run.attrs["end_time"], abs=2e-3)
    browser.value("document.querySelector('[data-do=another]').click()")
    assert browser.value("[page.run.setup.seed, page.run.status]") == [8, "running"]


def test_a_browser_without_webassembly_gets_words(browser, page):
    browser.errors.clear()
    script = browser.send(
        "Page.addScriptToEvaluateOnNewDocument", source="delete globalThis.WebAssembly;"
    )
    browser.send("Page.navigate", url="about:blank")
    browser.open(page.as_uri())
    browser.wait("!document.getElementById('notice').hidden")
    assert "WebAssembly" in browser.value("document.getElementById('notice').textContent")
    browser.send("Page.removeScriptToEvaluateOnNewDocument", identifier=script["identifier"])
    assert browser.errors == []


@pytest.mark.parametrize("width", [360, 390, 820, 1400, 1920])
def test_nothing_is_wider_than_the_screen(browser, page, width):
    browser.size(width, 800)
    opened(browser, page)
    assert browser.value("document.documentElement.scrollWidth <= window.innerWidth")
    browser.size(1400, 900)


def test_two_embeds_on_one_page_are_independent(browser, page, tmp_path):
    frames = [
        f'<iframe src="{page.as_uri()}#r_on={r_on}&amp;view=bare" width=400 height=300></iframe>'
        for r_on in (16, 44)
    ]
    (tmp_path / "two.html").write_text("<!doctype html>" + "".join(frames))
    browser.errors.clear()
    browser.open(tmp_path / "two.html")
    time.sleep(1.0)
    tree = browser.send("Page.getFrameTree")["frameTree"]["childFrames"]
    assert len(tree) == 2
    assert browser.errors == []


def test_the_page_waits_while_it_is_out_of_view(browser, page):
    opened(browser, page, "#v=1&seed=2")
    browser.wait("page.run.now > 0.2")
    browser.value("window.scrollTo(0, document.documentElement.scrollHeight)")
    browser.wait("page.visible === false")
    held = browser.value("page.run.now")
    time.sleep(0.2)
    assert browser.value("page.run.now") == held
    browser.value("window.scrollTo(0, 0)")
    browser.wait(f"page.run.now > {held}")
