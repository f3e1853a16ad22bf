// The package's rule on motility modes (cellcrawl.modes), for tracks of runs; a test holds it to that.

import { DATA } from "./data.js";

const RAD = Math.PI / 180;
const RAYLEIGH = 1.17741;
const LATER = [0, 1 / 9, 2 / 9, 3 / 9];
const WORDS = DATA.evidence.words;
const NAMES = DATA.evidence.names;

// --- small arithmetic ---

const sorted = (values) => Float64Array.from(values).sort();
const sum = (values) => { let s = 0; for (const v of values) s += v; return s; };
const mean = (values) => (values.length ? sum(values) / values.length : 0);
const largest = (values) => { let m = -Infinity; for (const v of values) if (v > m) m = v; return m; };
const smallestOf = (values) => { let m = Infinity; for (const v of values) if (v < m) m = v; return m; };
const argmax = (values) => { let at = 0; for (let k = 1; k < values.length; k++) if (values[k] > values[at]) at = k; return at; };
const clip = (v, low, high) => Math.min(Math.max(v, low), high);

function median(values) {
  const s = sorted(values), half = s.length >> 1;
  return s.length % 2 ? s[half] : 0.5 * (s[half - 1] + s[half]);
}

function spread(values) {
  if (values.length < 2) return 0;
  const usual = mean(values);
  const deviation = Math.sqrt(sum(values.map((v) => (v - usual) ** 2)) / (values.length - 1));
  return usual > 0 ? deviation / usual : Infinity;
}

function searchsorted(values, wanted, right = false) {
  let low = 0, high = values.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle] < wanted || (right && values[middle] === wanted)) low = middle + 1;
    else high = middle;
  }
  return low;
}

function interpolate(at, t, values) {
  const found = new Float64Array(at.length);
  let k = 0;
  for (let i = 0; i < at.length; i++) {
    if (at[i] <= t[0]) { found[i] = values[0]; continue; }
    if (at[i] >= t[t.length - 1]) { found[i] = values[values.length - 1]; continue; }
    while (t[k + 1] <= at[i]) k++;
    found[i] = values[k] + ((values[k + 1] - values[k]) / (t[k + 1] - t[k])) * (at[i] - t[k]);
  }
  return found;
}

function even(first, last, size) {
  const step = (last - first) / (size - 1);
  const found = Float64Array.from({ length: size }, (_, k) => k * step + first);
  found[size - 1] = last;
  return found;
}

function slopes(row, step) {
  const n = row.length, found = new Float64Array(n);
  for (let k = 1; k < n - 1; k++) found[k] = (row[k + 1] - row[k - 1]) / (2 * step);
  found[0] = (-1.5 / step) * row[0] + (2 / step) * row[1] + (-0.5 / step) * row[2];
  found[n - 1] = (0.5 / step) * row[n - 3] + (-2 / step) * row[n - 2] + (1.5 / step) * row[n - 1];
  return found;
}

function unwrapped(angle) {
  const found = Float64Array.from(angle);
  let correction = 0;
  for (let k = 1; k < angle.length; k++) {
    const change = angle[k] - angle[k - 1];
    if (Math.abs(change) >= Math.PI) {
      let wrapped = change + Math.PI - 2 * Math.PI * Math.floor((change + Math.PI) / (2 * Math.PI)) - Math.PI;
      if (wrapped === -Math.PI && change > 0) wrapped = Math.PI;
      correction += wrapped - change;
    }
    found[k] += correction;
  }
  return found;
}

const part = (track, kept) => Object.fromEntries(["t", "x", "y"].map((name) => [name, track[name].filter((_, k) => kept[k])]));

// --- records that have no heading ---

