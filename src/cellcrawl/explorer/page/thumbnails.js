// Small pictures of the presets: the way of the cell and its outline, computed by the package.

import { fit } from "./stage.js";

export function thumbnail(canvas, preset) {
  const picture = preset.picture;
  const { context, width, height } = fit(canvas);
  if (!width || !picture) return;
  const { track, outlines } = picture;
  const points = [...track, ...outlines.flat()];
  const low = [0, 1].map((c) => Math.min(...points.map((p) => p[c]))), high = [0, 1].map((c) => Math.max(...points.map((p) => p[c])));
  const scale = Math.min((width - 10) / (high[0] - low[0]), (height - 10) / (high[1] - low[1]), 24);
  const X = (x) => width / 2 + (x - (low[0] + high[0]) / 2) * scale, Y = (y) => height / 2 - (y - (low[1] + high[1]) / 2) * scale;
  outlines.forEach((outline, k) => {
    context.beginPath();
    outline.forEach(([x, y], i) => (i ? context.lineTo(X(x), Y(y)) : context.moveTo(X(x), Y(y))));
    context.closePath();
    context.fillStyle = k === outlines.length - 1 ? "#f1f1f1" : "transparent";
    context.fill();
    context.strokeStyle = k === outlines.length - 1 ? "#222222" : "#c4c4c0";
    context.lineWidth = k === outlines.length - 1 ? 1.4 : 0.9;
    context.stroke();
  });
  context.beginPath();
  track.forEach(([x, y], i) => (i ? context.lineTo(X(x), Y(y)) : context.moveTo(X(x), Y(y))));
  context.strokeStyle = "#b5338a";
  context.lineWidth = 1.4;
  context.lineJoin = "round";
  context.stroke();
}
