"""The page in real Chromium, opened from disk with the network off."""

from __future__ import annotations

import base64
import io
import json
import time

import imageio_ffmpeg
import numpy as np
import pytest
from PIL import Image

import cellcrawl as cc
from cellcrawl.explorer import links
from tests.explorer.browser import Browser

STATE = (
    "JSON.stringify([...page.run.cell.fields.x, ...page.run.cell.fields.bound_fraction, "
    "page.run.cell.steps])"
)
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
    assert browser.value("[...page.run.lasting('islands'), ...page.run.lasting('pillars')]") == []
    assert browser.value("document.getElementById('clean').hidden") is True
    browser.value("document.getElementById('reset').click()")
    assert browser.value("[page.run.setup.islands, page.run.setup.pokes]") == [[], []]
    assert browser.errors == []


def test_a_link_restores_the_same_bits(browser, page):
    opened(browser, page)
    run_to(browser, 3.0)
    browser.value("page.change({r_on: 31.5})")
    run_to(browser, 6.0)
    browser.value("page.run.poke('push', 0.4, 0.6)")
    run_to(browser, 9.0)
    browser.value("page.run.sample()")
    before = browser.value(STATE)
    browser.value("document.querySelector('[data-take=link]').click()")
    link = browser.value("document.getElementById('taken').value")
    opened(browser, page, "#" + link.partition("#")[2] + "&paused=true")
    run_to(browser, 9.0)
    browser.value("page.run.sample()")
    assert browser.value(STATE) == before


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


def test_a_cell_crawls_under_every_law(browser, page):
    opened(browser, page)
    names = browser.value("[...document.querySelectorAll('#law option')].map((o) => o.value)")
    assert names == list(cc.laws.SHIPPED)
    for name in names:
        browser.value(
            f"(() => {{ const e = document.getElementById('law'); e.value = {name!r}; "
            "e.dispatchEvent(new Event('change')); })()"
        )
        numbers = browser.value("[...document.querySelectorAll('#law-numbers input')].length")
        assert numbers == 2 * len(cc.laws.SHIPPED[name].parameters)
        run_to(browser, 1.0)
        assert browser.value("[page.run.setup.law, page.run.status]") == [name, "running"]
    for sweep, words in (("1.99", "no one balance"), ("0", "")):
        browser.value(
            "(() => { const e = document.getElementById('laws.sweep-number'); "
            f"e.value = {sweep!r}; e.dispatchEvent(new Event('change')); }})()"
        )
        assert words in browser.value("document.getElementById('notice').textContent")
    run_to(browser, 2.0)
    assert browser.value("page.run.parameters['laws.sweep']") == 0
    assert browser.errors == []


def test_a_law_without_a_resting_circle_says_so_and_offers_the_papers(browser, page):
    opened(browser, page, "#v=2&law=catch-slip&laws.catch=5&laws.slip=0&paused=true")
    browser.wait("!document.querySelector('.ended').hidden")
    assert "no circle is at rest" in browser.value("document.querySelector('.ended p').textContent")
    browser.value("document.querySelector('[data-do=another]').click()")
    assert browser.value("[page.run.setup.law, page.run.status]") == ["paper", "running"]
    assert browser.errors == []


def painted(browser: Browser) -> None:
    """Change, ramp, paint, wipe and poke on the way, under a law."""
    run_to(browser, 1.0)
    browser.value("page.run.paint('islands', [0.2, 0.1, 1.4])")
    run_to(browser, 2.0)
    browser.value("document.getElementById('over').value = '10'; page.change({r_on: 34})")
    browser.value("page.run.paint('pillars', [2.5, 0, 0.5])")
    run_to(browser, 3.0)
    browser.value("page.run.poke('push', 0.4, 0.6)")
    browser.value("page.wipe()")
    run_to(browser, 4.0)
    browser.value("page.run.paint('islands', [1, 1, 2])")


def test_a_link_restores_painted_ground_ramps_and_law_to_the_same_bits(browser, page):
    for law in ("", "&law=stiffness&laws.chi=0.8"):
        opened(browser, page, f"#v=2&r_on=26&zeta_1=600&seed=2{law}&paused=true")
        painted(browser)
        run_to(browser, 9.0)
        browser.value("page.run.sample()")
        before = browser.value(STATE)
        browser.value("document.querySelector('[data-take=link]').click()")
        link = browser.value("document.getElementById('taken').value")
        opened(browser, page, "#" + link.partition("#")[2] + "&paused=true")
        assert browser.value("document.getElementById('notice').hidden")
        run_to(browser, 9.0)
        browser.value("page.run.sample()")
        assert browser.value(STATE) == before
    assert browser.errors == []


