// Response curves: a quantity along one axis through one or several points of the map.
import * as Plot from "@observablehq/plot";
import { extent, ticks } from "d3";
import { axisLabel, axisScale, axisText, coordinateColumns, coordinateText, symbolText } from "../axes.js";
import { branchColumns, branchCurve, branchesThrough, placesBy, specialPoints } from "../branches.js";
import { circumstance, comparedWith } from "../compared.js";
import { meaningOf } from "../record.js";
import { numberText, shownUnit, unitText, withUnit, words } from "../units.js";
import { branchLegend, branchLines, specialDots, specialTips } from "./branch_marks.js";
import {
  curve,
  dots,
  drawFrame,
  grid,
  lineColours,
  lineDashes,
  nameTicks,
  regimeColours,
  roomFor,
  tips,
} from "./frame.js";

const stepped = { curve: "step" }; // of whole numbers and flags: between two points nothing is known
const inset = 5; // pixels between the frame and zero
const fewPoints = 40; // up to so many, each is marked
const comparedDash = "1.5 3"; // dotted: what is unstable is dashed

// A curve's name: the coordinates in which the points differ, else all of them.
function curveName(map, index, axis, all) {
  const others = map.axes.map((_, a) => a).filter((a) => a !== axis && map.axes[a].size > 1);
  const differ = others.filter((a) => all.some((other) => other[a] !== index[a]));
  return (differ.length ? differ : others).map((a) => axisText(map, map.axes[a], index[a])).join(", ");
}

// Runs of equal regime along a line; each reaches the first point of the next, so that there is no gap.
function regimeRuns(map, regime, index, axis) {
  const words = Array.from(map.line(regime, index, axis), (value) => meaningOf(regime, value));
  const runs = [];
  for (let i = 0; i < words.length; ++i) {
    if (runs.length && runs.at(-1).word === words[i]) runs.at(-1).to = i;
    else runs.push({ word: words[i], from: i, to: i });
  }
  return runs.map((run, r) => ({ ...run, to: r + 1 < runs.length ? run.to + 1 : run.to }));
}

// A value on the scale asked for; dB are of the quantity's own unit.
function onScale(scale, value) {
  return scale === "dB" ? (value > 0 ? 20 * Math.log10(value) : NaN) : value;
}

function yLabel(variable, scale, shown) {
  const name = words(variable.name);
  return scale === "dB"
    ? `${name} (dB re 1${unitText(variable.unit) ? ` ${unitText(variable.unit)}` : ""})`
    : withUnit(name, shown.text);
}

// The colour and dash of curve n: from the ninth on the colours repeat with another dash.
function styleOf(n) {
  const round = Math.floor(n / lineColours.length);
  return {
    stroke: lineColours[n % lineColours.length],
    strokeDasharray: lineDashes[round % lineDashes.length],
  };
}

// One curve in the colours of its regimes.  Returns the marks; adds the regimes met to `seen`.
function marksByRegime(runs, x, y, dash, seen) {
  return runs.flatMap(({ word, from, to }) => {
    const colour = regimeColours[word] ?? "#9A9A9A";
    seen.add(word);
    const line = curve(x.slice(from, to + 1), y.slice(from, to + 1), {
      stroke: colour,
      strokeDasharray: dash,
      strokeWidth: 2.2,
    });
    return to > from ? [line] : [line, dots([x[from]], [y[from]], { fill: colour, r: 2 })];
  });
}

// Where the regime changes along a single curve: upright lines.
function borderRules(state) {
  if (state.points.length !== 1) return [];
  const rules = { stroke: "currentColor", strokeOpacity: 0.5, strokeDasharray: "3 3" };
  return [Plot.ruleX(state.borders ?? [], rules)];
}

