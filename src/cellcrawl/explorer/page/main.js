// The page: controls, their words, and the loop that draws.

import { DATA } from "./data.js";
import { LIMITS } from "./limits.js";
import { EVERY, PARAMETERS, Run, STATUS, complaint, usual } from "./run.js";
import { MODE_COLOURS, MODE_MARKERS } from "./colours.js";
import { Stage, colourBar } from "./stage.js";
import { PhaseMap } from "./map.js";
import { Kymograph, line } from "./strips.js";
import { Recording } from "./recording.js";
import { read, write } from "./link.js";
import { csv, embed, png, python, save } from "./take.js";
import { clip, drawn } from "./clip.js";
import { thumbnail } from "./thumbnails.js";
import { loadModule } from "./load.js";
import { clock, digits, isPhysical, shown, usePhysical } from "./units.js";

const $ = (id) => document.getElementById(id);
const all = (selector) => [...document.querySelectorAll(selector)];
const BUDGET = 11; // ms a frame that the solver may take
const LAWLESS = ["no_rest", "refused"]; // another seed would not help
const WORDS = { gliding: "gliding", rotational: "rotational", zigzag: "zigzag", other: "other", stationary: "at rest", fragmented: "torn", "": "…" };

export function symbol(mode, title = "") {
  const shapes = {
    circle: '<circle r="8"/>', square: '<rect x="-7.5" y="-7.5" width="15" height="15"/>',
    diamond: '<path d="M0-10 10 0 0 10-10 0Z"/>', triangle: '<path d="M0-9 9 7-9 7Z"/>',
    cross: '<path d="M-9-6-6-9 0-3 6-9 9-6 3 0 9 6 6 9 0 3-6 9-9 6-3 0Z"/>',
  };
  return `<g fill="${MODE_COLOURS[mode] ?? "#fff"}" stroke="#222" stroke-width="1.2">${shapes[MODE_MARKERS[mode] ?? "circle"]}</g>${title ? `<title>${title}</title>` : ""}`;
}

class Page {
  constructor(module, given) {
    this.module = module;
    this.view = given.view;
    this.playing = !given.view.paused;
    this.tool = "release";
    this.places = all(".stage").map((element) => ({ element, canvas: element.querySelector("canvas"), stage: new Stage(element.querySelector("canvas")), run: null }));
    this.active = 0;
    this.kymographs = ["bound_fraction", "curvature"].map((field) => new Kymograph(document.querySelector(`[data-strip=${field}]`), field, field === "curvature" ? "curvature κ along the edge" : "bound fraction n along the edge"));
    document.body.classList.add(this.view.view);
    usePhysical(this.view.units === "si");
    this.map = new PhaseMap($("map"), (values) => this.change(values));
    this.listen();
    this.load(given.setup, given.view.to);
    if (given.complaints.length) this.notice(`Not all of this link could be read: ${given.complaints.slice(0, 4).join("; ")}.`);
    this.visible = true;
    this.frames = 0;
    this.last = performance.now();
    document.body.classList.remove("loading");
    requestAnimationFrame((now) => {
      this.frame(now);
      this.firstPicture = performance.now(); // ms since the page was asked for
      this.shelf();
      this.cards();
      this.sync();
    });
  }

  get place() { return this.places[this.active]; }
  get run() { return this.place.run; }
  get shownPlaces() { return this.places.filter((place) => !place.element.hidden); }

  load(setup, to = 0) {
    const { place } = this;
    place.run = DATA.run && !this.left ? new Recording() : new Run(this.module, setup);
    place.told = place.news = undefined;
    place.element.querySelector(".ended").hidden = true;
    const { law } = place.run.setup;
    place.element.querySelector(".law").textContent = law === "paper" ? "" : `law: ${DATA.laws[law].title}`;
    place.stage.center = null;
    place.named = 0;
    this.catchUp = to;
    this.kymographs.forEach((kymograph) => kymograph.reset());
    this.fresh = true;
    this.sync();
  }

