// One cell: the package's solver, compiled to WebAssembly, and the memory it works in.
//
// What `AdaptiveSolver` does in Python is done here: it lays out the arrays and calls the kernels.

import { uniform } from "./random.js";
import { DATA } from "./data.js";

const L = DATA.layout;
const CODES = L.codes;
const PAGE = 65536;
const STACK = 1 << 17;
const ROOM = 1 << 20; // for arrays that kernels make while they run
const MODES = 100; // of the paper's random start
const AMPLITUDE = 1e-4;
const LONGEST_STEP = 0.1;

export const POINTS = 256; // of an outline
export const FIELDS = ["x", "y", "theta", "curvature", "bound_fraction", "off_rate", "normal_velocity", "friction"];
export const NEVER = 1e12; // as the package has it for a disc without begin and end
export const ENDS = { [CODES.no_rest]: "no_rest", [CODES.unresolved_start]: "unresolved", [CODES.no_root]: "out_of_range", [CODES.broken]: "out_of_range", [CODES.step_too_small]: "step_too_small", [CODES.unresolved]: "unresolved" };

function derived({ r_on, zeta_1, r_p, sigma_c, h, k_sigma, epsilon, elasticity }, y) {
  // as `Parameters` has them, operation by operation; y is log r_p
  const n_bar = r_on / (r_on + r_p);
  const sigma_bar = (r_p * y + zeta_1 * n_bar * y - sigma_c) / (1 + h);
  return { n_bar, sigma_bar, v_p: r_p * y, tension_rate: elasticity === "consistent" ? k_sigma / epsilon : k_sigma };
}

export class Cell {
  constructor(module, { rtol = 1e-4, law = "paper" } = {}) {
    this.rtol = rtol;
    this.law = law;
    this.kernelName = law.replaceAll("-", "_");
    this.rows = L.rows[law];
    const rows = this.rows.length + 1; // and the rate of the tension law
    this.tolerance = 0.002 * rtol;
    this.allowed = Math.max(3 * rtol * Math.min(1, (1e-4 / rtol) ** 0.3), 1e-9);
    const span = L.most_nodes + 2 * L.halo, size = L.fields * span + L.scalars;
    const numbers = { // how many at most
      ret: 2, exception: 2, control: L.controls, counters: L.counters, whole: 16, profile: rows,
      out: FIELDS.length * POINTS, edgeOut: (rows + 1) * POINTS, localOut: rows * POINTS + L.motion, data: L.ground.length,
      amplitudes: 4 * MODES, theta: L.most_nodes, bound: L.most_nodes,
      table: L.table_rows * size, spareTable: L.table_rows * size, y: L.most_nodes, spareY: L.most_nodes,
      edge: rows * L.most_nodes, mesh: L.mesh_rows * span, work: L.work_rows * span, matrix: L.matrix_rows * L.most_nodes,
      local: rows * L.most_nodes + L.motion, room: L.trace_rows * span, state: size, trace: L.trace_rows * span,
    };
    this.at = {};
    let next = STACK;
    for (const [name, count] of Object.entries(numbers)) {
      this.at[name] = next;
      next += (8 * count + 63) & ~63;
    }
    const pages = Math.ceil((next + ROOM) / PAGE);
    this.memory = new WebAssembly.Memory({ initial: pages, maximum: pages });
    const stack = new WebAssembly.Global({ value: "i32", mutable: true }, STACK);
    this.kernels = new WebAssembly.Instance(module, { env: { __linear_memory: this.memory, __stack_pointer: stack } }).exports;
    this.kernels.heap(next, next + ROOM);
    const view = (name, count) => new Float64Array(this.memory.buffer, this.at[name], count);
    this.control = view("control", L.controls);
    this.counters = new BigInt64Array(this.memory.buffer, this.at.counters, L.counters);
    this.whole = view("whole", 16);
    this.profile = view("profile", rows);
    this.data = view("data", L.ground.length);
    this.data.set(L.ground);
    this.code = new Int32Array(this.memory.buffer, this.at.ret, 1);
    this.fields = Object.fromEntries(FIELDS.map((name, row) => [name, new Float64Array(this.memory.buffer, this.at.out + 8 * row * POINTS, POINTS)]));
    this.onGround = false;
    this.ramp = null; // {at, to, from, set}: parameters on their way
    this.nodes = 0;
  }

