// Numbers with or without physical units, by the package's scales.

import { DATA } from "./data.js";

const { length, time, retrograde_velocity, viscous_friction } = DATA.scales;
const friction = viscous_friction * retrograde_velocity;
const KINDS = {
  time: [time, "s", 1], length: [length, "µm", 1e6], velocity: [length / time, "µm/s", 1e6],
  tension: [0.5 * friction, "µN/m", 1e6], friction: [friction, "µN/m", 1e6], rate: [1 / time, "1/s", 1],
  curvature: [1 / length, "1/µm", 1e-6],
};

let physical = false;
export const usePhysical = (on) => (physical = on);
export const isPhysical = () => physical;

export function digits(value, count = 3) {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.floor(Math.log10(Math.abs(value)));
  const text = value.toFixed(Math.max(0, Math.min(count - 1 - size, 6)));
  return text.replace("-", "−");
}

export function scaled(value, kind) {
  const entry = KINDS[kind];
  return physical && entry ? value * entry[0] * entry[2] : value;
}

export function unit(kind) {
  const entry = KINDS[kind];
  return physical && entry ? entry[1] : "";
}

export function shown(value, kind, count = 3) {
  const name = unit(kind);
  return digits(scaled(value, kind), count) + (name ? ` ${name}` : "");
}

export function clock(value) {
  if (!physical) return `t = ${value.toFixed(1)}`;
  const seconds = value * time, minutes = Math.floor(seconds / 60);
  return minutes >= 60 ? `${Math.floor(minutes / 60)} h ${minutes % 60} min` : minutes ? `${minutes} min ${Math.floor(seconds % 60)} s` : `${Math.floor(seconds)} s`;
}