function positionNoise({ t, x, y }) {
  if (t.length < 7) return 0;
  const apart = [];
  for (let k = 2; k < t.length - 2; k++) {
    const at = [k - 2, k - 1, k + 1, k + 2];
    let scale = 1, rx = x[k], ry = y[k];
    for (const i of at) {
      let weight = 1;
      for (const j of at) if (j !== i) weight *= (t[k] - t[j]) / (t[i] - t[j]);
      scale += weight * weight;
      rx -= weight * x[i];
      ry -= weight * y[i];
    }
    apart.push(Math.hypot(rx, ry) / Math.sqrt(scale));
  }
  return median(apart) / RAYLEIGH;
}

function wildRecords({ x, y }) {
  const size = x.length;
  if (size < 8) return [];
  const steps = Float64Array.from({ length: size - 1 }, (_, k) => Math.hypot(x[k + 1] - x[k], y[k + 1] - y[k]));
  const ordered = sorted(steps);
  const typical = ordered[((searchsorted(ordered, 0, true) + size) >> 1) - 1];
  if (ordered[size - 2] <= 3 * typical || typical === 0) return [];
  const leaps = [...steps.keys()].filter((k) => steps[k] > 3 * typical), suspects = [];
  for (let k = 1; k < leaps.length; k++) {
    const before = leaps[k - 1], after = leaps[k];
    if (after - before > 3) continue;
    const across = Math.hypot(x[after + 1] - x[before], y[after + 1] - y[before]);
    if (across < 0.5 * Math.min(steps[before], steps[after])) suspects.push([before + 1, after]);
  }
  const off = new Uint8Array(size);
  for (const [first, last] of suspects) off.fill(1, first, last + 1);
  const others = steps.filter((_, k) => !(off[k + 1] | off[k]));
  if (others.length < size >> 1) return [];
  const most = largest(others), found = [];
  for (const [first, last] of suspects)
    if (Math.min(steps[first - 1], steps[last]) > 2.5 * most) for (let k = first; k <= last; k++) found.push(k);
  const near = new Uint8Array(size - 1);
  for (const record of found) near.fill(1, record - 1, record + 1);
  for (const [end, record] of [[0, 0], [size - 2, size - 1]]) {
    const rest = steps.filter((_, k) => !near[k] && k !== end);
    if (!near[end] && steps[end] > 5 * Math.max(0, largest(rest))) found.push(record);
  }
  const unique = [...new Set(found)].sort((a, b) => a - b);
  return found.length && found.length <= 0.1 * size ? unique : [];
}

function runs(flags) {
  // [start, end) of stretches that are true
  const found = [];
  for (let k = 0; k < flags.length; k++)
    if (flags[k] && !(k && flags[k - 1])) {
      let end = k;
      while (end < flags.length && flags[end]) end++;
      found.push([k, end]);
    }
  return found;
}

function withoutRepeats(track) {
  const size = track.t.length;
  const repeats = Array.from({ length: size - 1 }, (_, k) => track.x[k + 1] === track.x[k] && track.y[k + 1] === track.y[k]);
  if (!repeats.includes(true)) return track;
  const kept = [true, ...repeats.map((r) => !r)];
  for (const [start, end] of runs(repeats)) if (end - start >= 2 && end < repeats.length) kept.fill(true, start + 1, end + 1);
  return kept.filter(Boolean).length >= 8 ? part(track, kept) : track;
}

function speedsOf(track, window) {
  const size = track.t.length - window;
  return Float64Array.from({ length: size }, (_, k) => Math.hypot(track.x[k + window] - track.x[k], track.y[k + window] - track.y[k]) / (track.t[k + window] - track.t[k]));
}

const atPace = (speeds) => sorted(speeds)[Math.floor(0.8 * (speeds.length - 1))];

