// A run: a cell from its start on, what is done to it, and what has been seen of it.

import { Cell, ENDS, FIELDS, POINTS } from "./cell.js";
import { DATA } from "./data.js";
import { classify } from "./rule.js";

export const EVERY = 0.1; // between two records, as in the package
export const KEPT = 2000; // records with all detail
export const RINGS = 96; // places along the edge in a kymograph
const OUTLINE_EVERY = 10; // records between two ghosts of the outline
const WINDOW = 1000; // records that name the mode
const MOST_TRACK = 6000;

export const PARAMETERS = {
  r_on: 26, zeta_1: 600, D: 0.05, epsilon: 0.001, h: 0.01, sigma_c: 100, k_sigma: 1000, r_p: 50, elasticity: "printed",
};

export const STATUS = {
  running: "",
  fragmented: "The edge has crossed itself: the cell tears here, and the model says nothing about what follows.",
  out_of_range: "No bond force balances the pull any more: the edge is too concave for its tension, which the model does not cover.",
  unresolved: "The edge has more detail than the solver can follow at this tolerance.",
  step_too_small: "The solver's step has shrunk to nothing: try another seed or other parameters.",
  played: "The saved run ends here.",
  failed: "The solver has failed: try another seed or other parameters.",
};

export class Run {
  constructor(module, setup) {
    if (module) this.cell = new Cell(module, { rtol: setup.rtol ?? 1e-4 });
    this.begin(setup);
  }

  begin(setup) {
    this.setup = {
      parameters: { ...PARAMETERS, ...setup.parameters },
      seed: setup.seed ?? 1,
      rtol: setup.rtol ?? 1e-4,
      events: (setup.events ?? []).map((event) => ({ at: event.at, set: { ...event.set } })),
      islands: [...(setup.islands ?? [])],
      pillars: [...(setup.pillars ?? [])],
      pokes: (setup.pokes ?? []).map((poke) => ({ ...poke })).sort((a, b) => a.at - b.at),
    };
    this._clear();
    const { islands, pillars } = this.setup;
    if (islands.length || pillars.length) this.cell.paint(islands, pillars);
    const failed = this.cell.begin(this.parameters, this.setup.seed);
    if (failed) this._end(failed, 0);
    else this._record(0);
  }

  _clear() {
    this.parameters = { ...this.setup.parameters };
    this.status = "running";
    this.ended = 0; // when
    this.exact = true; // whether the setup alone makes this run
    this.now = 0;
    this.count = 0; // records so far
    this.changed = 0; // time of the last change
    this.done = 0; // events done
    this.poked = 0; // pokes begun
    this.track = { t: [], x: [], y: [], every: 1 };
    this.ghosts = [];
    this.recent = {
      t: new Float64Array(KEPT), x: new Float64Array(KEPT), y: new Float64Array(KEPT),
      tension: new Float64Array(KEPT), length: new Float64Array(KEPT), area: new Float64Array(KEPT),
      speed: new Float64Array(KEPT),
      outline: new Float32Array(KEPT * 2 * POINTS),
      bound_fraction: new Float32Array(KEPT * RINGS), curvature: new Float32Array(KEPT * RINGS),
    };
    this.mode = { mode: "", confidence: 0, words: "" };
  }

  // Change parameters as soon as can be said in a schedule; returns when.
  change(values) {
    const waiting = this.setup.events[this.done];
    if (waiting) Object.assign(waiting.set, values);
    else this.setup.events.push({ at: this._soon(), set: { ...values } });
    return this.setup.events.at(-1).at;
  }

  // Touch the edge at a place: "release" or "push".
  poke(kind, x, y) {
    const last = this.setup.pokes.at(-1), after = last ? last.at + DATA.pulses[last.kind].duration : 0;
    const at = Math.max(this._soon(), Math.ceil(after * 1000) / 1000);
    if (at > this.now + 3) return null; // enough are waiting
    const poke = { kind, at, x: Math.round(x * 1000) / 1000, y: Math.round(y * 1000) / 1000 };
    this.setup.pokes.push(poke);
    return poke;
  }

  // Ground painted on the way: the run as it is cannot be had from its setup any more.
  paint(kind, disc) {
    const discs = this.setup[kind];
    if (discs.length >= DATA.layout.most_discs) return false;
    discs.push(disc.map((value) => Math.round(value * 100) / 100));
    this._ground();
    return true;
  }

  wipe() {
    this.setup.islands.length = this.setup.pillars.length = 0;
    this._ground();
  }

  _ground() {
    if (this.status !== "running") return;
    this.exact = this.exact && this.now === 0;
    this.changed = this.now;
    this.cell.paint(this.setup.islands, this.setup.pillars);
  }

  _soon() {
    return Math.ceil(Math.max(this.cell.earliest, this.now) * 1000 + 1e-6) / 1000;
  }

  get latest() {
    return Object.assign({}, this.parameters, ...this.setup.events.slice(this.done).map((event) => event.set));
  }

  // Go on to a time, or as far as the deadline (of performance.now) allows.
  advance(target, deadline = Infinity) {
    while (this.status === "running" && this.now < target) {
      const record = this.count * EVERY, next = Math.min(record, target);
      const failed = this._goTo(next);
      if (failed) {
        this._end(failed, this.cell.time);
        break;
      }
      this.now = next;
      if (next === record) this._record(next);
      if (performance.now() > deadline) break;
    }
    return this.now;
  }

