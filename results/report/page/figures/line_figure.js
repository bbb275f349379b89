// A figure of curves, points, bands and levels over one pair of axes, with its legend, tips and CSV.
import * as Plot from "@observablehq/plot";
import { axisUnit, numberText, shownUnit, withUnit } from "../units.js";
import { drawFrame, fileName, grid, lineColours, lineDashes, tips } from "./frame.js";
import { tableOf } from "./line_table.js";
import { thinnedHistory, thinnedPath } from "./line_thinning.js";
import { powerText, powerTicks } from "./power_ticks.js";

const marginLeft = 68,
  marginRight = 20;
const leastSpan = 1e-3; // of an axis, relative to its numbers: a smaller span is drawn as level
const mostEdged = 200; // bands that have lines at their edges
const mostDots = 3000; // that are all drawn
const pathTolerance = 0.2; // pixels
const dashesOf = (number) => lineDashes[number % lineDashes.length];

// The style of curve number i: colour and dashes differ, so that curves are distinct in black and white too.
export function style(number) {
  return { stroke: lineColours[number % lineColours.length], dash: dashesOf(number) };
}

function* valuesOf(spec, axis) {
  for (const { [axis]: values } of [...(spec.lines ?? []), ...(spec.points ?? [])]) yield* values;
  if (axis === "y") for (const { y } of spec.levels ?? []) yield y;
}