function findPauses(track, noise) {
  const { t, x, y } = track, size = t.length;
  if (size < 8) return [];
  const step = median(Float64Array.from({ length: size - 1 }, (_, k) => t[k + 1] - t[k]));
  let speeds = speedsOf(track, 1), pace = atPace(speeds) * step;
  if (pace === 0) return [];
  const window = Math.max(1, Math.ceil((Math.SQRT2 * noise) / (0.07 * pace)));
  if (window > Math.min(6, size >> 2)) return [];
  if (window > 1) {
    speeds = speedsOf(track, window);
    pace = atPace(speeds) * step;
  }
  const quiet = Array.from(speeds, (speed) => speed < (0.2 * pace) / step);
  const within = 0.5 * pace + 3 * noise, found = [];
  for (const [start, end] of runs(quiet)) {
    let first = start, last = end - 1 + window;
    if (found.length && first <= found[found.length - 1][1]) continue;
    const middle = [mean(x.slice(first, last + 1)), mean(y.slice(first, last + 1))];
    const far = (k) => Math.hypot(x[k] - middle[0], y[k] - middle[1]);
    let farthest = 0;
    for (let k = first; k <= last; k++) farthest = Math.max(farthest, far(k));
    if (last - first < 2 || farthest > within) continue;
    while (first > 0 && far(first - 1) <= 0.5 * within) first -= 1;
    while (last < size - 1 && far(last + 1) <= 0.5 * within) last += 1;
    if (found.length && first <= found[found.length - 1][1] + 1) first = found.pop()[0];
    found.push([first, last]);
  }
  return found;
}

function withoutPauses(track, noise) {
  const pauses = findPauses(track, noise), size = track.t.length;
  if (!pauses.length || size - sum(pauses.map(([first, last]) => last - first)) < 8) return { moving: track, clock: track.t };
  const kept = new Array(size).fill(true);
  const made = { t: track.t.slice(), x: track.x.slice(), y: track.y.slice() };
  const passed = Float64Array.from(track.t, (t, k) => (k ? t - track.t[k - 1] : 0));
  for (const [first, last] of pauses) {
    kept.fill(false, first + 1, last + 1);
    passed.fill(0, first + 1, last + 1);
    for (const name of ["t", "x", "y"]) made[name][first] = mean(made[name].slice(first, last + 1));
  }
  let total = 0;
  const clock = passed.map((p) => track.t[0] + (total += p));
  return { moving: part(made, kept), clock: clock.filter((_, k) => kept[k]) };
}

function sound(track) {
  const wild = wildRecords(track);
  const clean = wild.length ? part(track, Array.from(track.t, (_, k) => !wild.includes(k))) : track;
  const left = withoutRepeats(clean);
  let noise = positionNoise(left);
  const { moving, clock } = withoutPauses(left, noise);
  if (moving !== left) noise = positionNoise(moving);
  const duration = moving.t[moving.t.length - 1] - moving.t[0];
  return { track: moving, clock, clean, wild, noise, atRest: 1 - (clock[clock.length - 1] - clock[0]) / duration };
}

// --- smoothing and heading ---

function gaussian(row) {
  // rows go on by odd reflection about the line between their ends
  const size = row.length, line = even(0, 1, size).map((part) => row[0] + (row[size - 1] - row[0]) * part);
  const period = 2 * (size - 1), table = Float64Array.from({ length: period }, (_, k) => Math.sin((Math.PI * k) / (size - 1)));
  const waves = new Float64Array(size - 1);
  for (let k = 1; k < size - 1; k++) {
    let value = 0;
    for (let j = 1; j < size - 1; j++) value += (row[j] - line[j]) * table[(j * k) % period];
    waves[k] = (2 * value) / (size - 1);
  }
  return (width) => {
    const found = Float64Array.from(line);
    for (let k = 1; k < size - 1; k++) {
      const kept = waves[k] * Math.exp(-0.5 * ((width * Math.PI * k) / (size - 1)) ** 2);
      if (kept !== 0) for (let j = 1; j < size - 1; j++) found[j] += kept * table[(j * k) % period];
    }
    return found;
  };
}

