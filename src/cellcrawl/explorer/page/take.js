// What can be taken home: code, pictures, numbers, a clip.

import { NEVER, POINTS } from "./cell.js";
import { DATA } from "./data.js";
import { PARAMETERS } from "./run.js";

const plain = (value) => (Number.isInteger(value) && Math.abs(value) < 1e15 ? `${value}.0` : String(value));

export function save(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 5000);
}

// The changes of a run as the package's Schedule has them: jumps at times, and ramps.
export function schedule(setup) {
  const points = {};
  const now = { ...setup.parameters };
  for (const event of setup.events)
    for (const [name, value] of Object.entries(event.set)) {
      (points[name] ??= []).push([event.at, now[name]], [event.to ?? event.at, value]);
      now[name] = value;
    }
  return points;
}

const row = (values) => `[${values.map(plain).join(", ")}]`;

// What surrounds the cell, as lines of Python.
function surroundings({ islands, pillars, pokes }) {
  const discs = (kind, rows) => {
    const timed = rows.some((disc) => disc.length > 3);
    const whole = timed ? rows.map((disc) => [...disc, ...[-NEVER, NEVER].slice(disc.length - 3)]) : rows;
    return rows.length ? [`    cc.surroundings.${kind}([`, ...whole.map((disc) => `        ${row(disc)},`), "    ]),"] : [];
  };
  const pulse = ({ kind, at, x, y }) => `    cc.surroundings.LocalPulse(${Object.entries({ x, y, begin: at, ...DATA.pulses[kind] }).map(([name, value]) => `${name}=${plain(value)}`).join(", ")}),`;
  return [...discs("Islands", islands), ...discs("Pillars", pillars), ...pokes.map(pulse)];
}

export function python(run) {
  const { setup } = run, law = DATA.laws[setup.law];
  const given = Object.entries(setup.parameters).filter(([name, value]) => !name.startsWith("laws.") && (value !== PARAMETERS[name] || name === "r_on" || name === "zeta_1"));
  const lines = [
    "import cellcrawl as cc", "",
    `p = cc.Parameters(${given.map(([name, value]) => `${name}=${typeof value === "string" ? `"${value}"` : value}`).join(", ")})`,
    `options = {"start": cc.RandomPerturbation(seed=${setup.seed})}`,
  ];
  if (setup.law !== "paper") lines.push(`options["laws"] = cc.laws.${law.python}(${Object.keys(law.numbers).map((name) => `${name}=${plain(setup.parameters[`laws.${name}`])}`).join(", ")})`);
  const points = Object.entries(schedule(setup));
  if (points.length) lines.push(`options["schedule"] = cc.Schedule({`, ...points.map(([name, list]) => `    "${name}": [${list.map(([t, v]) => `(${plain(t)}, ${plain(v)})`).join(", ")}],`), "})");
  const around = surroundings(setup);
  if (around.length) lines.push('options["surroundings"] = [', ...around, "]");
  if (setup.rtol !== 1e-4) lines.push(`options["rtol"] = ${setup.rtol}`);
  lines.push(`run = cc.simulate(p, t_end=${plain(Math.max(1, Math.round(run.now * 10) / 10))}, **options)`, "print(cc.classify(run).mode)", 'cc.movie(run, "cell.mp4")');
  return lines.join("\n") + "\n";
}

export function embed(address, fragment, level) {
  const height = { full: 1500, small: 420, bare: 320 }[level];
  return `<iframe src="${address}${fragment.replaceAll("&", "&amp;")}" title="A crawling cell, computed live by cellcrawl" width="100%" height="${height}" style="border:0" loading="lazy" allow="clipboard-write"></iframe>\n`;
}

export function csv(run) {
  const { recent } = run;
  const lines = ["time,point,x,y"];
  for (const k of run.indices(200))
    for (let i = 0; i < POINTS; i++) {
      const at = k * 2 * POINTS + i;
      lines.push(`${recent.t[k].toFixed(4)},${i},${recent.outline[at].toFixed(5)},${recent.outline[at + POINTS].toFixed(5)}`);
    }
  return lines.join("\n") + "\n";
}

export function png(place, run, then) {
  place.canvas.toBlob((blob) => then(blob, `cell-t${run.now.toFixed(1)}.png`), "image/png");
}