  frame(now) {
    const passed = Math.min(now - this.last, 60) / 1000;
    this.last = now;
    this.frames += 1;
    if (this.visible) {
      const share = BUDGET / this.shownPlaces.length;
      for (const place of this.shownPlaces) {
        const deadline = performance.now() + share;
        const { run } = place;
        if (this.catchUp > run.now && run.status === "running") run.advance(this.catchUp, deadline);
        else if (this.playing) run.advance(run.now + passed * this.view.speed, deadline);
        if (run.now - place.named > 1 || (run.status !== "running" && place.told !== run.status)) this.tell(place);
      }
      this.draw();
    }
    requestAnimationFrame((then) => this.frame(then));
  }

  draw() {
    for (const place of this.shownPlaces) {
      place.stage.field = this.view.field;
      place.stage.camera = this.view.camera;
      place.stage.draw(place.run, { jump: this.fresh });
      const text = clock(place.run.now);
      if (place.clockText !== text) place.element.querySelector(".clock").textContent = place.clockText = text;
    }
    drawn();
    if (this.fresh || this.mapDirty) {
      this.drawMap();
      colourBar($("bar"), this.view.field);
    }
    if (this.view.view === "full" && (this.fresh || this.frames % 3 === 0)) this.drawStrips();
    this.fresh = false;
  }

  drawMap() {
    this.map.dots = this.shownPlaces.map((place, k) => ({ ...place.run.latest, label: this.shownPlaces.length > 1 ? "AB"[k] : "", active: place === this.place }));
    this.map.dots.sort((a, b) => a.active - b.active);
    this.map.draw();
    this.mapDirty = false;
  }

  drawStrips() {
    const { run } = this;
    line(document.querySelector("[data-strip=tension]"), run, "tension", { colour: "#0072b2", label: "membrane tension σ", kind: "tension" });
    line(document.querySelector("[data-strip=speed]"), run, "speed", { colour: "#d55e00", label: "speed of the centroid", kind: "velocity", low: 0 });
    this.kymographs.forEach((kymograph) => kymograph.draw(run));
  }

  tell(place) {
    const { run, element } = place;
    place.named = run.now;
    const mode = run.name();
    element.querySelector(".badge svg").innerHTML = symbol(mode.mode);
    element.querySelector(".mode").textContent = WORDS[mode.mode];
    element.querySelector(".sure").textContent = mode.mode && mode.mode !== "fragmented" ? mode.confidence > 0.995 ? "over 99 % sure" : `${Math.round(100 * mode.confidence)} % sure` : "";
    const ended = run.status !== "running";
    place.told = run.status;
    element.querySelector(".ended").hidden = !ended;
    if (ended) element.querySelector(".ended p").textContent = `${STATUS[run.status]} (${clock(run.now)})`;
    element.querySelector(".ended button").textContent = LAWLESS.includes(run.status) ? "Back to the paper's law" : "Try another seed";
    const words = `${WORDS[mode.mode] || "too early to name"}${mode.words ? `: ${mode.words}` : ""}`;
    place.canvas.setAttribute("aria-label", `The cell at ${clock(run.now)}: ${words}; tension ${shown(run.recent.tension[(run.count - 1) % run.recent.tension.length], "tension")}`);
    if (place !== this.place) return;
    const text = mode.mode && mode.words ? `${mode.words[0].toUpperCase()}${mode.words.slice(1)}.` : ended ? "" : "The round cell has no front yet: it takes a while to break its symmetry.";
    if ($("said").textContent !== text) $("said").textContent = text;
    const news = `${mode.mode}${run.status}`; // a screen reader is told once, not with every number
    if (place.news !== news) $("announced").textContent = `At ${clock(run.now)}: ${ended ? STATUS[run.status] : words}`;
    place.news = news;
  }