const stepsOf = (places) => places.map((row) => Float64Array.from({ length: row.length - 1 }, (_, k) => row[k + 1] - row[k]));
const lengths = ([a, b]) => Float64Array.from(a, (v, k) => Math.hypot(v, b[k]));

function smooth(given) {
  const counted = sound(given), { track, clock, noise } = counted, size = clock.length;
  const times = even(clock[0], clock[size - 1], size), step = times[1] - times[0];
  const places = [interpolate(times, clock, track.x), interpolate(times, clock, track.y)];
  let width = 0, smoothed = places, filters = null;
  const filter = (w) => (filters ??= places.map(gaussian)).map((f) => f(w / step));
  const duration = clock[size - 1] - clock[0];
  const wantedFor = () => {
    const widest = 0.08 * duration, allowed = 0.04 * (median(lengths(stepsOf(smoothed))) / step);
    return allowed <= 0 ? widest : Math.min(widest, Math.cbrt(((noise / allowed) ** 2 * step) / (4 * Math.sqrt(Math.PI))));
  };
  for (let k = 0; k < (noise > 0 ? 6 : 0); k++) {
    const wanted = wantedFor();
    if (wanted <= 1.05 * width || wanted < 0.3 * step) break;
    width = wanted;
    smoothed = filter(width);
  }
  const removed = () => median(lengths(places.map((row, c) => row.map((v, k) => v - smoothed[c][k])))) / RAYLEIGH;
  while (width > 0.3 * step && removed() > 1.5 * noise) {
    width *= 0.7;
    smoothed = filter(width);
  }
  const velocity = smoothed.map((row) => slopes(row, step)), speed = lengths(velocity);
  const pace = median(speed);
  let error = 0;
  if (noise > 0) {
    error = noise / (Math.SQRT2 * step);
    if (width > 0) error = Math.min(error, noise * Math.sqrt(step / (4 * Math.sqrt(Math.PI) * width ** 3)));
    error = pace === 0 ? Infinity : error / pace;
  }
  return {
    t: interpolate(times, clock, track.t), x: smoothed[0], y: smoothed[1], speed,
    heading: unwrapped(velocity[0].map((v, k) => Math.atan2(velocity[1][k], v))),
    steps: stepsOf(places), step, noise, width, headingError: error, sound: counted,
    unsure: Math.min(roundEven((2 * width) / step), size >> 2),
  };
}

function roundEven(value) {
  const low = Math.floor(value), rest = value - low;
  return rest > 0.5 || (rest === 0.5 && low % 2) ? low + 1 : low;
}

// --- turns ---

function swingsOf(heading, smallest) {
  // turning points with hysteresis, as in rainflow counting
  const candidates = turningPlaces(heading);
  if (!candidates.length) return [];
  const values = candidates.map((k) => heading[k]), points = [];
  let low = 0, high = 0, direction = 0;
  values.forEach((value, i) => {
    if (value > values[high]) high = i;
    if (value < values[low]) low = i;
    if (direction >= 0 && values[high] - value >= smallest) { points.push(high); direction = -1; low = i; }
    else if (direction <= 0 && value - values[low] >= smallest) { points.push(low); direction = 1; high = i; }
  });
  if (direction) points.push(direction > 0 ? high : low);
  const at = points.map((i) => candidates[i]);
  return at.slice(1).map((end, k) => ({ start: at[k], end, angle: heading[end] - heading[at[k]] }));
}

function turningPlaces(heading) {
  const moving = [], slope = [];
  for (let k = 0; k < heading.length - 1; k++) {
    const s = Math.sign(heading[k + 1] - heading[k]);
    if (s) { moving.push(k); slope.push(s); }
  }
  if (!moving.length) return [];
  const found = [0];
  for (let k = 1; k < moving.length; k++) if (slope[k] !== slope[k - 1]) found.push(moving[k]);
  return [...found, heading.length - 1];
}

