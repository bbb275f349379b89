// Response curves: a quantity along one axis through one or several points of the map.
import * as Plot from "@observablehq/plot";
import { coordinateLabel, coordinateText, spacing } from "../axes.js";
import { meaningOf } from "../record.js";
import { numberText, shownUnit, unitText, withUnit, words } from "../units.js";
import { curve, dots, drawFrame, grid, lineColours, lineDashes, regimeColours, tips } from "./frame.js";

const fewPoints = 40; // up to so many, each is marked

// What tells a curve from the others: the coordinates in which the points differ, else all of them.
export function curveName(map, index, axis, all) {
  const others = map.axes.map((_, a) => a).filter((a) => a !== axis && map.axes[a].size > 1);
  const differ = others.filter((a) => all.some((other) => other[a] !== index[a]));
  return (differ.length ? differ : others)
    .map((a) => coordinateText(map.axes[a].coordinates[0], index[a]))
    .join(", ");
}

// Runs of equal regime along a line; each reaches the first point of the next, so that no gap stands between.
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

// state: {axis, coordinate, scale: "linear", "log" or "dB", points: [index], regime: variable or undefined}.
export function responseCurves(canvas, map, variable, state) {
  const x = map.axes[state.axis].coordinates[state.coordinate];
  const lines = state.points.map((index) => map.line(variable, index, state.axis));
  const shown = shownUnit(
    variable.unit,
    lines.flatMap((line) => Array.from(line)),
  );
  const factor = state.scale === "dB" ? 1 : shown.factor;
  const values = lines.map((line) => line.map((value) => onScale(state.scale, value) * factor));
  const marks = [],
    legend = [],
    rows = [],
    seen = new Set();
  values.forEach((y, n) => {
    const stroke = lineColours[n % lineColours.length],
      dash = state.regime ? lineDashes[n % lineDashes.length] : "";
    const name = curveName(map, state.points[n], state.axis, state.points);
    if (state.regime) {
      for (const { word, from, to } of regimeRuns(map, state.regime, state.points[n], state.axis)) {
        const colour = regimeColours[word] ?? "#9A9A9A";
        seen.add(word);
        marks.push(
          curve(x.values.slice(from, to + 1), y.slice(from, to + 1), {
            stroke: colour,
            strokeDasharray: dash,
            strokeWidth: 2.2,
          }),
        );
        if (to === from) marks.push(dots([x.values[from]], [y[from]], { fill: colour, r: 2 }));
      }
      if (values.length > 1) legend.push({ text: name, stroke: "currentColor", dash });
    } else {
      marks.push(curve(x.values, y, { stroke }));
      if (values.length > 1) legend.push({ text: name, stroke });
    }
    if (y.length <= fewPoints && !state.regime) marks.push(dots(x.values, y, { fill: stroke }));
    y.forEach((value, i) => {
      if (Number.isFinite(value))
        rows.push({
          x: x.values[i],
          y: value,
          text: `${coordinateText(x, i)}\n${yLabel(variable, state.scale, shown)}: ${numberText(value)}${values.length > 1 ? `\n${name}` : ""}`,
        });
    });
  });
  const regimes = [...seen]
    .filter((word) => regimeColours[word])
    .map((word) => ({ text: words(word), stroke: regimeColours[word] }));
  const low = Math.min(...values.map((y) => Math.min(...y.filter((value) => value > 0))));
  const scaled =
    state.scale === "log" && Number.isFinite(low)
      ? { type: "log", domain: logDomain(values, low) }
      : { zero: state.scale === "linear" };
  return drawFrame(canvas, {
    x: {
      label: coordinateLabel(x),
      type: spacing(x.values) === "log" ? "log" : "linear",
      domain: [Math.min(...x.values), Math.max(...x.values)],
    },
    y: { label: yLabel(variable, state.scale, shown), nice: state.scale !== "log", ...scaled },
    legend: [...legend, ...regimes],
    marks: rows.length
      ? [...grid(), ...marks, ...tips(canvas, rows)]
      : [Plot.text(["no number along this line"], { frameAnchor: "middle", fontSize: 13 })],
  });
}

// At most six powers of ten below the largest.
function logDomain(values, low) {
  const high = Math.max(...values.map((y) => Math.max(...y.filter(Number.isFinite))));
  const from = Math.max(low, high * 1e-6);
  return from < high ? [from / 1.15, high * 1.15] : [from / 2, from * 2];
}

export function responseCurvesTable(map, variable, state) {
  const axis = map.axes[state.axis];
  const columns = axis.coordinates.map(({ name, unit, values }) => ({ name, unit, values }));
  state.points.forEach((index) => {
    const name =
      state.points.length > 1
        ? `${variable.name} at ${curveName(map, index, state.axis, state.points)}`
        : variable.name;
    columns.push({ name, unit: variable.unit, values: map.line(variable, index, state.axis) });
    if (!state.regime) return;
    const regime = Array.from(map.line(state.regime, index, state.axis), (value) =>
      meaningOf(state.regime, value),
    );
    columns.push({
      name: `${state.regime.name}${state.points.length > 1 ? ` ${columns.length}` : ""}`,
      unit: "",
      values: regime,
    });
  });
  return columns;
}