  _numbers(name, count) {
    return new Float64Array(this.memory.buffer, this.at[name], count);
  }

  _call(name, ...given) {
    if (this.kernels[name](this.at.ret, this.at.exception, ...given)) throw new Error(`the kernel ${name} failed`);
    return this.code[0];
  }

  _places(...names) {
    return names.map((name) => this.at[name]);
  }

  get _suffix() {
    return `_${this.kernelName}${this.onGround || this.law !== "paper" ? "_on_ground" : ""}`;
  }

  // Make the arrays that work on so many nodes needs anew; the state is not touched.
  _makeRoom(nodes) {
    const span = nodes + 2 * L.halo, size = L.fields * span + L.scalars, rows = this.rows.length + 1;
    this.nodes = nodes;
    this.size = size;
    for (const [name, count] of [["table", L.table_rows * size], ["y", nodes], ["edge", rows * nodes], ["mesh", L.mesh_rows * span], ["work", L.work_rows * span], ["matrix", L.matrix_rows * nodes]])
      this._numbers(name, count).fill(0);
    this.control[L.factored] = 0;
  }

  // Returns "" or why there is no such cell.
  begin(parameters, seed) {
    const amplitudes = this._numbers("amplitudes", 4 * MODES), draw = uniform(seed, 4 * MODES);
    let origin = 0;
    for (let k = 0; k < draw.length; k++) amplitudes[k] = AMPLITUDE * draw[k];
    for (let k = MODES - 1; k >= 0; k--) origin += amplitudes[4 * k];
    this.control.fill(0);
    this.counters.fill(0n);
    this.ramp = null;
    this._fill(parameters);
    const y = this._logarithm(parameters.r_p);
    let { n_bar, sigma_bar } = derived(parameters, y);
    if (this.law !== "paper") {
      const code = this._call(`rest_${this.kernelName}`, ...this._places("profile", "whole"));
      if (code) return ENDS[code];
      [n_bar, sigma_bar] = this.whole;
    }
    let count = this.rtol >= 1e-5 ? 1024 : 4096;
    let nodes = this._call("start", MODES, count, n_bar, this.allowed, ...this._places("amplitudes", "theta", "bound", "whole"));
    if (nodes === count) {
      count = 2 * count > L.most_nodes ? count / 2 : 2 * count;
      nodes = this._call("start", MODES, count, n_bar, this.allowed, ...this._places("amplitudes", "theta", "bound", "whole"));
    }
    if (nodes === CODES.unresolved_start) return ENDS[nodes];
    this._makeRoom(nodes);
    const table = this._numbers("table", this.size);
    table.set([this.whole[0], sigma_bar, this.whole[1], 1 + origin, 0], this.size - L.scalars);
    this._call("settle", nodes, count, ...this._places("theta", "bound", "table", "work"));
    this._numbers("y", nodes).fill(y);
    this.set(parameters);
    return ENDS[this.advance(0)] ?? "";
  }

  // Parameters from now on.
  set(parameters) {
    this.ramp = null;
    this._fill(parameters);
    this.counters[L.restarting] = 1n;
  }

  // Parameters that go evenly from what they are to others, from one time to another.
  change(from, { at, to, set }) {
    this.ramp = { at, to, from: { ...from }, set };
    this.counters[L.restarting] = 1n;
  }

  // Browsers' own logarithms differ in their last bits.
  _logarithm(x) {
    this._call("logarithm", x, this.at.whole);
    return this.whole[0];
  }

  _fill(parameters) {
    const values = { ...parameters, ...derived(parameters, this._logarithm(parameters.r_p)), pressure: 0 };
    this.rows.forEach((name, row) => (this.profile[row] = values[name] ?? values[`laws.${name}`]));
    this.profile[this.rows.length] = values.tension_rate;
  }

  // Parameters at a time of a ramp, as `Schedule` has them.
  _fillAt(time) {
    const { at, to, from, set } = this.ramp, values = { ...from };
    for (const [name, end] of Object.entries(set)) {
      const begin = from[name], between = begin + (end - begin) * ((time - at) / (to - at));
      values[name] = time >= to ? end : Math.min(Math.max(between, Math.min(begin, end)), Math.max(begin, end));
    }
    this._fill(values);
  }