function crossings(times, heading, swings) {
  return swings.map(({ start, end, angle }) => {
    let k = 0;
    while (k <= end - start && !((heading[start + k] - heading[start]) / angle >= 0.5)) k++;
    k = Math.max(k > end - start ? 0 : k, 1);
    const before = (heading[start + k - 1] - heading[start]) / angle, after = (heading[start + k] - heading[start]) / angle;
    return times[start + k - 1] + ((0.5 - before) / (after - before)) * (times[start + k] - times[start + k - 1]);
  });
}

function measure(track, first) {
  const cut = (values) => values.slice(first, track.t.length - track.unsure);
  const times = cut(track.t), heading = cut(track.heading), x = cut(track.x), y = cut(track.y), n = times.length;
  const swings = swingsOf(heading, Math.max(20 * RAD, 6 * Math.min(track.headingError, 1)));
  let inner = swings;
  if (swings.length >= 4) {
    const sizes = swings.map((s) => Math.abs(s.angle)), usual = mean(sizes.slice(1, -1));
    inner = swings.slice(sizes[0] < usual ? 1 : 0, sizes.length - (sizes[sizes.length - 1] < usual ? 1 : 0));
  }
  const sizes = inner.map((s) => Math.abs(s.angle)), at = crossings(times, heading, inner);
  const intervals = at.slice(1).map((v, k) => v - at[k]);
  const left = mean(sizes.filter((_, k) => inner[k].angle > 0)), right = mean(sizes.filter((_, k) => inner[k].angle < 0));
  const turned = heading[n - 1] - heading[0];
  const against = swings.filter((s) => s.angle * turned < 0).map((s) => Math.abs(s.angle));
  const middle = mean(times);
  let up = 0, down = 0, path = 0;
  for (let k = 0; k < n; k++) { up += (times[k] - middle) * heading[k]; down += (times[k] - middle) ** 2; }
  const around = heading.map((h, k) => h - (up / down) * (times[k] - middle)), wander = largest(around) - smallestOf(around);
  for (let k = 1; k < n; k++) path += Math.hypot(x[k] - x[k - 1], y[k] - y[k - 1]);
  return {
    start: times[0], turned, swings: swings.length, swing: mean(sizes), widestSwing: Math.max(left, right),
    oneSidedness: left + right > 0 ? Math.abs(left - right) / (left + right) : 0,
    counterTurn: against.length ? largest(against) : 0, angleSpread: spread(sizes), intervalSpread: spread(intervals),
    wander, unevenness: turned ? wander / Math.abs(turned) : Infinity, turningRate: turned / (times[n - 1] - times[0]),
    circlingRadius: turned ? path / Math.abs(turned) : Infinity, period: intervals.length ? 2 * mean(intervals) : NaN,
  };
}

function measureRest({ t, x, y }) {
  const size = t.length, after = searchsorted(t, t[0] + 0.25 * (t[size - 1] - t[0]));
  const extent = (from) => {
    const mx = mean(x.slice(from)), my = mean(y.slice(from));
    let most = 0;
    for (let k = from; k < size; k++) most = Math.max(most, (x[k] - mx) ** 2 + (y[k] - my) ** 2);
    return 2 * Math.sqrt(most);
  };
  const whole = extent(0), late = extent(after);
  let reach = 0;
  for (let k = 0; k < size; k++) reach = Math.max(reach, Math.abs(x[k]), Math.abs(y[k]));
  const moves = late > 1e-9 * reach, settled = size - after >= 30 ? after : 0;
  let disorder = 2;
  if (moves) {
    const mx = mean(x.slice(settled)), my = mean(y.slice(settled));
    let steps = 0, around = 0;
    for (let k = settled; k < size; k++) {
      around += (x[k] - mx) ** 2 + (y[k] - my) ** 2;
      if (k > settled) steps += (x[k] - x[k - 1]) ** 2 + (y[k] - y[k - 1]) ** 2;
    }
    disorder = steps / (size - settled - 1) / (around / (size - settled));
  }
  return { start: t[0], extent: late, lateExtent: moves ? late / whole : 0, disorder };
}

