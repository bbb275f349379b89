// Units and numbers as readers write them.

const superscripts = {
  "-": "\u207b",
  0: "\u2070",
  1: "\u00b9",
  2: "\u00b2",
  3: "\u00b3",
  4: "\u2074",
  5: "\u2075",
  6: "\u2076",
  7: "\u2077",
  8: "\u2078",
  9: "\u2079",
};

// -12 to "⁻¹²".
export function superscript(power) {
  return [...String(power)].map((digit) => superscripts[digit]).join("");
}

// "m s-2" to "m/s²", "N s m-1" to "N s/m", "rad s-1" to "rad/s", "(m)2" to "m²"; "1" to "".
export function unitText(unit) {
  if (!unit || unit === "1") return "";
  if (unit === "percent") return "%";
  const square = /^\((.*)\)2$/.exec(unit);
  if (square) return /^\w+$/.test(square[1]) ? `${square[1]}\u00b2` : `(${unitText(square[1])})\u00b2`;
  const above = [],
    below = [];
  for (const factor of unit.split(/[ .*]+/)) {
    const parts = /^(.*?)(?:\^?(-?\d+))?$/.exec(factor);
    const power = Number(parts[2] ?? 1);
    if (!/^[A-Za-zµ%°]+$/.test(parts[1])) return unit;
    const raised = Math.abs(power) === 1 ? parts[1] : parts[1] + superscript(Math.abs(power));
    (power > 0 ? above : below).push(raised);
  }
  if (below.length === 0) return above.join(" ");
  const denominator = below.length > 1 ? `(${below.join(" ")})` : below[0];
  return `${above.join(" ") || "1"}/${denominator}`;
}

// Lengths and forces are shown in the unit in which the largest has one to three digits before the point.
const prefixed = {
  m: [
    [1, "m"],
    [1e-3, "mm"],
    [1e-6, "\u00b5m"],
    [1e-9, "nm"],
  ],
  N: [
    [1e6, "MN"],
    [1e3, "kN"],
    [1, "N"],
    [1e-3, "mN"],
  ],
  J: [
    [1e3, "kJ"],
    [1, "J"],
    [1e-3, "mJ"],
    [1e-6, "\u00b5J"],
  ],
};

const leastPrefixed = 1e-4,
  mostPrefixed = 1e7; // of the least and greatest prefix: beyond, powers of ten of the unit itself

const roundingShare = 1e-12; // a share nearer to 1 than this is 1 but for rounding

// {factor, text}: a value in `unit` is value x factor in `text`.
export function shownUnit(unit, values) {
  const steps = prefixed[unit];
  if (!steps) return { factor: 1, text: unitText(unit) };
  let largest = 0;
  for (const value of values) if (Number.isFinite(value)) largest = Math.max(largest, Math.abs(value));
  const [least] = steps.at(-1);
  const plain = largest < least * leastPrefixed || largest >= steps[0][0] * mostPrefixed;
  const [scale, text] = steps.find(([size]) => largest >= size) ?? steps.at(-1);
  if (plain) return { factor: 1, text: unit };
  return { factor: 1 / scale, text };
}

// The same for the ends of a linear axis, with a power of ten before the unit where its numbers would have many zeros.
export function axisUnit(unit, ends) {
  const { factor, text } = shownUnit(unit, ends);
  const largest = Math.max(...ends.map((value) => Math.abs(value * factor)));
  if (largest === 0 || (largest >= 1e-4 && largest < 1e7)) return { factor, text };
  const power = 3 * Math.floor(Math.log10(largest) / 3);
  return { factor: factor * 10 ** -power, text: `\u00d710${superscript(power)}${text ? ` ${text}` : ""}` };
}

// The items by the unit that each has, in groups that a figure can draw on one axis: an angle is no length.
export function groupedByUnit(items, unitOf) {
  const groups = new Map();
  for (const item of items) {
    const unit = unitOf(item);
    if (!groups.has(unit)) groups.set(unit, []);
    groups.get(unit).push(item);
  }
  return [...groups].map(([unit, members]) => ({ unit, members }));
}

// "peak of main (mm)".
export function withUnit(text, unit) {
  return unit ? `${text} (${unit})` : text;
}

// Six significant digits, plainly written where that is readable.
export function numberText(value, digits = 6) {
  if (Number.isNaN(value) || value === undefined) return "\u2013";
  if (!Number.isFinite(value)) return value > 0 ? "\u221e" : "\u2212\u221e";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e7)) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    return `${Number(mantissa)}\u00d710${superscript(Number(exponent))}`.replaceAll("-", "\u2212");
  }
  return String(Number(value.toPrecision(digits))).replace("-", "\u2212");
}

// "31.91 mm": a number with its unit.
export function quantityText(value, unit, digits = 6) {
  const { factor, text } = shownUnit(unit, [value]);
  return text && !Number.isNaN(value)
    ? `${numberText(value * factor, digits)} ${text}`
    : numberText(value * factor, digits);
}

// A share in percent, with enough digits to differ from 100 %: "99.97 %".
export function shareText(share, digits = 3) {
  const left = Math.abs(1 - share);
  const needed = left > roundingShare ? Math.ceil(-Math.log10(left)) : 0;
  return `${numberText(100 * share, Math.max(digits, needed))} %`;
}

// The text with a capital first letter.
export function sentence(text) {
  return text.charAt(0).toUpperCase() + text.slice(1);
}

// "main_peak" to "main peak"; also for flag meanings.
export function words(name) {
  return name.replaceAll("_", " ");
}