  change(values) {
    if (this.run.recorded) return this.notice("This is a saved run, played back. Choose a cell below or press “Another” to compute one.");
    if (this.run.status !== "running") return;
    const refused = complaint(this.run.setup.law, { ...this.run.latest, ...values });
    if (refused) this.notice(refused);
    else {
      if (this.refused) this.notice("");
      this.run.change(values, Number($("over").value));
    }
    this.refused = Boolean(refused);
    this.sync();
  }

  // Bring all controls to what the active run is.
  sync() {
    const latest = this.run.latest;
    this.lawNumbers();
    for (const name of [...Object.keys(PARAMETERS), ...Object.keys(usual(this.run.setup.law))]) {
      const slider = $(name), number = $(`${name}-number`);
      if (slider) slider.value = name === "elasticity" ? latest[name] : latest[name];
      if (number && document.activeElement !== number) number.value = Number(latest[name].toPrecision(6));
    }
    $("seed").value = this.run.setup.seed;
    $("field").value = this.view.field;
    $("camera").value = this.view.camera;
    $("units").checked = isPhysical();
    $("speed").value = Math.log10(this.view.speed);
    this.showSpeed();
    $("play").textContent = this.playing ? "Pause" : "Play";
    $("play").setAttribute("aria-pressed", String(this.playing));
    $("map").setAttribute("aria-label", `Map of binding rate and adhesive friction. The cell is at binding rate ${digits(latest.r_on)}, adhesive friction ${digits(latest.zeta_1)}. Arrow keys move it.`);
    const key = this.run.preset;
    all("#shelf button").forEach((button) => button.setAttribute("aria-current", String(button.dataset.key === key)));
    $("clean").hidden = !["islands", "pillars"].some((kind) => this.run.lasting(kind).length);
    $("open").href = `${location.href.split("#")[0]}${write(this.run.setup, { ...this.view, view: "full", to: 0 })}`;
    this.mapDirty = true;
  }

  showSpeed() {
    const { speed } = this.view;
    $("speed-shown").textContent = isPhysical() ? `${digits(speed * DATA.scales.time, 2)} × real time` : `${digits(speed, 2)} time units/s`;
  }

  notice(text) {
    $("notice").textContent = text;
    $("notice").hidden = !text;
  }

  // A fresh cell under what holds now, but for some changes.
  again(changes = {}) {
    this.notice("");
    const { run } = this, { law, seed, rtol } = run.setup;
    this.load({ law, seed, rtol, parameters: run.latest, islands: run.lasting("islands"), pillars: run.lasting("pillars"), ...changes });
  }

  listen() {
    $("play").onclick = () => { this.playing = !this.playing; this.sync(); };
    $("step").onclick = () => { this.playing = false; for (const place of this.shownPlaces) { place.run.advance(place.run.now + 1); this.tell(place); } this.sync(); };
    $("reset").onclick = () => { const kept = this.active; this.shownPlaces.forEach((place) => { this.active = this.places.indexOf(place); this.again(); }); this.active = kept; this.sync(); };
    $("speed").oninput = (event) => { this.view.speed = 10 ** Number(event.target.value); this.showSpeed(); };
    $("field").onchange = (event) => { this.view.field = event.target.value; this.mapDirty = true; };
    $("camera").onchange = (event) => (this.view.camera = event.target.value);
    $("clean").onclick = () => this.wipe();
    $("units").onchange = (event) => { usePhysical(event.target.checked); this.view.units = event.target.checked ? "si" : "none"; this.fresh = true; this.sync(); this.shownPlaces.forEach((place) => this.tell(place)); };
    $("dice").onclick = () => (this.left = true) && this.again({ seed: this.run.setup.seed + 1 });
    $("seed").onchange = (event) => {
      const text = event.target.value;
      if (/^\d{1,15}$/.test(text)) this.again({ seed: Number(text) });
      else { this.notice("A seed is a whole number of up to 15 digits."); this.sync(); }
    };
    all("[data-do=another]").forEach((button) => (button.onclick = () => { this.active = this.places.findIndex((place) => place.element.contains(button)); if (LAWLESS.includes(this.run.status)) this.underLaw("paper"); else $("dice").onclick(); }));
    $("pair").onchange = (event) => this.pair(event.target.checked);
    this.legend();
    this.parameters();
    all("[data-tool]").forEach((button) => (button.onclick = () => { this.tool = button.dataset.tool; all("[data-tool]").forEach((other) => other.setAttribute("aria-pressed", String(other === button))); }));
    this.places.forEach((place, k) => this.hand(place, k));
    all("[data-take]").forEach((button) => (button.onclick = () => this.take(button.dataset.take, button)));
    if ("IntersectionObserver" in window) new IntersectionObserver((entries) => { this.inSight = entries.at(-1).isIntersecting; this.visible = this.inSight && !document.hidden; }, { threshold: 0.05 }).observe(document.querySelector(".stage"));
    document.addEventListener("visibilitychange", () => { this.visible = !document.hidden && this.inSight !== false; this.last = performance.now(); });
    window.addEventListener("resize", () => (this.fresh = true));
    window.addEventListener("hashchange", () => { const given = read(location.hash); this.left = true; this.view = { ...given.view, view: this.view.view }; usePhysical(given.view.units === "si"); this.notice(given.complaints.length ? `Not all of this link could be read: ${given.complaints.slice(0, 4).join("; ")}.` : ""); this.load(given.setup, given.view.to); });
  }