// Options of the vertical axis.
function yAxis(variable, state, label, values) {
  if (variable.kind === "flag") {
    const known = variable.flags.map(([code]) => code).sort((a, b) => a - b);
    return {
      label,
      ticks: known,
      domain: [known[0] - 0.3, known.at(-1) + 0.3],
      tickFormat: (code) => words(meaningOf(variable, code)),
    };
  }
  const numbers = values.flatMap((y) => Array.from(y.filter(Number.isFinite)));
  if (!numbers.length) return { label, domain: [0, 1] };
  if (state.scale === "dB") return { label, ...roomFor(numbers) };
  const positive = numbers.filter((value) => value > 0);
  if (state.scale === "log" && positive.length) return { label, type: "log", domain: logDomain(positive) };
  const [low, high] = extent(numbers);
  const domain = [Math.min(0, low), Math.max(0, high)];
  const largest = Math.max(...domain.map(Math.abs));
  const asPowers = largest >= 1e5 || largest < 1e-2 ? { tickFormat: (tick) => numberText(tick) } : {};
  const shown = largest > 0 ? domain : [0, 1];
  const whole = variable.kind === "count" ? { ticks: ticks(...shown, 8).filter(Number.isInteger) } : {};
  return { label, domain: shown, nice: true, inset, ...asPowers, ...whole };
}

// Options of the horizontal axis; the names of records have room at both ends.
function xAxis(canvas, map, axis, coordinate) {
  const label = axisLabel(map, map.axes[axis], coordinate),
    { names, values } = coordinate;
  if (!names) return { label, type: axisScale(values), domain: extent(values) };
  return {
    label,
    domain: [-0.5, names.length - 0.5],
    areNames: true,
    ...nameTicks(names, canvas.width - 90),
  };
}

// For each point of the state the branches through it, on the scale of the figure; none of a quantity that they do not
// have.
function branchCurves(map, variable, state, x, factor) {
  const { followed } = state,
    quantity = followed?.group.column(variable.name);
  if (!quantity || quantity.kind !== "float") return state.points.map(() => []);
  const places = placesBy(followed, map.axes[state.axis], x),
    y = quantity.values.map((value) => onScale(state.scale, value) * factor);
  return state.points.map((index) =>
    branchesThrough(followed, map, state.axis, index).map((branch) =>
      branchCurve(followed, branch, places, y),
    ),
  );
}

const under = { strokeWidth: 6, strokeOpacity: 0.25 }; // the map's own curve, under branches

// state: {axis, coordinate, scale: "linear", "log" or "dB", points: [index], regime: variable or undefined,
// borders: where the regime changes along the axis, followed: branches (branches.js) or null}.
export function responseCurves(canvas, map, variable, state) {
  const x = map.axes[state.axis].coordinates[state.coordinate];
  const compared = state.regime ? undefined : comparedWith(map, variable);
  const drawn = compared ? [variable, compared] : [variable];
  const lines = drawn.flatMap((each) => state.points.map((index) => map.line(each, index, state.axis)));
  const all = lines.flatMap((line) => Array.from(line));
  const shown = shownUnit(variable.unit, all);
  const factor = state.scale === "dB" ? 1 : shown.factor;
  const values = lines.map((line) => line.map((value) => onScale(state.scale, value) * factor));
  const label = yLabel(variable, state.scale, shown);
  const branches = branchCurves(map, variable, state, x, factor);
  const marks = [],
    legend = [],
    rows = [],
    seen = new Set();
  values.slice(state.points.length).forEach((y, n) => {
    const style = { ...styleOf(n), strokeDasharray: comparedDash };
    marks.push(curve(x.values, y, style));
    rows.push(...tipRows(x, y, label, circumstance(compared, variable)));
  });
  if (compared) {
    legend.push({ text: words(variable.name), stroke: "currentColor" });
    legend.push({ text: circumstance(compared, variable), stroke: "currentColor", dash: comparedDash });
  }
  values.slice(0, state.points.length).forEach((y, n) => {
    const name = curveName(map, state.points[n], state.axis, state.points);
    const style = state.regime
      ? { stroke: "currentColor", strokeDasharray: lineDashes[n % lineDashes.length] }
      : styleOf(n);
    if (state.regime) {
      const runs = regimeRuns(map, state.regime, state.points[n], state.axis);
      marks.push(...marksByRegime(runs, x.values, y, style.strokeDasharray, seen));
    } else {
      const look = branches[n].length ? under : variable.kind === "float" ? {} : stepped;
      if (!x.names) marks.push(curve(x.values, y, { ...style, ...look })); // nothing lies between two records
      if (x.names || y.length <= fewPoints) marks.push(dots(x.values, y, { fill: style.stroke }));
    }
    marks.push(...branchLines(branches[n], style));
    const isOneOfMany = state.points.length > 1;
    if (isOneOfMany) legend.push({ text: name, stroke: style.stroke, dash: style.strokeDasharray });
    rows.push(...tipRows(x, y, label, isOneOfMany ? name : ""));
  });
  const regimes = [...seen]
    .filter((word) => regimeColours[word])
    .map((word) => ({ text: words(word), stroke: regimeColours[word] }));
  const followed = branches.flat(),
    special = specialPoints(followed);
  rows.push(...specialTips(special, symbolText(x.name), label));
  const nothing = [Plot.text(["no value along this line"], { frameAnchor: "middle", fontSize: 13 })];
  return drawFrame(canvas, {
    x: xAxis(canvas, map, state.axis, x),
    y: yAxis(variable, state, label, [...values, ...followed.map(({ y }) => y)]),
    legend: [...legend, ...regimes, ...branchLegend(followed)],
    marks: rows.length
      ? [...grid(), ...borderRules(state), ...marks, ...specialDots(special), ...tips(canvas, rows)]
      : nothing,
  });
}

