// What runs below the cell: tension and speed against time, and the edge unrolled against time.

import { RINGS } from "./run.js";
import { SCALES, css, level, table } from "./colours.js";
import { fit } from "./stage.js";
import { digits, scaled, unit } from "./units.js";

const LEFT = 52, RIGHT = 8;
export const SPAN = 40; // time shown

export function line(canvas, run, name, { colour, label, kind, low = null }) {
  const { context, width, height } = fit(canvas);
  if (!width) return;
  context.clearRect(0, 0, width, height);
  const { recent } = run, end = Math.max(run.now, SPAN), first = end - SPAN;
  const used = run.indices().filter((k) => recent.t[k] >= first - 0.2);
  let least = low ?? Infinity, most = -Infinity;
  for (const k of used) {
    least = Math.min(least, recent[name][k]);
    most = Math.max(most, recent[name][k]);
  }
  if (!(most > least)) [least, most] = [least - 1, Math.max(most, least) + 1];
  const spare = 0.08 * (most - least), top = 18, bottom = height - 6;
  [least, most] = [low === null ? least - spare : low, most + spare];
  const X = (t) => LEFT + ((t - first) / SPAN) * (width - LEFT - RIGHT);
  const Y = (v) => bottom - ((v - least) / (most - least)) * (bottom - top);
  frame(context, width, height, label, kind, top, bottom);
  context.textAlign = "right";
  context.fillStyle = "#555";
  context.fillText(digits(scaled(most, kind), 3), LEFT - 6, top + 8);
  context.fillText(digits(scaled(least, kind), 3), LEFT - 6, bottom);
  context.strokeStyle = colour;
  context.lineWidth = 1.6;
  context.lineJoin = "round";
  context.beginPath();
  used.forEach((k, i) => (i ? context.lineTo(X(recent.t[k]), Y(recent[name][k])) : context.moveTo(X(recent.t[k]), Y(recent[name][k]))));
  context.save();
  context.beginPath();
  context.rect(LEFT, 0, width - LEFT - RIGHT, height);
  context.clip();
  context.beginPath();
  used.forEach((k, i) => (i ? context.lineTo(X(recent.t[k]), Y(recent[name][k])) : context.moveTo(X(recent.t[k]), Y(recent[name][k]))));
  context.stroke();
  context.restore();
}

function frame(context, width, height, label, kind, top, bottom) {
  context.font = "12px system-ui, sans-serif";
  context.textAlign = "left";
  context.fillStyle = "#222222";
  context.fillText(label + (unit(kind) ? ` (${unit(kind)})` : ""), LEFT, 12);
  context.strokeStyle = "#d0d0cc";
  context.lineWidth = 1;
  context.strokeRect(LEFT - 0.5, top - 0.5, width - LEFT - RIGHT + 1, bottom - top + 1);
}

// An image with one column a record, kept and scrolled rather than drawn anew.
export class Kymograph {
  constructor(canvas, field, label) {
    this.canvas = canvas;
    this.field = field;
    this.label = label;
    this.columns = SPAN * 10;
    this.image = document.createElement("canvas");
    this.image.width = this.columns;
    this.image.height = RINGS;
    this.reset();
  }

  reset() {
    this.drawn = 0;
    this.image.getContext("2d").clearRect(0, 0, this.columns, RINGS);
  }

  _fill(run) {
    const context = this.image.getContext("2d");
    if (run.count < this.drawn) this.reset();
    const first = Math.max(this.drawn, run.count - Math.min(this.columns, run.recent.t.length));
    if (first >= run.count) return;
    const colours = table(SCALES[this.field].map), size = run.recent.t.length;
    for (let count = first; count < run.count; count++) {
      const column = context.createImageData(1, RINGS), k = (count % size) * RINGS;
      for (let i = 0; i < RINGS; i++) {
        const colour = colours[level(this.field, run.recent[this.field][k + i])];
        column.data.set([...colour, 255], 4 * (RINGS - 1 - i));
      }
      context.putImageData(column, count % this.columns, 0);
    }
    this.drawn = run.count;
  }

  draw(run) {
    const { context, width, height } = fit(this.canvas);
    if (!width) return;
    this._fill(run);
    context.clearRect(0, 0, width, height);
    const top = 18, bottom = height - 6, w = width - LEFT - RIGHT, h = bottom - top;
    frame(context, width, height, this.label, "", top, bottom);
    context.fillStyle = "#555";
    context.textAlign = "right";
    context.fillText("1", LEFT - 6, top + 8);
    context.fillText("s/L", LEFT - 6, (top + bottom) / 2 + 4);
    context.fillText("0", LEFT - 6, bottom);
    context.imageSmoothingEnabled = false;
    const { columns, image } = this, count = run.count;
    if (count <= columns) context.drawImage(image, 0, 0, Math.max(count, 1), RINGS, LEFT, top, (w * count) / columns, h);
    else {
      const split = count % columns, part = (w * (columns - split)) / columns;
      context.drawImage(image, split, 0, columns - split, RINGS, LEFT, top, part, h);
      if (split) context.drawImage(image, 0, 0, split, RINGS, LEFT + part, top, w - part, h);
    }
  }
}
