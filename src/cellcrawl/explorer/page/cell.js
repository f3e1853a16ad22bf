// One cell: the package's solver, compiled to WebAssembly, and the memory it works in.

import { uniform } from "./random.js";

const HALO = 8;
const SCALARS = 8;
const PAGES = 160; // of 64 KiB
const STACK = 1 << 17;
const ROOM = 1 << 21; // for arrays that kernels make while they run
export const POINTS = 256; // of an outline
export const ROWS = ["r_on", "zeta_1", "D", "epsilon", "h", "sigma_c", "v_p", "pressure"];
export const FIELDS = ["x", "y", "theta", "curvature", "bound_fraction", "off_rate", "normal_velocity", "friction"];
const TIME = 0, PREVIOUS = 1, STEP = 2, ORDER = 6, STEPS = 0, RESTARTING = 5;
const MODES = 100;
const NODES = 640;

export function derived(parameters) {
  const { r_on, zeta_1, r_p, sigma_c, h, k_sigma, epsilon, elasticity } = parameters;
  const n_bar = r_on / (r_on + r_p);
  const pull = r_p * Math.log(r_p) + zeta_1 * n_bar * Math.log(r_p);
  return {
    n_bar,
    v_p: r_p * Math.log(r_p),
    sigma_bar: (pull - sigma_c) / (1 + h),
    tension_rate: elasticity === "consistent" ? k_sigma / epsilon : k_sigma,
  };
}

export class Cell {
  constructor(module, { rtol = 1e-4 } = {}) {
    this.memory = new WebAssembly.Memory({ initial: PAGES, maximum: PAGES });
    const stack = new WebAssembly.Global({ value: "i32", mutable: true }, STACK);
    const imports = { env: { __linear_memory: this.memory, __stack_pointer: stack } };
    this.kernels = new WebAssembly.Instance(module, imports).exports;
    this.rtol = rtol;
    this._next = STACK;
    this._ret = this._numbers(2);
    this._code = new Int32Array(this.memory.buffer, this._ret.byteOffset, 1);
    this._exception = this._numbers(2);
    this.control = this._numbers(16);
    this.counters = new BigInt64Array(this.memory.buffer, this._numbers(12).byteOffset, 12);
    this.whole = this._numbers(16);
    this.out = this._numbers(FIELDS.length * POINTS);
    this._guess = this._numbers(POINTS);
    this._edgeOut = this._numbers((ROWS.length + 1) * POINTS);
    this._amplitudes = this._numbers(MODES * 4);
    this.fields = Object.fromEntries(
      FIELDS.map((name, row) => [name, this.out.subarray(row * POINTS, (row + 1) * POINTS)]),
    );
    this._free = this._next;
  }

  _numbers(count) {
    const at = (this._next + 15) & ~15;
    this._next = at + 8 * count;
    return new Float64Array(this.memory.buffer, at, count);
  }

  _call(name, ...given) {
    const plain = given.map((value) => (typeof value === "number" ? value : value.byteOffset));
    const failed = this.kernels[name](this._ret.byteOffset, this._exception.byteOffset, ...plain);
    if (failed) throw new Error(`the kernel ${name} failed`);
    return this._code[0];
  }

  begin(parameters, seed) {
    const nodes = NODES, span = nodes + 2 * HALO, size = 3 * span + SCALARS;
    this.nodes = nodes;
    this._next = this._free;
    this.table = this._numbers(14 * size);
    this.y = this._numbers(nodes);
    this.edge = this._numbers((ROWS.length + 1) * nodes);
    this.mesh = this._numbers(6 * span);
    this.work = this._numbers(6 * span);
    this.matrix = this._numbers(24 * nodes);
    this._state = this._numbers(size);
    this._trace = this._numbers(6 * span);
    const theta = this._numbers(2 * nodes), bound = this._numbers(2 * nodes);
    this.kernels.heap((this._next + 63) & ~63, ((this._next + 63) & ~63) + ROOM);
    const { n_bar, sigma_bar } = derived(parameters);
    const draw = uniform(seed, 4 * MODES);
    for (let k = 0; k < draw.length; k++) this._amplitudes[k] = 1e-4 * draw[k];
    this._call("start", MODES, 2 * nodes, n_bar, this._amplitudes, theta, bound, this.whole);
    this.table.fill(0);
    this.control.fill(0);
    this.counters.fill(0n);
    for (let i = 0; i < nodes; i++) {
      this.table[HALO + i] = theta[2 * i] - (2 * Math.PI * i) / nodes;
      this.table[span + HALO + i] = bound[2 * i + 1];
      this.table[2 * span + HALO + i] = 1;
    }
    let origin = 1;
    for (let k = 0; k < MODES; k++) origin += this._amplitudes[4 * k];
    this.table.set([this.whole[0], sigma_bar, this.whole[1], origin, 0], 3 * span);
    this.y.fill(Math.log(parameters.r_p));
    this.set(parameters);
  }

  set(parameters) {
    const values = { ...parameters, ...derived(parameters), pressure: 0 };
    [...ROWS, "tension_rate"].forEach((name, row) => {
      this.edge.fill(values[name], row * this.nodes, (row + 1) * this.nodes);
      this._edgeOut.fill(values[name], row * POINTS, (row + 1) * POINTS);
    });
    this.counters[RESTARTING] = 1n;
  }

  get time() { return this.control[TIME]; }
  get steps() { return Number(this.counters[STEPS]); }

  advance(target, end = Infinity) {
    return this._call("advance", this.nodes, target, this.rtol, this.control, this.counters,
      this.table, this.y, this.edge, this.mesh, this.work, this.matrix);
  }

  sample(time) {
    const steps = (time - this.time) / this.control[STEP];
    this._call("frame", this.nodes, POINTS, steps, this.control, this.counters, this.table, this.y,
      this._edgeOut, this._state, this._trace, this._guess, this.out, this.whole);
    const w = this.whole;
    return { time, length: w[0], tension: w[1], area: w[8], x: w[9], y: w[10], simple: w[13] > 0.1 };
  }

  crosses() {
    return this._call("crossing", POINTS, this.fields.x, this.fields.y) >= 0;
  }
}
