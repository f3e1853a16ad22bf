// Colours of fields: the package's maps and limits, so that a picture here reads as one there.

import { DATA } from "./data.js";

export const SCALES = {
  bound_fraction: { name: "bound fraction", symbol: "n", map: "viridis", low: 0.1, high: 0.8, ticks: [0.1, 0.8] },
  off_rate: { name: "off-rate", symbol: "r", map: "magma", low: 2, high: 120, log: true, ticks: [2, 120], kind: "rate" },
  friction: { name: "friction", symbol: "f", map: "cividis", low: 400, high: 1400, ticks: [400, 1400], kind: "friction" },
  curvature: { name: "curvature", symbol: "κ", map: "PuOr_r", low: -20, high: 20, symlog: true, ticks: [-20, 0, 20], kind: "curvature" },
  normal_velocity: { name: "velocity outwards", symbol: "U", map: "RdBu_r", low: -0.5, high: 0.5, ticks: [-0.5, 0, 0.5], kind: "velocity" },
};

const tables = {};

export function table(map) {
  // 256 colours as [r, g, b]
  if (tables[map]) return tables[map];
  const stops = DATA.colours[map].match(/.{6}/g).map((hex) => [0, 2, 4].map((k) => parseInt(hex.slice(k, k + 2), 16)));
  const found = [];
  for (let k = 0; k < 256; k++) {
    const at = (k / 255) * (stops.length - 1);
    const i = Math.min(Math.floor(at), stops.length - 2);
    found.push(stops[i].map((v, c) => Math.round(v + (stops[i + 1][c] - v) * (at - i))));
  }
  return (tables[map] = found);
}

function symlog(v) {
  const a = Math.abs(v);
  return Math.sign(v) * (a <= 1 ? a : 1 + Math.log10(a));
}

export function level(field, value) {
  // 0 to 255
  const { low, high, log, symlog: bent } = SCALES[field];
  const shape = log ? (v) => Math.log(Math.max(v, 1e-9)) : bent ? symlog : (v) => v;
  const part = (shape(value) - shape(low)) / (shape(high) - shape(low));
  return Math.round(255 * Math.min(1, Math.max(0, part)));
}

export const css = ([r, g, b], alpha = 1) => (alpha === 1 ? `rgb(${r} ${g} ${b})` : `rgb(${r} ${g} ${b} / ${alpha})`);

export const MODE_COLOURS = {
  gliding: "#0072b2", rotational: "#d55e00", zigzag: "#009e73", other: "#e6a8c8",
  stationary: "#bdbdbd", fragmented: "#222222",
};
export const MODE_MARKERS = {
  gliding: "circle", rotational: "triangle", zigzag: "diamond", other: "square",
  stationary: "circle", fragmented: "cross",
};

export function marker(context, kind, x, y, size) {
  context.beginPath();
  if (kind === "circle") context.arc(x, y, size, 0, 2 * Math.PI);
  else if (kind === "square") context.rect(x - 0.9 * size, y - 0.9 * size, 1.8 * size, 1.8 * size);
  else if (kind === "diamond") polygon(context, [[x, y - 1.25 * size], [x + 1.25 * size, y], [x, y + 1.25 * size], [x - 1.25 * size, y]]);
  else if (kind === "triangle") polygon(context, [[x, y - 1.2 * size], [x + 1.1 * size, y + 0.9 * size], [x - 1.1 * size, y + 0.9 * size]]);
  else {
    const a = 0.35 * size, b = 1.1 * size;
    polygon(context, [[-b, -b + a], [-a, 0], [-b, b - a], [-b + a, b], [0, a], [b - a, b], [b, b - a], [a, 0], [b, -b + a], [b - a, -b], [0, -a], [-b + a, -b]].map(([u, v]) => [x + u, y + v]));
  }
}

function polygon(context, points) {
  points.forEach(([x, y], k) => (k ? context.lineTo(x, y) : context.moveTo(x, y)));
  context.closePath();
}