  legend() {
    $("legend").innerHTML = ["gliding", "rotational", "zigzag", "other", "stationary", "fragmented"].filter((mode) => DATA.map.modes.some((row) => row[2] === mode)).map((mode) => `<span><svg viewBox="-12 -12 24 24" aria-hidden="true">${symbol(mode)}</svg>${WORDS[mode]}</span>`).join("") + "<span>shade: how fast the round cell breaks its symmetry; left and right of the dashed lines it does not</span>";
  }

  parameters() {
    const bind = this.bind = (name) => {
      const slider = $(name), number = $(`${name}-number`);
      slider.oninput = () => this.change({ [name]: Number(slider.value) });
      number.onchange = () => {
        const [low, high] = LIMITS[name], value = Number(number.value);
        if (number.value.trim() === "" || !(value >= low && value <= high)) this.notice(`${name} can be from ${low} to ${high}.`);
        else { this.notice(""); this.change({ [name]: value }); }
        this.sync();
      };
    };
    ["r_on", "zeta_1"].forEach(bind);
    const steps = { D: [0.001, 0.3, 0.001], epsilon: [0.0001, 0.005, 0.0001], h: [0, 0.1, 0.001], sigma_c: [0, 500, 5], k_sigma: [0, 5000, 50], r_p: [20, 120, 1] };
    const names = { D: "diffusion <i>D</i>", epsilon: "adhesion length <i>ε</i>", h: "height <i>h</i>", sigma_c: "contraction <i>σ</i><sub>c</sub>", k_sigma: "stiffness <i>k</i><sub>σ</sub>", r_p: "off-rate at rest <i>r</i><sub>p</sub>" };
    for (const [name, [low, high, step]] of Object.entries(steps)) {
      $("rest").insertAdjacentHTML("beforeend", `<label for="${name}" title="${DATA.meanings[name]}">${names[name]}</label><input id="${name}" type="range" min="${low}" max="${high}" step="${step}"><input class="number" id="${name}-number" type="number" min="${LIMITS[name][0]}" max="${LIMITS[name][1]}" step="any" aria-label="${name}">`);
      bind(name);
    }
    $("rest").insertAdjacentHTML("beforeend", `<label for="elasticity" title="Two readings of the paper's tension law">tension law</label><select id="elasticity"><option value="printed">as printed</option><option value="consistent">consistent</option></select><span></span>`);
    $("elasticity").onchange = (event) => this.again({ parameters: { ...this.run.latest, elasticity: event.target.value } });
    $("law").innerHTML = Object.entries(DATA.laws).map(([name, { title }]) => `<option value="${name}">${title}</option>`).join("");
    $("law").onchange = (event) => this.underLaw(event.target.value);
  }