function tipRows(x, y, label, name) {
  return Array.from(y, (value, i) => ({
    x: x.values[i],
    y: value,
    text: [coordinateText(x, i), `${label}: ${numberText(value)}`, name].filter(Boolean).join("\n"),
  })).filter(({ y: value }) => Number.isFinite(value));
}

// At most six powers of ten below the largest.
function logDomain(positive) {
  const [low, high] = extent(positive);
  const from = Math.max(low, high * 1e-6);
  return from < high ? [from / 1.15, high * 1.15] : [from / 2, from * 2];
}

// The branches of the curves side by side.
function branchTable(map, variable, state) {
  const quantity = state.followed?.group.column(variable.name);
  if (!quantity || quantity.kind !== "float") return [];
  return state.points
    .flatMap((index) => branchesThrough(state.followed, map, state.axis, index))
    .flatMap((branch, n) => branchColumns(state.followed, branch, quantity, ` of branch ${n + 1}`));
}

// The curves side by side, with the axis's coordinates; of a single one every coordinate of its points. Then the
// branches through them.
export function responseCurvesTable(map, variable, state) {
  const axis = map.axes[state.axis];
  const [first] = state.points;
  const alongFirst = Array.from({ length: axis.size }, (_, i) =>
    first.map((k, a) => (a === state.axis ? i : k)),
  );
  const single = state.points.length === 1;
  const columns = single
    ? coordinateColumns(map, alongFirst)
    : axis.coordinates.map(({ name, unit, values }) => ({ name, unit, values }));
  for (const index of state.points) {
    const others = map.axes.map((other, a) => (a === state.axis ? "" : axisText(map, other, index[a])));
    const suffix = single ? "" : ` at ${others.filter(Boolean).join(", ")}`;
    const { unit, digits } = variable;
    columns.push({
      name: variable.name + suffix,
      unit,
      digits,
      values: map.line(variable, index, state.axis),
    });
    const compared = state.regime ? undefined : comparedWith(map, variable);
    if (compared) {
      const values = map.line(compared, index, state.axis);
      columns.push({ name: compared.name + suffix, unit, digits, values });
    }
    if (!state.regime) continue;
    const regimes = Array.from(map.line(state.regime, index, state.axis));
    columns.push({
      name: state.regime.name + suffix,
      unit: "",
      values: regimes.map((value) => meaningOf(state.regime, value)),
    });
  }
  return [...columns, ...branchTable(map, variable, state)];
}
