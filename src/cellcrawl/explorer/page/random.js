// NumPy's default_rng(seed).uniform: PCG64 seeded by SeedSequence, to the same bits.

const WORD = 0xffffffffn;
const LONG = (1n << 64n) - 1n;
const WHOLE = (1n << 128n) - 1n;
const MULTIPLIER = 0x2360ed051fc65da44385df649fccf645n;

function words(seed) {
  const found = [];
  for (let rest = BigInt(seed); rest > 0n; rest >>= 32n) found.push(Number(rest & WORD));
  return found.length ? found : [0];
}

function seedState(seed) {
  let constant = 0x43b0d7e5;
  const hash = (value) => {
    value = (value ^ constant) >>> 0;
    constant = Math.imul(constant, 0x931e8875) >>> 0;
    value = Math.imul(value, constant) >>> 0;
    return (value ^ (value >>> 16)) >>> 0;
  };
  const mix = (a, b) => {
    const value = (Math.imul(0xca01f9dd, a) - Math.imul(0x4973f715, b)) >>> 0;
    return (value ^ (value >>> 16)) >>> 0;
  };
  const entropy = words(seed);
  const pool = [0, 1, 2, 3].map((k) => hash(entropy[k] ?? 0));
  for (let from = 0; from < 4; from++)
    for (let to = 0; to < 4; to++) if (from !== to) pool[to] = mix(pool[to], hash(pool[from]));
  constant = 0x8b51f9dd;
  const out = [];
  for (let k = 0; k < 8; k++) {
    let value = (pool[k % 4] ^ constant) >>> 0;
    constant = Math.imul(constant, 0x58f38ded) >>> 0;
    value = Math.imul(value, constant) >>> 0;
    out.push(BigInt((value ^ (value >>> 16)) >>> 0));
  }
  return [0, 2, 4, 6].map((k) => out[k] | (out[k + 1] << 32n));
}

export function uniform(seed, count) {
  // count numbers from -1 to 1
  const [a, b, c, d] = seedState(seed);
  const increment = ((((c << 64n) | d) << 1n) | 1n) & WHOLE;
  let state = (increment + ((a << 64n) | b)) & WHOLE;
  const step = () => (state = (state * MULTIPLIER + increment) & WHOLE);
  step();
  const found = new Float64Array(count);
  for (let k = 0; k < count; k++) {
    step();
    const turn = state >> 122n;
    const folded = (state >> 64n) ^ (state & LONG);
    const value = ((folded >> turn) | (folded << (64n - turn))) & LONG;
    found[k] = -1 + 2 * (Number(value >> 11n) * 2 ** -53);
  }
  return found;
}
