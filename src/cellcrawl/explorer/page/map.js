// The phase diagram as the control: drag the dot and the cell follows.

import { DATA } from "./data.js";
import { MODE_COLOURS, MODE_MARKERS, css, marker, table } from "./colours.js";
import { fit } from "./stage.js";

const M = DATA.map;
export const RANGE = { r_on: M.r_on, zeta_1: M.zeta_1 };
const EDGES = { left: 58, right: 12, top: 10, bottom: 34 };

export class PhaseMap {
  constructor(canvas, onMove) {
    this.canvas = canvas;
    this.dots = []; // {r_on, zeta_1, label, active}
    this.picture = this._shading();
    const move = (event) => {
      event.preventDefault();
      const box = canvas.getBoundingClientRect();
      onMove(this.valuesAt(event.clientX - box.left, event.clientY - box.top));
    };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      canvas.focus({ preventScroll: true });
      move(event);
    });
    canvas.addEventListener("pointermove", (event) => canvas.hasPointerCapture(event.pointerId) && move(event));
    canvas.addEventListener("keydown", (event) => {
      const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
      if (!steps) return;
      event.preventDefault();
      const active = this.dots.find((dot) => dot.active) ?? this.dots[0];
      const fine = event.shiftKey ? 5 : 1;
      onMove(this.clipped(active.r_on + steps[0] * 0.5 * fine, active.zeta_1 + steps[1] * 2 * fine));
    });
  }

  get box() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    return { x: EDGES.left, y: EDGES.top, w: width - EDGES.left - EDGES.right, h: height - EDGES.top - EDGES.bottom };
  }

  valuesAt(px, py) {
    const { x, y, w, h } = this.box;
    const [a, b] = RANGE.r_on, [c, d] = RANGE.zeta_1;
    return this.clipped(a + ((px - x) / w) * (b - a), d - ((py - y) / h) * (d - c));
  }

  clipped(r_on, zeta_1) {
    const clip = (value, [low, high], step) => Math.round(Math.min(high, Math.max(low, value)) / step) * step;
    return { r_on: clip(r_on, RANGE.r_on, 0.1), zeta_1: clip(zeta_1, RANGE.zeta_1, 1) };
  }

  _shading() {
    // growth rate of the first mode, by linear theory of the package
    const [columns, rows] = M.shape;
    const canvas = document.createElement("canvas");
    canvas.width = columns;
    canvas.height = rows;
    const context = canvas.getContext("2d"), image = context.createImageData(columns, rows);
    for (let k = 0; k < M.growth.length; k++) {
      const row = Math.floor(k / columns), at = 4 * ((rows - 1 - row) * columns + (k % columns));
      const rate = M.growth[k];
      const part = Math.max(-1, Math.min(1, rate / M.largest));
      // grey where the round cell is stable, warmer the faster it breaks its symmetry
      const colour = part <= 0.002 ? [226, 226, 224] : [253 - 14 * part, 249 - 60 * part, 240 - 126 * part];
      colour.forEach((value, c) => (image.data[at + c] = value));
      image.data[at + 3] = 255;
    }
    context.putImageData(image, 0, 0);
    return canvas;
  }

  draw() {
    const { context, width, height } = fit(this.canvas);
    if (!width) return;
    const { x, y, w, h } = this.box;
    const [a, b] = RANGE.r_on, [c, d] = RANGE.zeta_1;
    const X = (r) => x + ((r - a) / (b - a)) * w, Y = (z) => y + ((d - z) / (d - c)) * h;
    context.clearRect(0, 0, width, height);
    context.imageSmoothingEnabled = true;
    context.drawImage(this.picture, x, y, w, h);
    context.save();
    context.beginPath();
    context.rect(x, y, w, h);
    context.clip();
    context.lineWidth = 0.8;
    for (const [r, z, mode] of M.modes) {
      marker(context, MODE_MARKERS[mode], X(r), Y(z), Math.max(3, w / 95));
      context.fillStyle = MODE_COLOURS[mode];
      context.globalAlpha = 0.85;
      context.fill();
      context.globalAlpha = 1;
    }
    for (const [r, z] of DATA.presets.filter((p) => p.point).map((p) => p.point)) {
      context.beginPath();
      context.arc(X(r), Y(z), Math.max(6, w / 48), 0, 2 * Math.PI);
      context.strokeStyle = "#222222";
      context.lineWidth = 1.1;
      context.stroke();
    }
    context.strokeStyle = "#555";
    context.lineWidth = 1.2;
    context.setLineDash([5, 3]);
    for (const branch of M.marginal) {
      context.beginPath();
      branch.forEach(([r, z], k) => (k ? context.lineTo(X(r), Y(z)) : context.moveTo(X(r), Y(z))));
      context.stroke();
    }
    context.setLineDash([]);
    context.restore();
    context.strokeStyle = "#8c8c8c";
    context.lineWidth = 1;
    context.strokeRect(x + 0.5, y + 0.5, w - 1, h - 1);
    this._axes(context, X, Y);
    for (const dot of this.dots) this._dot(context, X(dot.r_on), Y(dot.zeta_1), dot);
  }

  _axes(context, X, Y) {
    const { x, y, w, h } = this.box;
    context.fillStyle = "#222222";
    context.font = "12px system-ui, sans-serif";
    context.textAlign = "center";
    for (let r = Math.ceil(RANGE.r_on[0] / 10) * 10; r <= RANGE.r_on[1]; r += 10) {
      context.fillRect(X(r) - 0.5, y + h, 1, 4);
      context.fillText(String(r), X(r), y + h + 16);
    }
    context.fillText("binding rate r_on".replace("r_on", "rₒₙ"), x + w / 2, y + h + 31);
    context.textAlign = "right";
    for (let z = Math.ceil(RANGE.zeta_1[0] / 20) * 20; z <= RANGE.zeta_1[1]; z += 20) {
      context.fillRect(x - 4, Y(z) - 0.5, 4, 1);
      context.fillText(String(z), x - 7, Y(z) + 4);
    }
    context.save();
    context.translate(13, y + h / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = "center";
    context.fillText("adhesive friction ζ₁", 0, 0);
    context.restore();
  }

  _dot(context, px, py, dot) {
    context.beginPath();
    context.arc(px, py, dot.active ? 9 : 8, 0, 2 * Math.PI);
    context.fillStyle = dot.active ? "#b5338a" : "#ffffff";
    context.fill();
    context.lineWidth = 2.4;
    context.strokeStyle = dot.active ? "#ffffff" : "#b5338a";
    context.stroke();
    context.lineWidth = 1;
    context.strokeStyle = "#222222";
    context.beginPath();
    context.arc(px, py, dot.active ? 10.5 : 9.5, 0, 2 * Math.PI);
    context.stroke();
    if (dot.label) {
      context.fillStyle = dot.active ? "#ffffff" : "#b5338a";
      context.font = "bold 11px system-ui, sans-serif";
      context.textAlign = "center";
      context.fillText(dot.label, px, py + 4);
    }
  }
}