def test_the_python_lines_tell_law_ground_and_pokes(browser, page):
    opened(browser, page, "#v=2&law=stiffness&laws.chi=0.8&seed=2&paused=true")
    painted(browser)
    run_to(browser, 5.0)
    browser.value("document.querySelector('[data-take=python]').click()")
    lines = browser.value("document.getElementById('taken').value")
    scope: dict = {}
    exec(lines.partition("run = ")[0], scope)
    browser.value("document.querySelector('[data-take=link]').click()")
    asked = links.read(browser.value("document.getElementById('taken').value"))
    assert scope["p"] == asked.parameters
    assert scope["options"] == {
        name: value
        for name, value in asked.options().items()
        if name in scope["options"] or value not in (None, 1e-4)
    }


@pytest.mark.slow
def test_the_run_of_the_python_lines_is_that_of_the_page_with_painted_ground(browser, page):
    opened(browser, page, "#v=2&seed=2&paused=true")
    painted(browser)
    run_to(browser, 6.0)
    seen = browser.value("page.run.sample()")
    browser.value("document.querySelector('[data-take=python]').click()")
    lines = browser.value("document.getElementById('taken').value")
    scope: dict = {}
    exec(lines.partition("print(")[0], scope)
    for name in ("length", "tension", "area"):
        assert seen[name] == float(scope["run"][name][-1])


def test_there_is_embed_code_of_three_levels(browser, page):
    opened(browser, page)
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


@pytest.mark.parametrize(
    ("script", "words"),
    [
        ("delete globalThis.WebAssembly;", "no WebAssembly"),
        ("WebAssembly.validate = () => false;", "no SIMD part"),
        ("delete globalThis.DecompressionStream;", "cannot unpack"),
    ],
)
def test_a_browser_that_cannot_run_the_solver_gets_words_and_a_picture(
    browser, page, script, words
):
    browser.errors.clear()
    added = browser.send("Page.addScriptToEvaluateOnNewDocument", source=script)
    browser.send("Page.navigate", url="about:blank")
    browser.open(page.as_uri() + LINK)
    browser.wait("!document.getElementById('notice').hidden")
    browser.send("Page.removeScriptToEvaluateOnNewDocument", identifier=added["identifier"])
    assert words in browser.value("document.getElementById('notice').textContent")
    colours = browser.value(
        "(() => { const c = document.querySelector('canvas.cell'); const d = c.getContext('2d')"
        ".getImageData(0, 0, c.width, c.height).data; const found = new Set(); "
        "for (let k = 0; k < d.length; k += 4) found.add(d[k] + 256 * d[k + 1]); "
        "return found.size; })()"
    )
    assert colours > 10
    assert browser.errors == []


def test_a_browser_older_than_modules_gets_words(browser, page):
    opened(browser, page)
    browser.value("eval(document.querySelector('script[nomodule]').textContent), 0")
    assert "older" in browser.value("document.getElementById('notice').textContent")
    assert browser.value("document.getElementById('notice').hidden") is False


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
    tree = browser.send("Page.getFrameTree")["frameTree"]["childFrames"]
    worlds = [
        browser.send("Page.createIsolatedWorld", frameId=part["frame"]["id"])["executionContextId"]
        for part in tree
    ]

    def within(world: int, expression: str) -> object:
        found = browser.send(
            "Runtime.evaluate", expression=expression, contextId=world, returnByValue=True
        )
        return found["result"].get("value")

    def clocks() -> list[float]:
        told = [within(world, "document.querySelector('.clock').textContent") for world in worlds]
        return [float(str(text).removeprefix("t = ") or 0.0) for text in told]

    def until(condition: object) -> None:
        end = time.monotonic() + 20.0
        while not condition():  # type: ignore[operator]
            assert time.monotonic() < end, clocks()
            time.sleep(0.05)

    until(lambda: min(clocks()) > 0.5)
    within(worlds[0], "document.getElementById('play').click()")
    held, before = clocks()
    until(lambda: clocks()[1] > before + 0.5)
    assert clocks()[0] - held < 0.2
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


def test_a_tab_left_for_a_night_goes_on_where_it_was(browser, page):
    opened(browser, page, "#v=1&seed=2")
    browser.wait("page.run.now > 0.2")
    hide = (
        "Object.defineProperty(document, 'hidden', { value: %s, configurable: true }); "
        "document.dispatchEvent(new Event('visibilitychange')), page.run.now"
    )
    held = browser.value(hide % "true")
    time.sleep(0.2)
    assert browser.value("page.run.now") == held
    browser.value("page.last -= 9 * 3600 * 1000, 0")  # the clock has gone on
    assert browser.value(hide % "false") == held
    browser.wait(f"page.run.now > {held}")
    assert browser.value("page.run.now") < held + 5.0
    browser.value("page.last -= 9 * 3600 * 1000, 0")  # and without a word of it
    browser.wait("page.frames > 3")
    assert browser.value("page.run.now") < held + 10.0
    assert browser.errors == []


