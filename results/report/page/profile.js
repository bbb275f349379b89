// The masses of a system in their order over the height, such as the floors of a building, and the quantities that
// stand for many.
import { axisText } from "./axes.js";

const listed = (text) => (text ? text.split(",") : []);

// {masses, the lowest first; heights; springs: the one below each mass, or ""; owners: names that begin those of
// quantities; unit: of the heights, undefined where they are numbers from 1; hint: where the study has not chosen, or ""}. null if the result has no profile.
export function profileOf(record) {
  const group = record.groups.get("profile");
  if (!group) return null;
  const masses = listed(group.texts.masses),
    height = group.column("height");
  return {
    masses,
    springs: listed(group.texts.springs),
    owners: new Set(listed(group.texts.owners)),
    heights: height ? Array.from(height.values) : masses.map((_, i) => i + 1),
    unit: height?.unit,
    hint: group.texts.hint ?? "",
  };
}

// Those of one unit, as many as there are in the map: rotations do not stand beside displacements.
function ofOneUnit(places) {
  const known = places.filter(({ variable }) => variable);
  return known.filter(({ variable }) => variable.unit === known[0].variable.unit);
}

// The masses whose peak the map has: [{mass, height, variable}].
export function profilePeaks(map, { masses, heights }) {
  return ofOneUnit(
    masses.map((mass, i) => ({ mass, height: heights[i], variable: map.variable(`${mass}_peak`) })),
  );
}

// The springs between neighbours whose stroke the map has: [{spring, below, above, variable}], heights of both ends.
export function profileDrifts(map, { springs, heights }) {
  return ofOneUnit(
    springs.map((spring, i) => {
      const below = i === 0 ? 0 : heights[i - 1],
        above = heights[i];
      return { spring, below, above, variable: above > below ? map.variable(`${spring}_stroke`) : undefined };
    }),
  );
}

// "floor12_peak" to {owner: "floor12", kind: "peak"}; "natural_frequency_7" to {owner: "", kind: "natural_frequency"}.
function kindOf(name, owners) {
  for (let end = name.lastIndexOf("_"); end > 0; end = name.lastIndexOf("_", end - 1)) {
    if (owners.has(name.slice(0, end))) return { owner: name.slice(0, end), kind: name.slice(end + 1) };
  }
  return { owner: "", kind: name.replace(/_\d+$/, "") };
}

export const mostListed = 8; // names of a kind that are all listed

// The quantities of a map that stand for all: of a kind that many masses or elements have, those of the profile's ends,
// else of the first and the last; of a small system every quantity.
export function headlines({ variables }, profile) {
  if (!profile) return variables;
  const ends = [profile.masses[0], profile.masses.at(-1)];
  const kinds = new Map();
  for (const variable of variables) {
    const { owner, kind } = kindOf(variable.name, profile.owners);
    if (!kinds.has(kind)) kinds.set(kind, []);
    kinds.get(kind).push({ owner, variable });
  }
  const chosen = new Set();
  for (const same of kinds.values()) {
    const ofEnds = same.filter(({ owner }) => ends.includes(owner));
    const shown = same.length <= mostListed ? same : ofEnds.length ? ofEnds : [same[0], same.at(-1)];
    for (const { variable } of shown) chosen.add(variable);
  }
  return variables.filter((variable) => chosen.has(variable));
}

// A name for each of several points: the coordinates in which they differ; of a single one all.
export function pointNames(map, points) {
  const wide = map.axes.map((_, a) => a).filter((a) => map.axes[a].size > 1);
  const differ = wide.filter((a) => points.some((index) => index[a] !== points[0][a]));
  return points.map((index) =>
    (differ.length ? differ : wide).map((a) => axisText(map, map.axes[a], index[a])).join(", "),
  );
}

// The point along an axis at which the largest of the profile's peaks is largest.
export function worstAlong(map, profile, index, axis) {
  const lines = profilePeaks(map, profile).map(({ variable }) => map.line(variable, index, axis));
  let worst = index[axis],
    largest = -Infinity;
  for (let i = 0; i < map.axes[axis].size; ++i) {
    for (const line of lines) {
      if (!(line[i] > largest)) continue;
      largest = line[i];
      worst = i;
    }
  }
  return index.map((k, a) => (a === axis ? worst : k));
}

// A spring has one stroke from its lower end to its upper one; the line breaks where no spring joins neighbours.
export function driftPath(map, drifts, index) {
  const x = [],
    y = [];
  drifts.forEach(({ below, above, variable }, i) => {
    if (i > 0 && drifts[i - 1].above !== below) {
      x.push(NaN);
      y.push(NaN);
    }
    const stroke = map.value(variable, index);
    x.push(stroke, stroke);
    y.push(below, above);
  });
  return { x, y };
}

// Columns of a CSV file: what lies where, then its values at each point.
export function profileColumns(map, points, quantity, places, described) {
  const names = pointNames(map, points);
  const { unit, digits } = places[0].variable;
  return [
    ...described,
    ...points.map((index, n) => ({
      name: [quantity, names[n]].filter(Boolean).join(" at "),
      unit,
      digits,
      values: places.map(({ variable }) => map.value(variable, index)),
    })),
  ];
}

const mostShapes = 6;

// The shapes of the first modes at the masses of the profile: [{mode, frequency, damping, shape}].
export function profileModes(group, profile) {
  const order = group.texts.masses.split(",");
  const places = profile.masses.map((mass) => order.indexOf(mass));
  const [frequency, damping] = [group.values("mode_frequency"), group.values("mode_damping")];
  return Array.from(frequency.slice(0, mostShapes), (omega, k) => {
    const all = group.values(`mode_shape_${k + 1}`);
    return { mode: k + 1, frequency: omega, damping: damping[k], shape: places.map((i) => all[i]) };
  });
}
