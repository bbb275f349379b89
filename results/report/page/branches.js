// Branches of responses (group /branches), followed along a parameter: stable and unstable orbits and the special
// points between them.
import { fractionalIndex } from "./axes.js";
import { meaningOf } from "./record.js";

const rounding = 1e-9; // of units

const same = (a, b) => Math.abs(a - b) <= rounding * Math.max(Math.abs(a), Math.abs(b));

// {along: the parameter's name, x: its column, group, branches: [{values: of the other parameters by name, multiple,
// from, to: its rows}]}; null where the record has none.
export function branchesOf(record) {
  const group = record.groups.get("branches");
  const starts = group?.values("row_start");
  if (!starts?.length) return null;
  const x = group.column(group.texts.along),
    parameters = group.along("branch").filter(({ kind }) => kind === "float");
  const branches = Array.from(starts, (from, row) => ({
    values: new Map(parameters.map(({ name, values }) => [name, values[row]])),
    multiple: group.values("period_multiple")[row],
    from,
    to: row + 1 < starts.length ? starts[row + 1] : x.values.length,
  }));
  return { along: group.texts.along, x, group, branches };
}

// Those through a row of the map: the axis is that of their parameter, and the others have their values.
export function branchesThrough(followed, map, axis, index) {
  if (!followed || !map.axes[axis].coordinates.some(({ name }) => name === followed.along)) return [];
  const others = map.axes.flatMap(({ coordinates }, a) =>
    a === axis ? [] : coordinates.map(({ name, values }) => [name, values[index[a]]]),
  );
  return followed.branches.filter(({ values }) =>
    others.every(([name, value]) => !values.has(name) || same(values.get(name), value)),
  );
}

// A number between those of an axis at a fractional index.
function between(values, at) {
  const i = Math.min(Math.floor(at), values.length - 2);
  return values[i] + (at - i) * (values[i + 1] - values[i]);
}

// The places of the branches' parameter by another coordinate of its axis.
export function placesBy(followed, { coordinates }, coordinate) {
  if (coordinate.name === followed.along) return followed.x.values;
  const own = coordinates.find(({ name }) => name === followed.along);
  return followed.x.values.map((value) => between(coordinate.values, fractionalIndex(own.values, value)));
}

// One branch as drawn: {x, y, stable, special}, arrays along it; special: "fold" and such, or "".
export function branchCurve(followed, branch, x, y) {
  const part = (values) => values.slice(branch.from, branch.to);
  const { group } = followed;
  const words = (name) => Array.from(part(group.values(name)), (code) => meaningOf(group.column(name), code));
  return {
    x: part(x),
    y: part(y),
    stable: words("stability").map((word) => word === "stable"),
    special: words("special").map((word) => (word === "none" ? "" : word)),
  };
}

// Runs of equal stability; each reaches the first point of the next, so that there is no gap.
export function stabilityRuns({ stable }) {
  const runs = [];
  stable.forEach((is, i) => {
    if (runs.length && runs.at(-1).stable === is) runs.at(-1).to = i;
    else runs.push({ stable: is, from: i, to: i });
  });
  return runs.map((run, r) => ({ ...run, to: r + 1 < runs.length ? run.to + 1 : run.to }));
}

// The special points that have a place in the figure: [{x, y, kind}].
export function specialPoints(curves) {
  return curves.flatMap(({ x, y, special }) =>
    special
      .map((kind, i) => ({ x: x[i], y: y[i], kind }))
      .filter((point) => point.kind && Number.isFinite(point.y)),
  );
}

// Columns for a CSV file, of one branch: its parameter, a quantity, stability and special points.
export function branchColumns(followed, branch, quantity, suffix) {
  const part = branchCurve(followed, branch, followed.x.values, quantity.values);
  const column = ({ name, unit }, values) => ({ name: name + suffix, unit, values });
  return [
    column(followed.x, part.x),
    column(quantity, part.y),
    column(
      { name: "stability", unit: "" },
      part.stable.map((is) => (is ? "stable" : "unstable")),
    ),
    column({ name: "special", unit: "" }, part.special),
  ];
}
