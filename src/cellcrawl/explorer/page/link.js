// A link holds a whole run in its fragment: what a newer page adds, an older one leaves alone.

import { DATA } from "./data.js";
import { PARAMETERS, usual } from "./run.js";
import { LIMITS } from "./limits.js";

export const VERSION = 2; // laws, ramps and times of discs came with 2; links without are written as 1
const VIEWS = ["full", "small", "bare"];
const FIELDS = ["bound_fraction", "off_rate", "friction", "curvature", "normal_velocity"];
const CAMERAS = ["follow", "whole", "fixed"];
const number = (value) => String(Number(value.toPrecision(15)));

export function write(setup, view) {
  const law = setup.law ?? "paper", timed = [setup.islands, setup.pillars].some((discs) => discs?.some((disc) => disc.length > 3));
  const parts = [`v=${law !== "paper" || timed || setup.events.some((event) => event.to > event.at) ? VERSION : 1}`];
  if (law !== "paper") parts.push(`law=${law}`, ...Object.keys(usual(law)).map((name) => `${name}=${number(setup.parameters[name])}`));
  for (const [name, usual] of Object.entries(PARAMETERS))
    if (setup.parameters[name] !== usual || name === "r_on" || name === "zeta_1")
      parts.push(`${name}=${typeof usual === "number" ? number(setup.parameters[name]) : setup.parameters[name]}`);
  parts.push(`seed=${setup.seed}`);
  if (setup.rtol !== 1e-4) parts.push(`rtol=${number(setup.rtol)}`);
  if (setup.events.length)
    parts.push(`changes=${setup.events.map((event) => [event.to > event.at ? `${number(event.at)}~${number(event.to)}` : number(event.at), ...Object.entries(event.set).map(([name, value]) => `${name}:${number(value)}`)].join(",")).join(";")}`);
  for (const kind of ["islands", "pillars"])
    if (setup[kind]?.length) parts.push(`${kind}=${setup[kind].map((disc) => disc.map(number).join(",")).join(";")}`);
  if (setup.pokes?.length) parts.push(`pokes=${setup.pokes.map((poke) => [poke.kind, ...[poke.at, poke.x, poke.y].map(number)].join(",")).join(";")}`);
  if (view.to > 0) parts.push(`to=${number(view.to)}`);
  for (const [name, usual] of [["field", "bound_fraction"], ["camera", "follow"], ["speed", 5], ["view", "full"], ["units", "none"], ["paused", false]])
    if (view[name] !== undefined && view[name] !== usual) parts.push(`${name}=${view[name]}`);
  return `#${parts.join("&")}`;
}

