// A run: a cell from its start on, what is done to it, and what has been seen of it.

import { Cell, FIELDS, POINTS } from "./cell.js";
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
  failed: "The solver has failed: try another seed or other parameters.",
};

export class Run {
  constructor(module, setup) {
    this.cell = new Cell(module, { rtol: setup.rtol ?? 1e-4 });
    this.begin(setup);
  }

  begin(setup) {
    this.setup = {
      parameters: { ...PARAMETERS, ...setup.parameters },
      seed: setup.seed ?? 1,
      rtol: setup.rtol ?? 1e-4,
      events: (setup.events ?? []).map((event) => ({ at: event.at, set: { ...event.set } })),
    };
    this.parameters = { ...this.setup.parameters };
    this.status = "running";
    this.now = 0;
    this.count = 0; // records so far
    this.changed = 0; // time of the last change
    this.done = 0; // events done
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
    try {
      this.cell.begin(this.parameters, this.setup.seed);
    } catch (error) {
      return this._end("failed");
    }
    this._record(0);
  }

  // Parameters change as soon as the solver can land on a time for it; returns that time.
  change(values) {
    const at = Math.ceil((Math.max(this.cell.time + this.cell.control[2], this.now)) * 1000 + 1e-6) / 1000;
    const waiting = this.setup.events[this.done];
    if (waiting) Object.assign(waiting.set, values);
    else this.setup.events.push({ at, set: { ...values } });
    return at;
  }

  get latest() {
    const waiting = this.setup.events.slice(this.done);
    return Object.assign({}, this.parameters, ...waiting.map((event) => event.set));
  }

  // Go on to a time, or as far as the deadline (of performance.now) allows.
  advance(target, deadline = Infinity) {
    while (this.status === "running" && this.now < target) {
      const record = this.count * EVERY;
      const next = Math.min(record, target);
      if (!this._step(next)) break;
      this.now = next;
      if (next === record) this._record(next);
      if (performance.now() > deadline) break;
    }
    return this.now;
  }

  _step(next) {
    while (this.done < this.setup.events.length && this.setup.events[this.done].at <= Math.max(next, this.cell.time)) {
      const event = this.setup.events[this.done];
      if (event.at > this.cell.time && this._failed(this.cell.advance(event.at, event.at))) return false;
      Object.assign(this.parameters, event.set);
      this.cell.set(this.parameters);
      this.changed = event.at;
      this.done += 1;
    }
    return !(next > this.cell.time && this._failed(this.cell.advance(next, this.setup.events[this.done]?.at)));
  }

  _failed(code) {
    if (!code) return false;
    const names = { 5: "out_of_range", 6: "step_too_small", 7: "unresolved", 100: "out_of_range" };
    this._end(names[code] ?? "failed");
    return true;
  }

  _end(status) {
    this.status = status;
    if (status === "fragmented") this.mode = { mode: "fragmented", confidence: 1, words: "it tore" };
  }

  _record(time) {
    const seen = this.cell.sample(time);
    if (!seen.simple && this.cell.crosses()) this._end("fragmented");
    const { recent, cell } = this, k = this.count % KEPT, before = (this.count + KEPT - 1) % KEPT;
    for (const name of ["tension", "length", "area", "x", "y"]) recent[name][k] = seen[name];
    recent.t[k] = time;
    recent.speed[k] = this.count ? Math.hypot(seen.x - recent.x[before], seen.y - recent.y[before]) / EVERY : 0;
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
    this.mode = classify(pick("t"), pick("x"), pick("y"), radius);
    return this.mode;
  }

  sample() {
    return this.cell.sample(Math.min(this.now, this.cell.time));
  }
}

export { FIELDS, POINTS };
