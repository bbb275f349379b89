// The state of a map's view: quantity, axes, the sliders' point and the points picked for curves.
import { fractionalIndex } from "../axes.js";
import { branchesOf } from "../branches.js";
import { headlines, profileOf } from "../profile.js";
import { meaningOf } from "../record.js";

// The axes with more than one point.
export const sliding = (map) => map.axes.map((_, a) => a).filter((a) => map.axes[a].size > 1);

const manyPoints = 8;

const hasNames = (axis) => axis.coordinates.some(({ names }) => names);

// The frequency, else the axis with most points, lies along x; the next along y. Records, whose names stand at the
// left, and samples, which are in no order, do not lie along x if another axis can.
function axesOf(map) {
  const late = (a) => (a === map.samples ? 2 : hasNames(map.axes[a]) ? 1 : 0);
  const bySize = sliding(map).sort((a, b) => late(a) - late(b) || map.axes[b].size - map.axes[a].size);
  const isFrequency = (a) =>
    map.axes[a].size >= manyPoints &&
    map.axes[a].coordinates.some(({ long_name: meaning }) => meaning === "[excitation]: frequency");
  const x = bySize.find(isFrequency) ?? bySize[0] ?? 0;
  const others = bySize.filter((axis) => axis !== x);
  return { x, y: others.find((axis) => hasNames(map.axes[axis])) ?? others[0] ?? null };
}

// (row of /borders, whether its edge lies along this axis) -> fractional index along the axis: from a monotone
// parameter, else from the one grid point, or the one interval between two, that fits all parameters; NaN if none or
// several fit.
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

// The fraction of the interval from point i to the next at which all coordinates lie; NaN if they differ.
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

// Of a structure the peak of its top, else the first number.
function firstVariable(map, profile) {
  const top = profile && map.variable(`${profile.masses.at(-1)}_peak`);
  return top ?? map.variables.find(({ kind }) => kind === "float") ?? map.variables[0];
}

export function firstState(record) {
  const { map } = record,
    profile = profileOf(record);
  const { x, y } = axesOf(map);
  const crossings = new Map(contactsOf(record).map((contact) => [contact, crossingsOf(record, contact)]));
  const contacts = [...crossings.keys()].sort((a, b) => crossings.get(b).length - crossings.get(a).length);
  const variable = firstVariable(map, profile);
  return {
    variable,
    headlines: headlines(map, profile), // the quantities that are listed
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
    followed: branchesOf(record),
    showBranches: true,
  };
}

// The contact whose borders and regimes are shown: that of the quantity, if a regime or stops, else the chosen one.
export function shownContact({ variable, contact, crossings }) {
  const own = variable.name.replace(/_(regime|stops)$/, "");
  return crossings.has(own) ? own : contact;
}

// The points whose curves are shown: the picked ones, then the current one unless it is among them.
export function curvePoints(state) {
  const same = (a, b) => a.every((i, axis) => axis === state.curveAxis || i === b[axis]);
  return state.kept.some((index) => same(index, state.index)) ? state.kept : [...state.kept, state.index];
}

// The points whose profiles are shown: the same, but points that differ along the curves' axis too.
export function profilePoints({ kept, index }) {
  return kept.some((other) => other.every((i, a) => i === index[a])) ? kept : [...kept, index];
}

// The quantities listed, with the one that is shown.
export function listedQuantities({ headlines: listed, variable }) {
  return listed.includes(variable) ? listed : [...listed, variable];
}