  underLaw(law) {
    const { latest } = this.run;
    const parameters = Object.fromEntries(Object.keys(PARAMETERS).map((name) => [name, latest[name]]));
    for (const [name, { begin }] of Object.entries(DATA.laws[law].numbers)) parameters[`laws.${name}`] = begin;
    this.left = true;
    this.again({ law, parameters });
  }

  // The sliders of the law's own numbers.
  lawNumbers() {
    const { law } = this.run.setup, box = $("law-numbers");
    if (box.dataset.law === law) return;
    box.dataset.law = law;
    box.innerHTML = "";
    for (const [key, { label, low, high, step, limits, meaning }] of Object.entries(DATA.laws[law].numbers)) {
      const name = `laws.${key}`;
      box.insertAdjacentHTML("beforeend", `<label for="${name}" title="${meaning}">${label}</label><input id="${name}" type="range" min="${low}" max="${high}" step="${step}"><input class="number" id="${name}-number" type="number" min="${limits[0]}" max="${limits[1]}" step="any" aria-label="${meaning}">`);
      this.bind(name);
    }
    $("law").value = law;
    $("law-words").textContent = DATA.laws[law].words;
    $("law-shown").textContent = DATA.laws[law].title;
    $("of-the-paper").hidden = law === "paper";
    if (law !== "paper") $("laws").open = true;
  }

