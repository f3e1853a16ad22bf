// A run: a cell from its start on, what is done to it, and what has been seen of it.

import { Cell, ENDS, FIELDS, NEVER, POINTS } from "./cell.js";
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

// Numbers of a law as its class has them unless given.
export function usual(law = "paper") {
  return Object.fromEntries(Object.entries(DATA.laws[law].numbers).map(([name, { usual: value }]) => [`laws.${name}`, value]));
}

// Why a law cannot be used with some parameters, or "".
export function complaint(law, parameters) {
  const limit = (parameters.r_p * Math.log(parameters.r_p)) / Math.max(parameters.sigma_c, 1e-300); // v_p / sigma_c
  if (law === "swept-myosin" && parameters["laws.sweep"] >= limit)
    return `A sweep of ${limit.toPrecision(3)} or more gathers motors faster than the bonds can hold them: the forces have no one balance.`;
  return "";
}

export const STATUS = {
  running: "",
  fragmented: "The edge has crossed itself: the cell tears here, and the model says nothing about what follows.",
  out_of_range: "No bond force balances the pull any more: the edge is too concave for its tension, which the model does not cover.",
  unresolved: "The edge has more detail than the solver can follow at this tolerance.",
  step_too_small: "The solver's step has shrunk to nothing: try another seed or other parameters.",
  played: "The saved run ends here.",
  refused: "Under these laws the forces have no one balance at such numbers.",
  no_rest: "Under these laws no circle is at rest: no force on the bonds makes the network flow back as fast as it grows. Another value, or another law, has one.",
  failed: "The solver has failed: try another seed or other parameters.",
};

export class Run {
  constructor(module, setup) {
    if (module) this.cell = new Cell(module, { rtol: setup.rtol ?? 1e-4, law: setup.law ?? "paper" });
    this.begin(setup);
  }

  begin(setup) {
    this.setup = {
      law: setup.law ?? "paper",
      parameters: { ...PARAMETERS, ...usual(setup.law), ...setup.parameters },
      seed: setup.seed ?? 1,
      rtol: setup.rtol ?? 1e-4,
      events: (setup.events ?? []).map(({ at, to = at, set }) => ({ at, to, set: { ...set } })),
      islands: (setup.islands ?? []).map((disc) => [...disc]),
      pillars: (setup.pillars ?? []).map((disc) => [...disc]),
      pokes: (setup.pokes ?? []).map((poke) => ({ ...poke })).sort((a, b) => a.at - b.at),
    };
    this._clear();
    this.cell.paint(this.setup);
    const failed = complaint(this.setup.law, this.parameters) ? "refused" : this.cell.begin(this.parameters, this.setup.seed);
    if (!failed) return this._record(0);
    this._end(failed, 0);
    const { x, y } = this.cell.fields;
    for (let i = 0; i < POINTS; i++) [x[i], y[i]] = [Math.cos((2 * Math.PI * i) / POINTS), Math.sin((2 * Math.PI * i) / POINTS)];
  }

  _clear() {
    this.parameters = { ...this.setup.parameters };
    this.status = "running";
    this.ended = 0; // when
    this.ramping = null; // the event on its way
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

  // Change parameters as soon as can be said in a schedule, at once or evenly over some time.
  change(values, over = 0) {
    const waiting = this.setup.events[this.done];
    if (waiting) return Object.assign(waiting.set, values);
    const at = Math.max(this._soon(), this.ramping?.to ?? 0);
    this.setup.events.push({ at, to: at + over, set: { ...values } });
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

  // A disc of ground, there from now on, or from the start where nothing has been computed.
  paint(kind, disc) {
    const discs = this.setup[kind];
    if (discs.length >= DATA.layout.most_discs) return false;
    const rounded = disc.map((value) => Math.round(value * 100) / 100);
    discs.push(this.now > 0 ? [...rounded, this._soon()] : rounded);
    this._ground();
    return true;
  }

  wipe() {
    const end = this._soon();
    for (const kind of ["islands", "pillars"])
      if (this.now > 0) this.setup[kind] = this.setup[kind].map(([x, y, radius, begin = -NEVER, old = Infinity]) => [x, y, radius, begin, Math.min(old, Math.max(end, begin))]);
      else this.setup[kind] = [];
    this._ground();
  }

  _ground() {
    if (this.status !== "running") return;
    if (this.now === 0) return this.begin(this.setup);
    this.cell.paint(this.setup);
  }

  // Discs of a kind that are there at the end of all changes, as discs of a fresh run.
  lasting(kind) {
    return this.setup[kind].filter((disc) => disc.length < 5).map((disc) => disc.slice(0, 3));
  }

  _soon() {
    return Math.ceil(Math.max(this.cell.earliest, this.now) * 1000 + 1e-6) / 1000;
  }

  get latest() {
    return Object.assign({}, this.parameters, this.ramping?.set, ...this.setup.events.slice(this.done).map((event) => event.set));
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
      const turn = this.ramping ? this.ramping.to : event?.at; // when the parameters change next
      if (poke && poke.at - cell.time < 0.11) {
        cell.pulse({ ...DATA.pulses[poke.kind], x: poke.x, y: poke.y, at: poke.at });
        this.poked += 1;
        this.changed = poke.at;
        continue;
      }
      if (cell.time >= next && !(turn <= next)) return "";
      const stop = Math.min(next, poke ? poke.at - 0.105 : Infinity);
      const changes = turn <= stop, goal = changes ? turn : stop;
      const code = goal > cell.time ? cell.advance(goal, turn) : 0;
      if (code) return ENDS[code] ?? "failed";
      if (changes) this._turn(event, turn);
      else if (stop >= next) return "";
    }
  }

  // A change is due: a jump, or the begin or end of a ramp.
  _turn(event, time) {
    const { cell } = this;
    if (!this.ramping) {
      this.done += 1;
      if (event.to > event.at) {
        this.ramping = event;
        cell.change(this.parameters, event);
        return;
      }
    }
    Object.assign(this.parameters, (this.ramping ?? event).set);
    this.ramping = null;
    this.changed = time;
    cell.set(this.parameters);
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
      } else this.valid = { at: time, cell: this.cell.checkpoint(), done: this.done, poked: this.poked, ramping: this.ramping, parameters: { ...this.parameters } };
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
      Object.assign(this, { done: this.valid.done, poked: this.valid.poked, ramping: this.valid.ramping, parameters: { ...this.valid.parameters } });
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
    const turns = [...this.setup.islands, ...this.setup.pillars].flatMap((disc) => disc.slice(3)).filter((time) => time <= this.now);
    const since = Math.max(this.changed, ...turns);
    const used = this.indices(WINDOW).filter((k) => recent.t[k] >= since);
    if (used.length < 12) return (this.mode = { mode: "", confidence: 0, words: "too early to tell" });
    const pick = (name) => Float64Array.from(used, (k) => recent[name][k]);
    const areas = pick("area").sort();
    const radius = Math.sqrt(areas[areas.length >> 1] / Math.PI);
    this.mode = classify(pick("t"), pick("x"), pick("y"), radius, since);
    return this.mode;
  }

  sample() {
    if (!this.count) return { time: 0, tension: NaN, length: 2 * Math.PI, area: Math.PI, x: 0, y: 0, simple: true };
    return this.cell.sample(Math.min(this.now, this.cell.time));
  }
}

export { FIELDS, POINTS };