  get time() { return this.control[L.time]; }
  get steps() { return Number(this.counters[L.steps]); }

  // The earliest time for a change that leaves all steps before it as if it had been known.
  get earliest() { return this.time + LONGEST_STEP; }

  // Go on until the last step reaches the target, and not beyond the end, where something changes.
  advance(target, end = Infinity) {
    for (;;) {
      let code;
      if (!this.ramp) code = this._advance(target, end, 0);
      else if (this.counters[L.restarting]) {
        this._fillAt(this.time);
        code = this._advance(this.time, end, 1);
        if (code === 0 && this.time < target) continue;
      } else {
        if (this.time >= target) return 0;
        this._call("next_time", this.at.control, end, this.at.whole);
        this._fillAt(this.whole[0]);
        code = this._advance(target, end, 1);
      }
      if (code === CODES.ramping) continue;
      if (code === CODES.at_break || code === 0) return 0;
      if (code < CODES.move) return code;
      this._move(code - CODES.move);
    }
  }

  _advance(target, end, ramping) {
    return this._call(`advance${this._suffix}`, this.nodes, target, end, ramping, this.tolerance, this.allowed,
      ...this._places("control", "counters", "table", "y", "profile", "edge", "mesh", "matrix", "work", "data", "local", "room"));
  }

  _move(nodes) {
    const old = this.nodes;
    if (this.ramp) this._fillAt(this.time);
    for (const [name, spare] of [["table", "spareTable"], ["y", "spareY"]]) [this.at[name], this.at[spare]] = [this.at[spare], this.at[name]];
    this._makeRoom(nodes);
    this._call(`move${this._suffix}`, old, nodes, ...this._places("control", "counters", "spareTable", "spareY", "table", "y", "profile", "edge", "mesh", "matrix", "work", "data", "local", "room"));
  }

  // Fill `fields` with the cell at a time within the last step, and return it as a whole.
  sample(time) {
    const steps = (time - this.time) / this.control[L.step], w = this.whole;
    if (this.ramp) this._fillAt(time);
    this._call(`frame${this._suffix}`, this.nodes, POINTS, time, steps, ...this._places("counters", "table", "y", "profile", "state", "trace", "edgeOut", "out", "whole", "data", "localOut"));
    return { time, tension: w[0], length: w[1], area: w[2], x: w[3], y: w[4], simple: w[7] > L.clearly };
  }

  crosses() {
    return this._call("crossing", POINTS, this.at.out, this.at.out + 8 * POINTS) >= 0;
  }

  // Discs of the ground by kind: [x, y, radius, begin, end] each, the last two where they have them.
  paint(ground) {
    for (const [kind, count] of Object.entries(L.discs)) {
      const discs = ground[kind].slice(0, L.most_discs);
      this.data[count] = discs.length;
      discs.forEach((disc, k) => this.data.set([...disc, ...[-NEVER, NEVER].slice(disc.length - 3)], count + 1 + 5 * k));
    }
    this.onGround ||= Object.keys(L.discs).some((kind) => ground[kind].length);
  }

  // A pulse of the package's kind: where, from when, and what it does.
  pulse({ x, y, at, radius, duration, binding = 1, push = 0 }) {
    const first = this.data.length - 7;
    this.data.set([x, y, radius, at, duration, binding, push], first);
    this.onGround = true;
  }

  // What `restore` needs to go back to this moment.
  checkpoint() {
    const kept = { nodes: this.nodes, control: this.control.slice(), counters: this.counters.slice(), data: this.data.slice(), profile: this.profile.slice(), onGround: this.onGround, ramp: this.ramp };
    kept.table = this._numbers("table", L.differences * this.size).slice();
    kept.y = this._numbers("y", this.nodes).slice();
    kept.matrix = this._numbers("matrix", L.matrix_rows * this.nodes).slice();
    return kept;
  }

  restore(kept) {
    this._makeRoom(kept.nodes);
    for (const name of ["control", "counters", "data", "profile"]) this[name].set(kept[name]);
    this._numbers("table", kept.table.length).set(kept.table);
    this._numbers("y", kept.nodes).set(kept.y);
    this._numbers("matrix", kept.matrix.length).set(kept.matrix);
    this.onGround = kept.onGround;
    this.ramp = kept.ramp;
  }
}