  hand(place, k) {
    const { canvas, stage } = place;
    let held = false;
    canvas.addEventListener("pointerdown", (event) => {
      if (this.active !== k) { this.active = k; this.kymographs.forEach((kymograph) => kymograph.reset()); this.outlineActive(); this.sync(); }
      held = true;
      canvas.setPointerCapture(event.pointerId);
      this.touch(place, stage.toWorld(event), true);
    });
    canvas.addEventListener("pointermove", (event) => held && this.touch(place, stage.toWorld(event), false));
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, () => { held = false; if (this.painted) { this.painted = false; this.sync(); } });
    canvas.addEventListener("keydown", (event) => {
      if (event.key === " ") { event.preventDefault(); $("play").click(); }
      if (event.key === "Enter") { const seen = place.run.sample(); const i = 0; this.touch(place, [place.run.cell.fields.x[i], place.run.cell.fields.y[i]], true); }
    });
  }

  touch(place, [x, y], first) {
    const { run } = place;
    if (run.status !== "running") return;
    if (this.tool === "release" || this.tool === "push") {
      if (!first) return;
      run.poke(this.tool, x, y);
      return;
    }
    const kind = this.tool === "island" ? "islands" : "pillars", radius = this.tool === "island" ? 1 : 0.35;
    const last = run.setup[kind].at(-1);
    if (!first && last && Math.hypot(x - last[0], y - last[1]) < 0.6 * radius) return;
    if (!run.paint(kind, [x, y, radius])) this.notice(`There is room for ${DATA.layout.most_discs} discs of each kind.`);
    this.painted = true;
  }

  wipe() {
    this.run.wipe();
    this.sync();
  }

  outlineActive() {
    this.places.forEach((place, k) => place.element.classList.toggle("active", k === this.active));
  }

  pair(on) {
    const second = this.places[1];
    second.element.hidden = !on;
    $("stages").classList.toggle("pair", on);
    this.active = 0;
    if (on) {
      const other = this.run.latest.r_on < 40 ? { r_on: 44, zeta_1: 560 } : {};
      this.again();
      second.run = new Run(this.module, { ...this.run.setup, parameters: { ...this.run.latest, ...other } });
      second.named = 0;
      second.element.querySelector(".law").textContent = this.places[0].element.querySelector(".law").textContent;
      second.stage.center = null;
      this.active = 1;
    }
    this.outlineActive();
    this.fresh = true;
    this.sync();
  }

  shelf() {
    for (const preset of DATA.presets) {
      const button = document.createElement("button");
      button.type = "button";
      button.dataset.key = preset.key;
      button.innerHTML = `<canvas aria-hidden="true"></canvas><b><svg viewBox="-12 -12 24 24" aria-hidden="true">${preset.mode ? symbol(preset.mode) : ""}</svg>${preset.title}</b><small>${preset.words}</small>`;
      button.onclick = () => { this.open(preset.link); this.run.preset = preset.key; this.sync(); };
      $("shelf").append(button);
      requestAnimationFrame(() => thumbnail(button.querySelector("canvas"), preset));
    }
  }

  cards() {
    if (!DATA.cards.length) $("cards").hidden = true;
    for (const card of DATA.cards) {
      const element = document.createElement("div");
      element.className = "card";
      element.innerHTML = `<h3>${card.title}</h3><p>${card.task}</p><details><summary>What to expect</summary><p>${card.expect}</p></details><button type="button">Set it up</button>`;
      element.querySelector("button").onclick = () => this.open(card.link);
      $("deck").append(element);
    }
  }

  open(link) {
    this.left = true;
    const given = read(link);
    for (const name of ["field", "camera"]) if (link.includes(`${name}=`)) this.view[name] = given.view[name];
    this.notice("");
    this.playing = true;
    this.load(given.setup);
    document.querySelector(".stage").scrollIntoView({ block: "nearest", behavior: "smooth" });
  }

  take(what, button) {
    if (this.run.recorded && ["link", "python", "embed"].includes(what)) return this.notice("This is a saved run, played back: its own file tells how it was made, and no link does.");
    const link = location.href.split("#")[0] + write(this.run.setup, { ...this.view, to: Math.round(this.run.now * 10) / 10 });
    const text = { link: () => link, python: () => python(this.run), embed: () => embed(location.href.split("#")[0], write(this.run.setup, { ...this.view, view: $("level").value, to: 0 }), $("level").value) }[what];
    if (text) {
      const box = $("taken");
      box.hidden = false;
      box.value = text();
      box.rows = Math.min(16, box.value.split("\n").length + 1);
      box.select();
      navigator.clipboard?.writeText(box.value).then(() => this.flash(button, "Copied"), () => {});
    } else if (what === "png") png(this.place, this.run, save);
    else if (what === "csv") save(new Blob([csv(this.run)], { type: "text/csv" }), "cell.csv");
    else this.clip = clip(this.place.canvas, button, (words) => this.notice(words)) ?? this.clip;
  }

  flash(button, words) {
    const kept = button.textContent;
    button.textContent = words;
    setTimeout(() => (button.textContent = kept), 1200);
  }
}

async function begin() {
  const given = read(location.hash || DATA.begin || "");
  document.getElementById("version").textContent = DATA.version ?? "";
  let module;
  try {
    module = await loadModule();
  } catch (error) {
    document.body.classList.remove("loading");
    document.body.classList.add("still", given.view.view);
    $("notice").hidden = false;
    $("notice").textContent = `${error.message} The page needs a browser of 2023 or newer with WebAssembly and its SIMD part: Chromium 91, Firefox 113 or Safari 16.4 do. The picture is of a cell computed before: its way, and its edge now and then.`;
    const { r_on, zeta_1 } = given.setup.parameters;
    const near = (preset) => Math.hypot((preset.point[0] - r_on) / 50, (preset.point[1] - zeta_1) / 100);
    const [nearest] = DATA.presets.filter((preset) => preset.point).sort((a, b) => near(a) - near(b));
    const canvas = document.querySelector("canvas.cell");
    thumbnail(canvas, nearest);
    canvas.setAttribute("aria-label", `The way of a cell at binding rate ${nearest.point[0]}, adhesive friction ${nearest.point[1]}: ${nearest.words}`);
    return;
  }
  window.page = new Page(module, given);
}

begin();
