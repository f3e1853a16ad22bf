// What numbers may be; parameters as in the package.

import { DATA } from "./data.js";

export const LIMITS = {
  ...DATA.limits,
  ...Object.fromEntries(Object.values(DATA.laws).flatMap(({ numbers }) => Object.entries(numbers).map(([name, { limits }]) => [`laws.${name}`, limits]))),
  rtol: [1e-8, 1e-2], time: [0, 1e6], to: [0, 2000], speed: [0.1, 1000], discs: 200,
};