// --- the rule ---

const above = (words, value, threshold, width) => ({ words, fit: clip(0.5 + (0.5 * (value - threshold)) / width, 0, 1) });
const below = (words, value, threshold, width) => above(words, -value, -threshold, width);
const weakestOf = (conditions) => conditions.reduce((a, b) => (b.fit < a.fit ? b : a));

function conditionsOf(m) {
  return {
    gliding: [
      below("its heading wanders", m.wander, 30 * RAD, 12 * RAD),
      below("it turns too far in all", Math.abs(m.turned), 60 * RAD, 30 * RAD),
    ],
    rotational: [
      above("it turns too little in all", Math.abs(m.turned), 60 * RAD, 30 * RAD),
      below("it turns back at times", m.counterTurn, 45 * RAD, 20 * RAD),
      below("it turns by fits and starts", m.unevenness, 0.4, 0.24),
    ],
    zigzag: [
      above("it swings too few times", m.swings, 3, 4),
      above("its swings are too small", m.swing, 24 * RAD, 8 * RAD),
      below("its swings are loops", m.widestSwing, Math.PI, 20 * RAD),
      below("it swings more to one side", m.oneSidedness, 0.4, 0.15),
      below("its swings differ in size", m.angleSpread, 0.4, 0.25),
      below("its swings differ in time", m.intervalSpread, 0.4, 0.25),
    ],
  };
}

function applyRule(track, start) {
  const measures = measure(track, start), conditions = conditionsOf(measures);
  const fits = Object.fromEntries(Object.entries(conditions).map(([mode, held]) => [mode, weakestOf(held).fit]));
  const modes = Object.keys(fits), mode = modes.reduce((a, b) => (fits[b] > fits[a] ? b : a));
  if (fits[mode] >= 0.5) {
    if (mode === "rotational") measures.period = (2 * Math.PI) / Math.abs(measures.turningRate);
    const weakest = weakestOf(conditions[mode]);
    return { mode, confidence: fits[mode], fits, measures, doubt: weakest.fit < 1 ? weakest.words : "" };
  }
  const held = (name) => mean(conditions[name].map((c) => c.fit));
  const nearest = modes.reduce((a, b) => (held(b) > held(a) ? b : a));
  let doubt = `not ${nearest}: ${weakestOf(conditions[nearest]).words}`;
  if (measures.swings < 3 && Math.abs(measures.turned) < 2 * Math.PI) doubt = "it turns too few times to tell";
  return { mode: "other", confidence: 1 - fits[mode], fits, measures, doubt };
}

const scoreOf = (result, later) => (result.mode === "other" ? 0 : result.confidence - 0.3 * later);

function nameByRule(track) {
  const still = measureRest(track.sound.clean);
  const rests = [above("its positions scatter without order", still.disorder, 1.3, 0.35), below("it came to rest", still.lateExtent, 0.02, 0.01)];
  const rest = rests[1].fit > rests[0].fit ? rests[1] : rests[0];
  if (rest.fit >= 0.5) {
    const named = { mode: "stationary", confidence: rest.fit, fits: {}, measures: { ...still, swings: 0, swing: NaN, turned: NaN, wander: NaN }, doubt: rest.words };
    return { named, evidence: gather(track, named.measures, still, [rest.fit, 0]) };
  }
  const later = median(track.speed.slice(track.speed.length >> 1));
  const begins = track.speed.findIndex((speed) => speed >= 0.5 * later);
  const first = Math.max(begins < 0 ? 0 : begins, track.unsure), left = track.t.length - first;
  const starts = left >= 60 ? LATER : LATER.filter((_, k) => k % (left > 24 ? 3 : 4) === 0);
  let best = applyRule(track, first), score = scoreOf(best, 0);
  for (const part of starts.slice(1)) {
    if (score >= 1 - 0.3 * part) break;
    const result = applyRule(track, first + Math.floor(part * left));
    if (scoreOf(result, part) > score) [best, score] = [result, scoreOf(result, part)];
  }
  Object.assign(best.measures, { extent: still.extent, lateExtent: still.lateExtent, disorder: still.disorder });
  return { named: best, evidence: gather(track, best.measures, still, Object.values(best.fits)) };
}