// Least and greatest number in `unit`, with a margin; includes zero if the axis asks for it.
function domainOf(spec, axis) {
  const { type, zero, tight, domain, decades = 14 } = spec[axis];
  if (domain) return domain;
  let low = Infinity,
    high = -Infinity;
  for (const value of valuesOf(spec, axis)) {
    if (!Number.isFinite(value) || (type === "log" && value <= 0)) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (low > high || (zero && low === 0 && high === 0)) return type === "log" ? [1, 10] : [0, 1];
  if (tight && high > low) return [low, high];
  if (type === "log") return [Math.max(low, high * 10 ** -decades) / 1.3, high * 1.3];
  if (zero) [low, high] = [Math.min(low, 0), Math.max(high, 0)];
  const room = (high - low) * 0.05 || Math.abs(high) * 0.05 || 0.5;
  const least = leastSpan * Math.max(Math.abs(low), Math.abs(high)),
    more = Math.max(0, least - (high - low)) / 2;
  [low, high] = [low - more, high + more];
  return [zero && low === 0 ? 0 : low - room, zero && high === 0 ? 0 : high + room];
}

function shownAxis(spec, axis) {
  const { label, unit, type = "linear", ticks, tickFormat } = spec[axis];
  const inUnit = domainOf(spec, axis);
  const { factor, text } = type === "log" ? shownUnit(unit, inUnit) : axisUnit(unit, inUnit);
  const domain = inUnit.map((value) => value * factor);
  const logarithmic =
    type === "log" ? { ticks: powerTicks(domain), tickFormat: powerText(domain) } : { ticks, tickFormat };
  return { factor, unit: text, options: { label: withUnit(label, text), type, domain, ...logarithmic } };
}

function thinnedLine(line, canvas, x, y) {
  const columns = canvas.width - marginLeft - marginRight;
  if (!line.path) return thinnedHistory(line.x, line.y, columns);
  const extent = ({ options, factor }, pixels) => (pixels * factor) / (options.domain[1] - options.domain[0]);
  return thinnedPath(
    line.x,
    line.y,
    { x: extent(x, columns), y: extent(y, canvas.height - 60) },
    pathTolerance,
  );
}

function scaled(values, { factor, options }) {
  return Array.from(values, (value) => (options.type === "log" && value <= 0 ? NaN : value * factor));
}

function lineMark(line, canvas, x, y) {
  const thin = thinnedLine(line, canvas, x, y);
  const xs = scaled(thin.x, x),
    ys = scaled(thin.y, y);
  return Plot.line(
    xs.map((value, i) => [value, ys[i]]),
    {
      stroke: line.stroke,
      strokeWidth: line.width ?? 1.6,
      strokeDasharray: line.dash || undefined,
      strokeOpacity: line.opacity,
      clip: "frame",
      curve: line.curve,
    },
  );
}

const isWithin = (value, [low, high]) => value >= low && value <= high;

// Dots of a history drawn without lines are in the order of x, and are thinned as lines are.
function pointMark(points, canvas, x, y) {
  const many = points.x.length > mostDots;
  const thin = many ? thinnedHistory(points.x, points.y, canvas.width - marginLeft - marginRight) : points;
  const xs = scaled(thin.x, x),
    ys = scaled(thin.y, y);
  const places = xs
    .map((value, i) => [value, ys[i]])
    .filter(([a, b]) => isWithin(a, x.options.domain) && isWithin(b, y.options.domain));
  const open = points.symbol === "open";
  return Plot.dot(places, {
    r: points.r ?? 3.2,
    stroke: points.stroke,
    strokeWidth: 1.4,
    fill: open ? "none" : points.stroke,
  });
}

// Intervals of x over the whole height.
function bandMark(band, x) {
  const spans = Array.from(band.from, (from, i) => ({ from: from * x.factor, to: band.to[i] * x.factor }));
  return Plot.rectX(spans, {
    x1: "from",
    x2: "to",
    fill: band.fill,
    fillOpacity: 0.16,
    stroke: band.fill,
    strokeOpacity: spans.length > mostEdged ? 0 : 0.3,
    clip: "frame",
  });
}

function levelMark(level, y) {
  return Plot.ruleY([level.y * y.factor], {
    stroke: level.stroke ?? "currentColor",
    strokeDasharray: level.dash ?? "4 3",
    strokeWidth: 1.2,
  });
}

function momentMark(moment, x) {
  return Plot.ruleX([moment.x * x.factor], {
    stroke: moment.stroke ?? "currentColor",
    strokeDasharray: moment.dash,
    strokeWidth: 1.2,
  });
}

function tipRows(spec, canvas, x, y) {
  const say = (axis, value, shown) =>
    `${axis.label} ${numberText(value)}${shown.unit ? ` ${shown.unit}` : ""}`;
  return [...(spec.lines ?? []), ...(spec.points ?? [])]
    .filter(({ silent }) => !silent)
    .flatMap((drawn) => {
      const thin = spec.lines?.includes(drawn) ? thinnedLine(drawn, canvas, x, y) : drawn;
      const xs = scaled(thin.x, x),
        ys = scaled(thin.y, y);
      return xs
        .map((value, i) => ({
          x: value,
          y: ys[i],
          text: [drawn.text ?? drawn.name, say(spec.x, value, x), say(spec.y, ys[i], y)].join("\n"),
        }))
        .filter((row) => Number.isFinite(row.x) && Number.isFinite(row.y));
    });
}

function drawLines(canvas, spec) {
  const x = shownAxis(spec, "x"),
    y = shownAxis(spec, "y");
  const { lines = [], points = [], bands = [], levels = [], moments = [] } = spec;
  const legend = [
    ...lines.filter(({ text }) => text).map(({ text, stroke, dash }) => ({ text, stroke, dash })),
    ...[...levels, ...moments]
      .filter(({ text }) => text)
      .map(({ text, stroke = "currentColor", dash = "4 3" }) => ({ text, stroke, dash })),
    ...points
      .filter(({ text }) => text)
      .map(({ text, stroke, symbol = "full" }) => ({ text, stroke, symbol })),
    ...bands.filter(({ text }) => text).map(({ text, fill }) => ({ text, fill })),
  ];
  return drawFrame(canvas, {
    x: x.options,
    y: y.options,
    legend,
    marginLeft,
    marginRight,
    marks: [
      ...bands.map((band) => bandMark(band, x)),
      ...grid(x.options, y.options),
      ...levels.map((level) => levelMark(level, y)),
      ...moments.map((moment) => momentMark(moment, x)),
      ...lines.map((line) => lineMark(line, canvas, x, y)),
      ...points.map((point) => pointMark(point, canvas, x, y)),
      ...tips(canvas, canvas.interactive ? tipRows(spec, canvas, x, y) : []),
    ],
  });
}

// spec: {name, title, caption, ratio,
//   x, y: {label, name, unit, type: "linear" or "log", zero, tight, domain, ticks, tickFormat,
//          decades: at most so many of a logarithmic axis},
//   lines: [{name, text, x, y, stroke, dash, width, path}]  text: in the legend; path: x does not rise
//   points: [{name, text, x, y, stroke, symbol}]             symbol: "open" or "full"
//   bands: [{text, from, to, fill}], levels: [{text, y, stroke, dash}], moments: [{text, x, stroke, dash}]}
// A `silent` item has neither tip nor CSV column. Numbers in the units named; lengths and forces are drawn with
// prefixes.
export function lineFigure(spec) {
  const { name, title, caption, ratio } = spec;
  return {
    name: fileName(name),
    title,
    caption,
    ratio,
    draw: (canvas) => drawLines(canvas, spec),
    table: () => tableOf(spec),
  };
}
