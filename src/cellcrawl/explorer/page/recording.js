// A saved run played back: a run whose cell has been computed before.

import { DATA } from "./data.js";
import { FIELDS, POINTS, PARAMETERS, Run } from "./run.js";

function unpacked({ low, span, data }) {
  const bytes = Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0));
  return Float32Array.from(new Uint16Array(bytes.buffer), (value) => low + (value / 65535) * span);
}

export class Recording extends Run {
  constructor() {
    super(null, null);
  }

  begin() {
    const kept = DATA.run;
    this.kept = kept;
    this.recorded = true;
    this.frames = Object.fromEntries(Object.entries(kept.fields).map(([name, packed]) => [name, unpacked(packed)]));
    this.cell = { fields: Object.fromEntries(FIELDS.map((name) => [name, new Float64Array(POINTS)])), time: 0 };
    this.setup = { law: "paper", parameters: { ...PARAMETERS, ...kept.parameters }, seed: 1, rtol: 1e-4, events: [], islands: [], pillars: [], pokes: [] };
    this._clear();
    this.frame = -1;
    this.now = kept.t[0];
    this._show(0);
  }

  _show(frame) {
    const { kept, cell } = this;
    for (const [name, values] of Object.entries(this.frames)) {
      const about = name === "x" ? kept.centroid_x[frame] : name === "y" ? kept.centroid_y[frame] : 0;
      for (let i = 0; i < POINTS; i++) cell.fields[name][i] = about + values[frame * POINTS + i];
    }
    this.seen = { time: kept.t[frame], x: kept.centroid_x[frame], y: kept.centroid_y[frame], tension: kept.tension[frame], length: kept.length[frame], area: kept.area[frame], simple: true };
    cell.time = kept.t[frame];
    if (frame > this.frame) this._keep(kept.t[frame], this.seen);
    this.frame = frame;
  }

  advance(target) {
    const { t } = this.kept;
    while (this.frame + 1 < t.length && t[this.frame + 1] <= target) this._show(this.frame + 1);
    this.now = Math.min(target, t[t.length - 1]);
    if (this.frame === t.length - 1 && this.status === "running") this.status = this.kept.status === "fragmented" ? "fragmented" : "played";
    return this.now;
  }

  sample() { return this.seen; }
  change() { return null; }
  poke() { return null; }
  paint() { return true; }

  name() {
    const { mode, confidence, words } = this.kept;
    return (this.mode = { mode, confidence, words });
  }
}
