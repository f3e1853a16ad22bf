// The picture of one cell: ground, track, outline coloured by a field.

import { NEVER, POINTS } from "./cell.js";
import { DATA } from "./data.js";
import { SCALES, css, level, table } from "./colours.js";
import { scaled, shown, digits, unit } from "./units.js";

const INK = "#222222", TRACK = "#b5338a", BODY = "#f1f1f1", GROUND = "#c9a86a", WALL = "#6f6f6f";

const APPEARS = DATA.layout.appears; // time over which a disc comes or goes
const swell = (u) => { const v = Math.min(Math.max(u, 0), 1); return v * v * (3 - 2 * v); };

export function fit(canvas) {
  // Give a canvas as many pixels as the screen has there; returns its context and size.
  const ratio = Math.min(window.devicePixelRatio || 1, 2.5);
  const { clientWidth: width, clientHeight: height } = canvas;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return { context, width, height };
}

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    this.field = "bound_fraction";
    this.camera = "follow";
    this.showTrack = true;
    this.center = null;
    this.scale = 60;
  }

  toWorld(event) {
    const box = this.canvas.getBoundingClientRect();
    return [
      this.center[0] + (event.clientX - box.left - box.width / 2) / this.scale,
      this.center[1] - (event.clientY - box.top - box.height / 2) / this.scale,
    ];
  }

  place(run, seen, width, height, jump) {
    // Move the camera: with the cell, or so that its whole way is in sight.
    let [x, y] = [seen.x, seen.y], scale = Math.min(width, height) / 6.4;
    if (this.camera === "whole") {
      const { track } = run;
      let low = [seen.x - 1.6, seen.y - 1.6], high = [seen.x + 1.6, seen.y + 1.6];
      for (let k = 0; k < track.x.length; k++) {
        low = [Math.min(low[0], track.x[k] - 1.6), Math.min(low[1], track.y[k] - 1.6)];
        high = [Math.max(high[0], track.x[k] + 1.6), Math.max(high[1], track.y[k] + 1.6)];
      }
      [x, y] = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
      scale = Math.min(scale, width / (high[0] - low[0]), (height - 70) / (high[1] - low[1]));
    } else if (this.camera === "fixed") [x, y] = this.center ?? [x, y];
    const part = jump || !this.center ? 1 : 0.18;
    this.center = this.center ? [this.center[0] + (x - this.center[0]) * part, this.center[1] + (y - this.center[1]) * part] : [x, y];
    this.scale += (scale - this.scale) * (jump ? 1 : 0.1);
  }

  draw(run, { jump = false } = {}) {
    const { context, width, height } = fit(this.canvas);
    if (!width || !height) return;
    const seen = run.sample();
    this.place(run, seen, width, height, jump);
    const [cx, cy] = this.center, s = this.scale;
    const X = (x) => width / 2 + (x - cx) * s, Y = (y) => height / 2 - (y - cy) * s;
    context.fillStyle = "#fcfcfb";
    context.fillRect(0, 0, width, height);
    this._dots(context, width, height, X, Y);
    this._ground(context, run.setup, run.now, X, Y);
    if (this.showTrack) this._track(context, run, seen, X, Y);
    this._cell(context, run.cell.fields, X, Y);
    this._pokes(context, run.setup.pokes, run.now, X, Y);
    this._scaleBar(context, width, height);
  }

  _pokes(context, pokes, now, X, Y) {
    for (const { kind, at, x, y } of pokes) {
      if (now > at + 0.9 || now < at - 1) continue;
      const part = Math.max(0, (now - at) / 0.9);
      context.beginPath();
      context.arc(X(x), Y(y), this.scale * (kind === "push" ? 0.6 - 0.4 * part : 0.2 + 0.4 * part), 0, 2 * Math.PI);
      context.strokeStyle = css([213, 94, 0], 0.9 - 0.7 * part);
      context.lineWidth = 3;
      context.stroke();
    }
  }

  _dots(context, width, height, X, Y) {
    const s = this.scale, step = s > 14 ? 1 : s > 3 ? 5 : 20;
    const [cx, cy] = this.center;
    context.fillStyle = "#d9d9d4";
    const first = (c, span) => Math.ceil((c - span / 2 / s) / step) * step;
    for (let x = first(cx, width); x < cx + width / 2 / s; x += step)
      for (let y = first(cy, height); y < cy + height / 2 / s; y += step)
        context.fillRect(X(x) - 1, Y(y) - 1, 2, 2);
  }

  _ground(context, { islands, pillars }, now, X, Y) {
    const s = this.scale;
    const disc = ([x, y, r, begin = -NEVER, end = NEVER]) => {
      // as large as what the cell feels of it
      const part = swell((now - begin) / APPEARS) * (1 - swell((now - end) / APPEARS));
      context.moveTo(X(x) + r * part * s, Y(y));
      context.arc(X(x), Y(y), r * part * s, 0, 2 * Math.PI);
    };
    if (islands.length) {
      context.save();
      context.beginPath();
      islands.forEach(disc);
      context.fillStyle = GROUND;
      context.globalAlpha = 0.38;
      context.fill("nonzero");
      context.restore();
    }
    context.fillStyle = WALL;
    context.beginPath();
    pillars.forEach(disc);
    context.fill("nonzero");
  }

  _track(context, run, seen, X, Y) {
    const { track, ghosts } = run, size = track.x.length;
    context.lineJoin = context.lineCap = "round";
    context.strokeStyle = css([120, 120, 120], 0.28);
    context.lineWidth = 1;
    for (const ghost of ghosts) {
      if (run.now - ghost.time < 2) continue;
      outline(context, ghost.x, ghost.y, X, Y);
      context.stroke();
    }
    const chunks = 12, each = Math.max(1, Math.ceil(size / chunks));
    context.lineWidth = 2;
    for (let first = 0; first < size; first += each) {
      const last = Math.min(first + each, size - 1);
      context.strokeStyle = TRACK;
      context.globalAlpha = 0.3 + (0.7 * last) / Math.max(size - 1, 1);
      context.beginPath();
      context.moveTo(X(track.x[first]), Y(track.y[first]));
      for (let k = first + 1; k <= last; k++) context.lineTo(X(track.x[k]), Y(track.y[k]));
      if (last === size - 1) context.lineTo(X(seen.x), Y(seen.y));
      context.stroke();
    }
    context.globalAlpha = 1;
  }

  _cell(context, fields, X, Y) {
    const { x, y } = fields, values = fields[this.field], colours = table(SCALES[this.field].map);
    outline(context, x, y, X, Y);
    context.fillStyle = BODY;
    context.globalAlpha = 0.82;
    context.fill();
    context.globalAlpha = 1;
    const thick = Math.max(3, Math.min(9, this.scale * 0.085));
    context.lineJoin = "round";
    context.lineCap = "round";
    context.strokeStyle = "#8c8c8c";
    context.lineWidth = thick + 1.6;
    context.stroke();
    context.lineWidth = thick;
    context.lineCap = "butt";
    for (let i = 0; i < POINTS; ) {
      // one stroke for as long as the colour stays
      const colour = level(this.field, values[i]) & ~1;
      context.beginPath();
      context.moveTo(X(x[i]), Y(y[i]));
      let k = i + 1;
      for (; k <= POINTS; k++) {
        context.lineTo(X(x[k % POINTS]), Y(y[k % POINTS]));
        if (k < POINTS && (level(this.field, values[k]) & ~1) !== colour) break;
      }
      const after = Math.min(k, POINTS), ahead = (after + 1) % POINTS, here = after % POINTS;
      context.lineTo(X(x[here] + 0.2 * (x[ahead] - x[here])), Y(y[here] + 0.2 * (y[ahead] - y[here])));
      context.strokeStyle = css(colours[colour]);
      context.stroke();
      i = after;
    }
  }

  _scaleBar(context, width, height) {
    const s = this.scale, names = [0.5, 1, 2, 5, 10, 20, 50, 100];
    const size = names.find((n) => n * s > 46) ?? 100;
    context.fillStyle = INK;
    context.fillRect(16, height - 18, size * s, 3);
    context.font = "12px system-ui, sans-serif";
    context.textAlign = "left";
    const name = unit("length") ? `${digits(scaled(size, "length"))} µm` : `${size} R₀`;
    context.fillText(name, 16, height - 25);
  }
}

function outline(context, x, y, X, Y) {
  context.beginPath();
  context.moveTo(X(x[0]), Y(y[0]));
  for (let i = 1; i < x.length; i++) context.lineTo(X(x[i]), Y(y[i]));
  context.closePath();
}

export function colourBar(canvas, field) {
  const { context, width, height } = fit(canvas);
  if (!width) return;
  const { map, symbol, ticks, kind, name } = SCALES[field], colours = table(map);
  context.clearRect(0, 0, width, height);
  const top = 17, thick = 9;
  for (let k = 0; k < width; k++) {
    context.fillStyle = css(colours[Math.round((255 * k) / Math.max(width - 1, 1))]);
    context.fillRect(k, top, 1.5, thick);
  }
  context.fillStyle = INK;
  context.font = "12px system-ui, sans-serif";
  context.textAlign = "left";
  context.fillText(`${name} ${symbol}${unit(kind) ? ` (${unit(kind)})` : ""}`, 0, 11);
  ticks.forEach((tick) => {
    const at = (level(field, tick) / 255) * width;
    context.textAlign = at < 5 ? "left" : at > width - 5 ? "right" : "center";
    context.fillText(digits(scaled(tick, kind), 2), at, top + thick + 13);
  });
}