// Returns {setup, view, complaints}: what cannot be read is left out, and said.
export function read(fragment) {
  const complaints = [];
  const given = {};
  for (const part of fragment.replace(/^#/, "").split("&").filter(Boolean)) {
    const [name, ...rest] = part.split("=");
    try {
      given[name] = decodeURIComponent(rest.join("="));
    } catch {
      complaints.push(`“${part.slice(0, 40)}” cannot be read`);
    }
  }
  const version = given.v === undefined ? VERSION : Number(given.v);
  if (!(version >= 1)) complaints.push(`the link's version “${String(given.v).slice(0, 20)}” is unknown`);
  else if (version > VERSION) complaints.push("the link comes from a newer page: what this one does not know is left out");
  const setup = { law: "paper", parameters: { ...PARAMETERS }, seed: 1, rtol: 1e-4, events: [], islands: [], pillars: [], pokes: [] };
  const view = { field: "bound_fraction", camera: "follow", speed: 5, view: "full", units: "none", paused: false, to: 0 };
  const limited = (name, text) => {
    const value = Number(text), [low, high] = LIMITS[name];
    if (text.trim() === "" || !Number.isFinite(value)) return complaints.push(`${name} = “${text.slice(0, 20)}” is no number`), null;
    if (value < low || value > high) {
      complaints.push(`${name} = ${text.slice(0, 20)} is out of range: from ${low} to ${high}`);
      return Math.min(high, Math.max(low, value));
    }
    return value;
  };
  for (const name of Object.keys(PARAMETERS)) {
    if (given[name] === undefined) continue;
    if (name === "elasticity") {
      if (["printed", "consistent"].includes(given[name])) setup.parameters.elasticity = given[name];
      else complaints.push("elasticity is “printed” or “consistent”");
    } else setup.parameters[name] = limited(name, given[name]) ?? setup.parameters[name];
  }
  if (given.law !== undefined) {
    if (Object.hasOwn(DATA.laws, given.law)) setup.law = given.law;
    else complaints.push(`there is no law “${given.law.slice(0, 20)}” here: the paper's holds`);
  }
  const numbers = usual(setup.law);
  for (const [name, value] of Object.entries(numbers)) setup.parameters[name] = given[name] === undefined ? value : limited(name, given[name]) ?? value;
  if (given.seed !== undefined) {
    if (/^\d{1,15}$/.test(given.seed)) setup.seed = Number(given.seed);
    else complaints.push(`seed = “${given.seed.slice(0, 20)}” is no whole number of up to 15 digits`);
  }
  if (given.rtol !== undefined) setup.rtol = limited("rtol", given.rtol) ?? setup.rtol;
  for (const text of split(given.changes)) {
    const [times, ...sets] = text.split(","), [begin, end = begin] = times.split("~");
    const event = { at: limited("time", begin), to: limited("time", end), set: {} };
    for (const set of sets) {
      const [name, value] = set.split(":");
      if (!(Object.hasOwn(PARAMETERS, name) || Object.hasOwn(numbers, name)) || name === "elasticity") complaints.push(`a change of “${String(name).slice(0, 20)}” is unknown`);
      else event.set[name] = limited(name, value ?? "") ?? setup.parameters[name];
    }
    if (event.at !== null && event.to !== null && Object.keys(event.set).length) setup.events.push({ ...event, to: Math.max(event.at, event.to) });
  }
  setup.events.sort((a, b) => a.at - b.at);
  setup.events = setup.events.filter(({ at }, k, events) => {
    const free = k === 0 || at >= events[k - 1].to;
    if (!free) complaints.push(`a change at ${at} comes before that at ${events[k - 1].at} has ended`);
    return free;
  });
  for (const kind of ["islands", "pillars"])
    for (const text of split(given[kind]).slice(0, LIMITS.discs)) {
      const disc = text.split(",").map(Number);
      if (disc.length >= 3 && disc.length <= 5 && disc.every(Number.isFinite) && disc[2] > 0.02 && disc[2] <= 50) setup[kind].push(disc);
      else complaints.push(`a disc of ${kind} cannot be read: x,y,radius, and perhaps begin and end`);
    }
  for (const text of split(given.pokes).slice(0, 200)) {
    const [kind, ...rest] = text.split(","), [at, x, y] = rest.map(Number);
    if (["release", "push"].includes(kind) && [at, x, y].every(Number.isFinite)) setup.pokes.push({ kind, at, x, y });
    else complaints.push("a poke cannot be read: kind,time,x,y");
  }
  const choose = (name, allowed) => {
    if (given[name] === undefined) return;
    if (allowed.includes(given[name])) view[name] = given[name];
    else complaints.push(`${name} is one of ${allowed.join(", ")}`);
  };
  choose("field", FIELDS);
  choose("camera", CAMERAS);
  choose("view", VIEWS);
  choose("units", ["none", "si"]);
  if (given.speed !== undefined) view.speed = limited("speed", given.speed) ?? 5;
  if (given.to !== undefined) view.to = limited("to", given.to) ?? 0;
  view.paused = given.paused === "true";
  const known = new Set([...Object.keys(PARAMETERS), ...Object.keys(numbers), "v", "law", "seed", "rtol", "changes", "islands", "pillars", "pokes", "field", "camera", "view", "units", "speed", "to", "paused", "b"]);
  const unknown = Object.keys(given).filter((name) => !known.has(name));
  if (unknown.length && version <= VERSION) complaints.push(`unknown in the link: ${unknown.map((name) => name.slice(0, 20)).slice(0, 3).join(", ")}`);
  return { setup, view, complaints };
}

function split(text) {
  return text ? text.split(";").filter(Boolean) : [];
}
