// The range of a quantity over the whole map, computed once.
import { isMissing } from "./record.js";

const known = new WeakMap(); // variable -> its range

function findRange(variable) {
  const range = { low: Infinity, high: -Infinity, leastPositive: Infinity, hasGaps: false };
  for (const value of variable.values) {
    if (isMissing(variable, value)) {
      range.hasGaps = true;
      continue;
    }
    if (value < range.low) range.low = value;
    if (value > range.high) range.high = value;
    if (value > 0 && value < range.leastPositive) range.leastPositive = value;
  }
  return range;
}

// {low, high, leastPositive: of the numbers there are, else infinite; hasGaps: whether some are missing}
export function valueRange(variable) {
  if (!known.has(variable)) known.set(variable, findRange(variable));
  return known.get(variable);
}

// Whether a logarithmic scale is meaningful: the quantity is never negative, and neither a count nor a flag.
export function suitsLogarithm(variable) {
  const { low, leastPositive } = valueRange(variable);
  return variable.kind === "float" && low >= 0 && leastPositive < Infinity;
}

const farAbove = 8;
const sampled = 10_000; // values are enough

// Whether the largest value is far above most, so that a linear scale would show little.
export function spansDecades(variable) {
  if (!suitsLogarithm(variable)) return false;
  const { values } = variable;
  const step = Math.ceil(values.length / sampled);
  const some = Float64Array.from({ length: Math.ceil(values.length / step) }, (_, i) => values[i * step]);
  const sorted = some.filter(Number.isFinite).sort();
  return sorted.at(-1) > farAbove * sorted[sorted.length >> 1];
}
