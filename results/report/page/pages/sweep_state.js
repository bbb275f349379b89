// What of a map is being looked at: quantity, axes, the point of the sliders and those picked for curves.
import { fractionalIndex } from "../axes.js";
import { meaningOf } from "../record.js";

// The axes along which there is something to move.
export const sliding = (map) => map.axes.map((_, a) => a).filter((a) => map.axes[a].size > 1);

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

// (row of /borders, whether its edge lies along this axis) -> fractional index along the axis: by a parameter that
// rises or falls all along, else the point of the grid or the one stretch between two on which all its parameters
// fit; NaN if there is none, or several.
function placeAlong({ coordinates, size }, group) {
  const known = coordinates.filter(({ name }) => group.has(name));
  const ordered = known.find(({ monotone }) => monotone);
  if (ordered) return (row) => fractionalIndex(ordered.values, group.values(ordered.name)[row]);
  const points = Array.from({ length: size }, (_, i) => i);
  return (row, isAlong) => {
    const value = ({ name }) => group.values(name)[row];
    if (!isAlong) {
      const found = points.findIndex((i) => known.every((one) => one.values[i] === value(one)));
      return found < 0 ? NaN : found;
    }
    const shares = points.slice(0, -1).map((i) => shareOfStretch(known, i, value));
    const fitting = points.filter((i) => shares[i] >= 0 && shares[i] <= 1);
    return fitting.length === 1 ? fitting[0] + shares[fitting[0]] : NaN;
  };
}

// How far along the stretch from point i to the next one all coordinates stand; NaN if not equally far.
function shareOfStretch(known, i, value) {
  const shares = known.map((one) => {
    const [from, to] = [one.values[i], one.values[i + 1]];
    return from === to ? (value(one) === from ? undefined : NaN) : (value(one) - from) / (to - from);
  });
  const moving = shares.filter((share) => share !== undefined);
  return moving.every((share) => Math.abs(share - moving[0]) < 1e-9) ? moving[0] : NaN;
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
  const along = (row) => axes.findIndex((one) => one.name === meaningOf(axis, axis.values[row]));
  return Array.from(element.values, (code, row) => ({ code, row }))
    .filter(({ code }) => meaningOf(element, code) === contact)
    .map(({ row }) => ({
      place: places.map((place, a) => place(row, a === along(row))),
      axis: along(row),
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
    scale: "automatic",
    curveScale: "linear",
    colours: "viridis",
    contact: contacts[0] ?? "",
    colourByRegime: false,
    kept: [],
    crossings,
  };
}

// The contact whose borders and regimes are shown: that of a regime or of stops which is the quantity, else the chosen.
export function shownContact({ variable, contact, crossings }) {
  const own = variable.name.replace(/_(regime|stops)$/, "");
  return crossings.has(own) ? own : contact;
}

// The points whose curves are shown: those kept, then the current one if it is not among them.
export function curvePoints(state) {
  const same = (a, b) => a.every((i, axis) => axis === state.curveAxis || i === b[axis]);
  return state.kept.some((index) => same(index, state.index)) ? state.kept : [...state.kept, state.index];
}
