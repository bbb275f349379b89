// The axes of a map: labels, spacing, nearest points.
import { numberText, unitText, withUnit, words } from "./units.js";

const greek = new Map(
  Object.entries({
    alpha: "\u03b1",
    beta: "\u03b2",
    gamma: "\u03b3",
    delta: "\u03b4",
    epsilon: "\u03b5",
    zeta: "\u03b6",
    eta: "\u03b7",
    theta: "\u03b8",
    kappa: "\u03ba",
    lambda: "\u03bb",
    mu: "\u03bc",
    nu: "\u03bd",
    xi: "\u03be",
    rho: "\u03c1",
    sigma: "\u03c3",
    tau: "\u03c4",
    phi: "\u03c6",
    psi: "\u03c8",
    omega: "\u03c9",
    Omega: "\u03a9",
    Delta: "\u0394",
  }),
);

// A parameter's name as a symbol: "omega" to "ω", "zeta_1" to "ζ 1".
export function symbolText(name) {
  return name
    .split("_")
    .map((part) => greek.get(part) ?? part)
    .join(" ");
}

// The record states where the study uses a parameter: "[excitation]: frequency", 'element "inerter": inertance'.
function plainMeaning(longName = "") {
  const use = /^(?:\[+(\w+)\]+(?: \d+)?|.* "(\w+)"): (\w+)$/.exec(longName);
  if (!use) return longName;
  return use[1] ? `${use[1]} ${words(use[3])}` : `${words(use[3])} of ${words(use[2])}`;
}

const shortEnough = 34; // characters of a label

// The label of an axis or of a derived coordinate with its unit: "excitation frequency ω (rpm)".
export function coordinateLabel({ name, unit, long_name: longName }) {
  const meaning = plainMeaning(longName);
  const told =
    meaning && meaning !== `parameter ${name}` && meaning !== name && meaning.length <= shortEnough;
  const isSymbol = !name.includes("_");
  const saysName = meaning.endsWith(name);
  const text = told ? (isSymbol && !saysName ? `${meaning} ${symbolText(name)}` : meaning) : symbolText(name);
  return withUnit(text, unitText(unit));
}

// The label of a map axis by one of its coordinates, with the other parameters that change along it.
export function axisLabel(map, axis, coordinate) {
  const others = axis.coordinates.filter((other) => other !== coordinate && map.parameters.has(other.name));
  const label = coordinateLabel(coordinate);
  return others.length ? `${label}, with ${others.map(({ name }) => symbolText(name)).join(", ")}` : label;
}

// "I = 6.36 kg", "record el_centro.csv".
export function coordinateText({ name, unit, values, names }, i) {
  if (names) return `${symbolText(name)} ${names[i]}`;
  const after = unitText(unit);
  return `${symbolText(name)} = ${numberText(values[i])}${after ? ` ${after}` : ""}`;
}

// Point i of a map axis as text: the parameters that change along the axis, else its first coordinate.
export function axisText(map, axis, i) {
  const own = axis.coordinates.filter(({ name }) => map.parameters.has(name));
  return (own.length ? own : axis.coordinates.slice(0, 1))
    .map((coordinate) => coordinateText(coordinate, i))
    .join(", ");
}

// Columns for a CSV file: every coordinate of the points, which are indices of the map.
export function coordinateColumns(map, points) {
  return map.axes.flatMap((axis, a) =>
    axis.coordinates.flatMap(({ name, unit, values, names }) => [
      { name, unit, values: points.map((index) => values[index[a]]) },
      ...(names ? [{ name: `${name}_name`, unit: "1", values: points.map((index) => names[index[a]]) }] : []),
    ]),
  );
}

// The scale on which values are evenly spaced: "linear", "log", or "" for neither.
export function spacing(values) {
  const even = (of) => {
    const step = (of(values.at(-1)) - of(values[0])) / (values.length - 1);
    return values.every(
      (value, i) => Math.abs(of(value) - of(values[0]) - i * step) <= 1e-6 * Math.abs(step),
    );
  };
  if (values.length < 2 || even((value) => value)) return "linear";
  return values.every((value) => value > 0) && even(Math.log) ? "log" : "";
}

const wideSpan = 1000;

// The scale of a monotone axis: the one on which its values are even, else logarithmic if they span decades.
export function axisScale(values) {
  const ends = [values[0], values.at(-1)],
    least = Math.min(...ends);
  return spacing(values) || (least > 0 && Math.max(...ends) / least > wideSpan ? "log" : "linear");
}

// The index whose value lies nearest (of a monotone axis, on its scale).
export function nearest(values, at, type) {
  const of = type === "log" ? Math.log : (value) => value;
  let best = 0;
  for (let i = 1; i < values.length; ++i) {
    if (Math.abs(of(values[i]) - of(at)) < Math.abs(of(values[best]) - of(at))) best = i;
  }
  return best;
}

// The edges between the cells of a map, one more than there are values: half way between neighbours.
export function cellEdges(values, type) {
  const to = type === "log" ? Math.log : (value) => value,
    from = type === "log" ? Math.exp : (value) => value;
  const places = Array.from(values, to);
  if (places.length === 1) return [from(places[0] - 0.5), from(places[0] + 0.5)];
  const inner = places.slice(1).map((place, i) => (place + places[i]) / 2);
  const first = places[0] - (inner[0] - places[0]),
    last = places.at(-1) + (places.at(-1) - inner.at(-1));
  return [first, ...inner, last].map(from);
}

// The fractional index of a value along a monotone axis, NaN outside.
export function fractionalIndex(values, at) {
  const rising = values.at(-1) >= values[0];
  for (let i = 0; i + 1 < values.length; ++i) {
    const [low, high] = rising ? [values[i], values[i + 1]] : [values[i + 1], values[i]];
    if (at < low || at > high) continue;
    return i + (at - values[i]) / (values[i + 1] - values[i]);
  }
  return values.length === 1 && at === values[0] ? 0 : NaN;
}

// The command that computes this point again, in the units of the study.
export function pointCommand(record, index) {
  const quoted = (text) => (/^[A-Za-z0-9_.,=\/-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);
  const at = record.map.axes.flatMap((axis, a) =>
    axis.coordinates
      .filter(({ name, names }) => names || record.map.parameters.has(name))
      .map(
        ({ name, unit, values }) => `${name}=${values[index[a]]}${unit && unit !== "1" ? ` ${unit}` : ""}`,
      ),
  );
  const set = record.provenance.overrides;
  return `frahm point ${quoted(record.provenance.study_file ?? "study.toml")} --at ${quoted(at.join(","))}${set ? ` --set ${quoted(set)}` : ""}`;
}