// --- how far to trust it ---

function correlation(steps, lag, power) {
  const size = steps[0].length;
  if (size <= lag || power === 0) return 0;
  let product = 0;
  for (const row of steps) for (let k = lag; k < size; k++) product += row[k] * row[k - lag];
  return ((product / power) * size) / (size - lag);
}

function rhythm(steps, power) {
  const size = steps[0].length, first = Math.floor(0.15 * size) + 1, last = size >> 1;
  const window = Float64Array.from({ length: size }, (_, k) => 0.5 - 0.5 * Math.cos((2 * Math.PI * k) / (size - 1)));
  const cosine = Float64Array.from({ length: size }, (_, k) => Math.cos((2 * Math.PI * k) / size));
  const sine = Float64Array.from({ length: size }, (_, k) => Math.sin((2 * Math.PI * k) / size));
  const fast = new Float64Array(Math.max(0, last - first + 1));
  for (const row of steps) {
    const middle = mean(row), around = row.map((v, k) => (v - middle) * window[k]);
    for (let f = first; f <= last; f++) {
      let re = 0, im = 0;
      for (let k = 0, at = 0; k < size; k++) {
        re += around[k] * cosine[at];
        im -= around[k] * sine[at];
        at += f;
        if (at >= size) at -= size;
      }
      fast[f - first] += re * re + im * im;
    }
  }
  const usual = mean(fast);
  if (fast.length < 3 || usual * fast.length <= 1e-3 * power * size) return 0;
  return clip(largest(fast) / usual - Math.log(fast.length), 0, 20);
}

function gather(track, found, still, fits) {
  const size = track.t.length, { steps } = track;
  const power = sum(steps.map((row) => sum(row.map((v) => v * v))));
  const lags = [1, 2, 3].map((lag) => correlation(steps, lag, power)), memory = 0.5 * (lags[1] + lags[2]);
  const [best, second] = [...fits].sort((a, b) => b - a);
  const swings = Number.isFinite(found.swing) ? found.swings : 0;
  const turned = Number.isFinite(found.turned) ? Math.abs(found.turned) : 0;
  const pace = Math.sqrt(power / Math.max(steps[0].length, 1)), used = searchsorted(track.t, found.start) / size;
  return [
    Math.log2(size), best, second, memory, memory * Math.sqrt(size), lags[0], rhythm(steps, power),
    pace > 0 ? Math.min(track.noise / pace, 1) : 1, Math.min(track.headingError, 0.6), Math.min(track.width / track.step, 20),
    Math.log2((size * (1 - used)) / (swings + 1)), Math.log2(size / (turned / (2 * Math.PI) + 0.1)), still.disorder, turned,
    Number.isFinite(found.wander) ? found.wander : 0, track.sound.atRest, track.sound.wild.length > 0 ? 1 : 0, used,
  ];
}

function odds(curve, evidence) {
  const scaled = evidence.map((v, k) => {
    const span = curve.high[k] > curve.low[k] ? curve.high[k] - curve.low[k] : 1;
    return (clip(v, curve.low[k], curve.high[k]) - curve.low[k]) / span;
  });
  let value = curve.weights[0], at = 1;
  curve.owners.forEach((owner, k) => (value += Math.max(0, scaled[owner] - curve.knots[k]) * curve.weights[at++]));
  for (let a = 0; a < scaled.length; a++) for (let b = a + 1; b < scaled.length; b++) value += scaled[a] * scaled[b] * curve.weights[at++];
  return value;
}