  // Let the solver's last step reach a time; returns why it cannot, or "".
  _goTo(next) {
    const { cell, setup } = this;
    for (;;) {
      const poke = setup.pokes[this.poked], event = setup.events[this.done];
      if (poke && poke.at - cell.time < 0.11) {
        cell.pulse({ ...DATA.pulses[poke.kind], x: poke.x, y: poke.y, at: poke.at });
        this.poked += 1;
        this.changed = poke.at;
        continue;
      }
      if (cell.time >= next && !(event && event.at <= next)) return "";
      const stop = Math.min(next, poke ? poke.at - 0.105 : Infinity);
      if (!event || event.at > stop) {
        const code = stop > cell.time ? cell.advance(stop, event?.at) : 0;
        if (code) return ENDS[code] ?? "failed";
        if (stop < next) continue;
        return "";
      }
      const code = event.at > cell.time ? cell.advance(event.at, event.at) : 0;
      if (code) return ENDS[code] ?? "failed";
      Object.assign(this.parameters, event.set);
      cell.set(this.parameters);
      this.changed = event.at;
      this.done += 1;
    }
  }

  _end(status, time) {
    this.status = status;
    this.ended = time;
    if (status === "fragmented") this.mode = { mode: "fragmented", confidence: 1, words: "it tore" };
  }

  _record(time) {
    let seen = this.cell.sample(time);
    if (!seen.simple) {
      if (this.cell.crosses()) {
        time = this._traceBack(time);
        seen = this.cell.sample(time);
        this.now = time;
      } else this.valid = { at: time, cell: this.cell.checkpoint(), done: this.done, poked: this.poked, parameters: { ...this.parameters } };
    }
    this._keep(time, seen);
  }

  // Narrow down when the edge first crosses itself, as the package does; ends the run there.
  _traceBack(crossed) {
    if (!this.valid || this.valid.at < crossed - 1.5 * EVERY) {
      this._end("fragmented", crossed);
      return crossed;
    }
    const back = () => {
      this.cell.restore(this.valid.cell);
      Object.assign(this, { done: this.valid.done, poked: this.valid.poked, parameters: { ...this.valid.parameters } });
    };
    let good = this.valid.at;
    while (crossed - good > 1e-4) {
      const middle = 0.5 * (good + crossed);
      back();
      const failed = this._goTo(middle), seen = failed ? null : this.cell.sample(middle);
      if (seen && (seen.simple || !this.cell.crosses())) good = middle;
      else crossed = middle;
    }
    back();
    this._goTo(good);
    this._end("fragmented", crossed);
    return good;
  }

  _keep(time, seen) {
    const { recent, cell } = this, k = this.count % KEPT, before = (this.count + KEPT - 1) % KEPT;
    for (const name of ["tension", "length", "area", "x", "y"]) recent[name][k] = seen[name];
    recent.t[k] = time;
    const passed = this.count ? time - recent.t[before] : 0;
    recent.speed[k] = passed > 0 ? Math.hypot(seen.x - recent.x[before], seen.y - recent.y[before]) / passed : 0;
    const at = k * 2 * POINTS;
    recent.outline.set(cell.fields.x, at);
    recent.outline.set(cell.fields.y, at + POINTS);
    for (let i = 0; i < RINGS; i++) {
      const node = Math.floor((i * POINTS) / RINGS);
      recent.bound_fraction[k * RINGS + i] = cell.fields.bound_fraction[node];
      recent.curvature[k * RINGS + i] = cell.fields.curvature[node];
    }
    this._keepTrack(time, seen);
    if (this.count % (OUTLINE_EVERY * 5) === 0) this._keepGhost(time);
    this.count += 1;
  }

  _keepTrack(time, seen) {
    const { track } = this;
    if (this.count % track.every) return;
    track.t.push(time); track.x.push(seen.x); track.y.push(seen.y);
    if (track.t.length > MOST_TRACK) {
      for (const name of ["t", "x", "y"]) track[name] = track[name].filter((_, k) => k % 2 === 0);
      track.every *= 2;
    }
  }

  _keepGhost(time) {
    this.ghosts.push({ time, x: Float32Array.from(this.cell.fields.x), y: Float32Array.from(this.cell.fields.y) });
    if (this.ghosts.length > 40) this.ghosts.splice(0, 1);
  }

  // The last records, oldest first: indices into `recent`.
  indices(most = KEPT) {
    const count = Math.min(this.count, KEPT, most);
    return Array.from({ length: count }, (_, k) => (this.count - count + k) % KEPT);
  }

  name() {
    if (this.status === "fragmented") return this.mode;
    const { recent } = this;
    const used = this.indices(WINDOW).filter((k) => recent.t[k] >= this.changed);
    if (used.length < 12) return (this.mode = { mode: "", confidence: 0, words: "too early to tell" });
    const pick = (name) => Float64Array.from(used, (k) => recent[name][k]);
    const areas = pick("area").sort();
    const radius = Math.sqrt(areas[areas.length >> 1] / Math.PI);
    this.mode = classify(pick("t"), pick("x"), pick("y"), radius, this.changed);
    return this.mode;
  }

  sample() {
    return this.cell.sample(Math.min(this.now, this.cell.time));
  }
}

export { FIELDS, POINTS };