def test_a_slider_at_its_end_runs_or_says_why_not(browser, page):
    opened(browser, page)
    sliders = browser.value(
        "[...document.querySelectorAll('#controls [type=range]')].map(s => s.id)"
    )
    assert len(sliders) >= 8
    for slider in sliders:
        for end in ("min", "max"):
            browser.value(
                f"page.open({LINK!r}), page.playing = false; (() => {{ "
                f"const s = document.getElementById({slider!r}); s.value = s.{end}; "
                "s.dispatchEvent(new Event('input')); })(); page.run.advance(1.5); "
                "page.tell(page.place)"
            )
            assert browser.value(f"page.run.parameters[{slider!r}]") == browser.value(
                f"Number(document.getElementById({slider!r}).{end})"
            )
            status = browser.value("page.run.status")
            words = browser.value("document.querySelector('.ended p').textContent")
            assert status == "running" or len(words) > 40, (slider, end, status)
    assert browser.errors == []


def taken(browser: Browser, what: str, until: str = "true") -> tuple[str, bytes]:
    """Press a button of "Take it home" and return the kind and the bytes of the file it gives."""
    browser.value(
        "window.kept = null; URL.createObjectURL = (blob) => { window.kept = blob; return '#'; }; "
        "HTMLAnchorElement.prototype.click = () => {}; "
        f"document.querySelector('[data-take={what}]').click()"
    )
    browser.wait(until)
    if what == "clip":
        browser.value("document.querySelector('[data-take=clip]').click()")
    browser.wait("window.kept")
    text = browser.value(
        "new Promise((done) => { const reader = new FileReader(); "
        "reader.onload = () => done(reader.result); reader.readAsDataURL(window.kept); })"
    )
    return browser.value("window.kept.type"), base64.b64decode(text.partition(",")[2])


def test_the_outlines_are_those_that_were_seen(browser, page):
    opened(browser, page)
    run_to(browser, 3.0)
    _, made = taken(browser, "csv")
    head, *rows = made.decode().splitlines()
    assert head == "time,point,x,y"
    table = np.array([[float(value) for value in row.split(",")] for row in rows])
    times = np.unique(table[:, 0])
    assert times.tolist() == pytest.approx([0.1 * k for k in range(31)])
    assert len(rows) == times.size * 256
    last = table[table[:, 0] == 3.0]
    browser.value("page.run.sample()")
    assert last[:, 2].tolist() == pytest.approx(
        browser.value("[...page.run.cell.fields.x]"), abs=1e-4
    )


def test_the_picture_is_what_is_seen(browser, page):
    opened(browser, page)
    kind, made = taken(browser, "png")
    with Image.open(io.BytesIO(made)) as picture:
        size = browser.value("[page.place.canvas.width, page.place.canvas.height]")
        assert (kind, [*picture.size]) == ("image/png", size)
        assert len(picture.convert("RGB").getcolors(1 << 24)) > 50


def test_a_clip_has_the_frames_that_were_drawn_and_lasts_as_long(browser, page, tmp_path):
    opened(browser, page, "#v=1&seed=2")
    began = time.monotonic()
    kind, made = taken(browser, "clip", "page.clip.frames >= 40")
    took = time.monotonic() - began
    file = tmp_path / ("clip." + kind.partition("/")[2].partition(";")[0])
    file.write_bytes(made)
    frames, seconds = imageio_ffmpeg.count_frames_and_secs(str(file))
    assert frames == pytest.approx(browser.value("page.clip.frames"), abs=4)
    assert seconds == pytest.approx(took, abs=1.0)
    told = next(imageio_ffmpeg.read_frames(str(file)))  # what the head of the file says
    assert told["duration"] == pytest.approx(took, abs=1.0)
    assert browser.value("document.querySelector('[data-take=clip]').textContent") == "Record clip"


def test_a_screen_reader_hears_of_a_new_mode_once(browser, page):
    opened(browser, page, "#v=1&r_on=16&zeta_1=600&seed=2&paused=true")
    browser.value(
        "window.heard = []; new MutationObserver(() => heard.push(document.getElementById("
        "'announced').textContent)).observe(document.getElementById('announced'), "
        "{ childList: true, characterData: true, subtree: true })"
    )
    for t in range(10, 70, 2):
        run_to(browser, t)
        browser.value("page.tell(page.place), new Promise((done) => setTimeout(done))")
    heard = browser.value("heard")
    assert "gliding" in heard[-1]
    assert len(heard) <= 4
    labels = browser.value(
        "[...document.querySelectorAll('canvas, input, select, textarea, button')]"
        ".filter((e) => e.offsetParent && e.getAttribute('aria-hidden') !== 'true' && "
        "!(e.getAttribute('aria-label') || e.labels?.length || e.textContent.trim()))"
        ".map((e) => e.outerHTML)"
    )
    assert labels == []