const chance = (curve, evidence) => 1 / (1 + Math.exp(-clip(odds(curve, evidence), -30, 30)));

function trust(mode, evidence) {
  const kept = DATA.confidence, { right, other } = kept.answers[mode];
  let chosen = mode, raw = chance(right, evidence);
  if (mode !== "other" && raw < 0.5) {
    const instead = chance(other, evidence);
    if (instead > raw) [chosen, raw] = ["other", instead];
  }
  const band = kept.settled[searchsorted(kept.lengths, evidence[0])];
  const confidence = interpolate([raw], kept.raw, band)[0];
  let against = "";
  if (confidence < 0.8) {
    const base = odds(right, evidence);
    let most = 0.5;
    NAMES.forEach((name, k) => {
      if (!(name in WORDS)) return;
      const gained = odds(right, evidence.map((v, i) => (i === k ? right.usual[k] : v))) - base;
      if (gained > most) [most, against] = [gained, WORDS[name]];
    });
  }
  return { mode: chosen, confidence, against };
}

const joined = (...doubts) => [...new Set(doubts.filter(Boolean))].join(", ");

function withSize(named, radius) {
  const { measures } = named;
  const still = below("it moves by less than its size", measures.extent / radius, 0.05, 0.03);
  const wide = above("it spins within its own outline", (measures.circlingRadius ?? NaN) / radius, 1, 0.25);
  if (still.fit >= 0.5) return { ...named, mode: "stationary", confidence: Math.max(still.fit, named.mode === "stationary" ? named.confidence : 0), doubt: still.words };
  if (named.mode !== "rotational") return { ...named, confidence: named.confidence * (1 - still.fit) };
  if (wide.fit >= 0.5) return { ...named, confidence: named.confidence * wide.fit, doubt: joined(named.doubt, wide.fit < 1 ? wide.words : "") };
  return { ...named, mode: "other", detail: "steady spin", confidence: 1 - named.confidence * wide.fit, doubt: joined(`not rotational: ${wide.words}`, named.doubt) };
}

function told({ mode, measures, detail }) {
  const degrees = (v) => Math.round(Math.abs(v) / RAD), three = (v) => String(Number(v.toPrecision(3)));
  const side = measures.turned > 0 ? "left" : "right";
  if (mode === "gliding") return `turned ${degrees(measures.turned)} degrees in all`;
  if (mode === "rotational") return `turns ${side} only, once round in ${three(measures.period)}`;
  if (mode === "zigzag") return `${measures.swings} swings of ${degrees(measures.swing)} degrees, left and right in ${three(measures.period)}`;
  if (detail === "steady spin") return `spins to the ${side} on the spot, once round in ${three((2 * Math.PI) / Math.abs(measures.turningRate))}`;
  return "";
}

// Times, positions and the radius of the cell: as `classify` of a run.
export function classify(t, x, y, radius, since = 0) {
  const { named, evidence } = nameByRule(smooth({ t, x, y }));
  const found = trust(named.mode, evidence);
  let doubt = joined(named.doubt, found.against);
  if (found.mode !== named.mode) doubt = `not surely ${named.mode}: ${found.against || named.doubt || "too little to tell"}`;
  let result = withSize({ detail: "", ...named, mode: found.mode, confidence: found.confidence, doubt }, radius);
  const end = t[t.length - 1] - since;
  if (["gliding", "stationary"].includes(result.mode) && end < 50)
    result = { ...result, confidence: Math.min(result.confidence, 0.5), doubt: joined(`it ends at t = ${Number(t[t.length - 1].toPrecision(4))}, and turns may begin up to t = ${since + 50}`, result.doubt) };
  const words = [told(result), result.doubt].filter(Boolean).join("; but ");
  return { mode: result.mode, confidence: result.confidence, words, doubt: result.doubt, detail: result.detail };
}
