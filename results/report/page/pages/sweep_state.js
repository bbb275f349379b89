// What of a map is being looked at: quantity, axes, the point of the sliders and those picked for curves.
import { fractionalIndex } from "../axes.js";
import { meaningOf } from "../record.js";

const sliding = (map) => map.axes.map((_, a) => a).filter((a) => map.axes[a].size > 1);

const manyPoints = 8;

// The frequency, or whatever has most points, lies along x; the next along y.
function axesOf(map) {
  const bySize = sliding(map).sort((a, b) => map.axes[b].size - map.axes[a].size);
  const isFrequency = (a) =>
    map.axes[a].size >= manyPoints &&
    map.axes[a].coordinates.some(({ long_name: meaning }) => meaning === "[excitation]: frequency");
  const x = bySize.find(isFrequency) ?? bySize[0] ?? 0;
  return { x, y: bySize.find((axis) => axis !== x) ?? null };
}

// Row of /borders -> fractional index along an axis: by a parameter that rises or falls all along, else on the
// stretch between two points of the grid on which all its parameters lie equally far; NaN if there is none.
function placeAlong({ coordinates, size }, group) {
  const known = coordinates.filter(({ name }) => group.has(name));
  const ordered = known.find(({ monotone }) => monotone);
  if (ordered) return (row) => fractionalIndex(ordered.values, group.values(ordered.name)[row]);
  return (row) => {
    for (let i = 0; i + 1 < size; ++i) {
      const shares = known
        .filter(({ values }) => values[i] !== values[i + 1])
        .map(({ name, values }) => (group.values(name)[row] - values[i]) / (values[i + 1] - values[i]));
      const [share] = shares;
      const fits = known.every(
        ({ name, values }) => values[i] !== values[i + 1] || group.values(name)[row] === values[i],
      );
      const isOn =
        fits && share >= 0 && share <= 1 && shares.every((other) => Math.abs(other - share) < 1e-9);
      if (isOn) return share === 1 ? i + 1 : i + share;
    }
    return NaN;
  };
}

// Crossings of /borders of one contact: {place: fractional index along each axis, axis: along which, key}.
function crossingsOf(record, contact) {
  const group = record.groups.get("borders");
  if (!group) return [];
  const element = group.column("element"),
    axis = group.column("axis");
  const below = group.column("regime_below"),
    above = group.column("regime_above");
  if (!element?.values.length) return [];
  const axes = record.map.axes;
  const places = axes.map((one) => placeAlong(one, group));
  return Array.from(element.values, (code, row) => ({ code, row }))
    .filter(({ code }) => meaningOf(element, code) === contact)
    .map(({ row }) => ({
      place: places.map((place) => place(row)),
      axis: axes.findIndex((one) => one.name === meaningOf(axis, axis.values[row])),
      key: [below, above]
        .map((regime) => regime.values[row])
        .sort()
        .map((code) => meaningOf(below, code))
        .join("|"),
    }));
}

// Contacts that have a regime among the page's quantities, or borders.
function contactsOf(record) {
  const fromRegimes = record.map.variables
    .filter(({ name }) => name.endsWith("_regime"))
    .map(({ name }) => name.slice(0, -7));
  const element = record.groups.get("borders")?.column("element");
  const fromBorders = (element?.flags ?? [])
    .map(([, word]) => word)
    .filter((word) => word !== "not_computed");
  return [...new Set([...fromRegimes, ...fromBorders])];
}

// Colours go by powers of ten where the largest value is far above most.
const farAbove = 8;
const sampled = 10_000; // values are enough to tell
function scaleOf(variable) {
  if (variable.kind !== "float") return "linear";
  const step = Math.ceil(variable.values.length / sampled);
  const values = variable.values.filter((value, i) => i % step === 0 && Number.isFinite(value)).sort();
  return values[0] >= 0 && values.at(-1) > farAbove * values[values.length >> 1] ? "log" : "linear";
}

// The point nearest the middle of the axes that has a number.
function middleWithNumber(map, variable) {
  const middle = map.axes.map((axis) => Math.floor((axis.size - 1) / 2));
  if (!Number.isNaN(map.value(variable, middle))) return middle;
  const centre = map.offset(middle);
  let best = -1;
  variable.values.forEach((value, i) => {
    if (!Number.isNaN(value) && (best < 0 || Math.abs(i - centre) < Math.abs(best - centre))) best = i;
  });
  return best < 0 ? middle : map.axes.map(({ size, stride }) => Math.floor(best / stride) % size);
}

export function firstState(record) {
  const { map } = record;
  const { x, y } = axesOf(map);
  const crossings = new Map(contactsOf(record).map((contact) => [contact, crossingsOf(record, contact)]));
  const contacts = [...crossings.keys()].sort((a, b) => crossings.get(b).length - crossings.get(a).length);
  const variable = map.variables.find(({ kind }) => kind === "float") ?? map.variables[0];
  return {
    variable,
    x,
    y,
    index: middleWithNumber(map, variable),
    curveAxis: x,
    coordinates: map.axes.map(() => 0),
    scale: scaleOf(variable),
    curveScale: "linear",
    colours: "viridis",
    contact: contacts[0] ?? "",
    colourByRegime: false,
    kept: [],
    crossings,
  };
}

// The points whose curves are shown: those kept, then the current one if it is not among them.
export function curvePoints(state) {
  const same = (a, b) => a.every((i, axis) => axis === state.curveAxis || i === b[axis]);
  return state.kept.some((index) => same(index, state.index)) ? state.kept : [...state.kept, state.index];
}
