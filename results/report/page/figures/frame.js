// The common look of all figures on screen, in files and on paper, drawn by Observable Plot.
//
// A figure is {name, title, caption, draw(canvas), table()}:
//   name     of its files, [a-z0-9_]+
//   draw     returns an SVG element.  canvas: {width, height, document, image, interactive}; image(width, height,
//            rgba) gives a picture's data URL
//   table    its numbers, for a CSV file: [{name, unit, values}], in the units of the record
import * as Plot from "@observablehq/plot";
import { extent, format, formatDefaultLocale, nice, tickFormat, ticks } from "d3";
import { powerText, powerTicks } from "./power_ticks.js";
import { digitWidth, fontSize, textWidth, wrapped } from "./text_lines.js";

formatDefaultLocale({ decimal: ".", thousands: "\u2009", grouping: [3], currency: ["", ""] }); // as SI writes

const fontFamily = "system-ui, -apple-system, 'Segoe UI', 'DejaVu Sans', Arial, sans-serif";
const lineHeight = 18;

// Okabe and Ito's colours, safe for the colour-blind; no black and no yellow, for dark and for light pages.
export const lineColours = [
  "#0072B2",
  "#D55E00",
  "#009E73",
  "#CC79A7",
  "#E69F00",
  "#56B4E9",
  "#8C6D31",
  "#7F7F7F",
];
export const lineDashes = ["", "6 3", "2 2", "8 3 2 3", "4 4", "1 3", "10 4", "3 5"];

// Colours of a contact's regimes, the same in all figures; not_computed has none.
export const regimeColours = {
  no_friction: "#9A9A9A",
  non_stop: "#0072B2",
  one_stop: "#E69F00",
  multi_stop: "#D55E00",
  stuck: "#6F4E9B",
};

// Legend entries in rows that fit the width; a longer entry takes rows of its own.
function legendRows(legend, width) {
  const rows = [[]];
  let used = 0;
  for (const entry of legend) {
    const lines = wrapped(entry.text, width - 30);
    const needed = 30 + textWidth(lines[0]) + 14;
    if (used > 0 && (used + needed > width || lines.length > 1)) {
      rows.push([]);
      used = 0;
    }
    rows.at(-1).push({ ...entry, text: lines[0], x: used });
    for (const text of lines.slice(1)) rows.push([{ text, x: 0 }]);
    used = lines.length > 1 ? width : used + needed;
  }
  return rows;
}

export function svgElement(document, name, attributes, text) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
  if (text !== undefined) element.appendChild(document.createTextNode(text));
  return element;
}

// The legend above the frame: a stroke (or a filled square) and its words.
function legendMark(rows, marginLeft) {
  return (index, scales, values, dimensions, { document }) => {
    const group = svgElement(document, "g", {
      "aria-label": "legend",
      "text-anchor": "start",
      fill: "currentColor",
    });
    rows.forEach((row, r) => {
      for (const { x, text, stroke, dash = "", fill, symbol } of row) {
        const left = marginLeft + x,
          middle = 10 + r * lineHeight;
        if (fill)
          group.appendChild(
            svgElement(document, "rect", {
              x: left + 6,
              y: middle - 5,
              width: 12,
              height: 10,
              fill,
              stroke: "none",
            }),
          );
        if (symbol)
          group.appendChild(
            svgElement(document, "circle", {
              cx: left + 11,
              cy: middle,
              r: 4,
              fill: symbol === "open" ? "none" : stroke,
              stroke,
              "stroke-width": 1.5,
            }),
          );
        if (stroke && !symbol)
          group.appendChild(
            svgElement(document, "path", {
              d: `M${left},${middle}h22`,
              stroke,
              "stroke-width": 2,
              "stroke-dasharray": dash,
              fill: "none",
            }),
          );
        group.appendChild(
          svgElement(document, "text", { x: left + 28, y: middle, dy: "0.32em", stroke: "none" }, text),
        );
      }
    });
    return group;
  };
}

const ticksLength = 5,
  labelLineHeight = 15;
const besideTicks = 40; // the label and its gaps

const mostNameCharacters = 24;

// A long name by its beginning and its end.
function shortName(name) {
  const half = mostNameCharacters / 2;
  return name.length <= mostNameCharacters ? name : `${name.slice(0, half - 1)}\u2026${name.slice(1 - half)}`;
}

// Ticks of an axis over 0, 1, ... whose values have names: as many as have room, each `room` pixels.
export function nameTicks(names, length, room = 16) {
  const each = Math.max(1, Math.ceil((names.length * room) / Math.max(1, length)));
  return {
    ticks: names.map((_, i) => i).filter((i) => i % each === 0),
    tickFormat: (i) => shortName(names[i] ?? ""),
  };
}

// Names below an axis stand upright, and need room for their length.
function upright(x) {
  if (!x.areNames) return { rotation: {}, more: 0 };
  const longest = Math.max(...x.ticks.map((tick) => x.tickFormat(tick).length));
  return { rotation: { tickRotate: -90 }, more: Math.max(0, digitWidth * longest - 10) };
}

const formatOf = (scale) => scale.tickFormat ?? (scale.type === "log" ? "~g" : undefined);

// A logarithmic axis over a known domain has ticks at powers of ten.
function withPowers(axis) {
  if (axis.type !== "log" || !axis.domain || axis.ticks) return axis;
  return { ticks: powerTicks(axis.domain), tickFormat: powerText(axis.domain), ...axis };
}

// Room at the left for the numbers of an axis and its label.
function leftMargin(axis, height) {
  const [low, high] = axis.domain ?? [];
  if (typeof low !== "number" || axis.type === "band") return 0;
  const count = Math.max(2, height / 40),
    given = formatOf(axis),
    logarithmic = axis.type === "log";
  const powers = () => [low, high].map((end) => 10 ** Math.round(Math.log10(end)));
  const places = Array.isArray(axis.ticks) ? axis.ticks : logarithmic ? powers() : ticks(low, high, count);
  const text =
    typeof given === "function" ? given : logarithmic ? format(given) : tickFormat(low, high, count, given);
  return besideTicks + digitWidth * Math.max(0, ...places.map((place) => String(text(place)).length));
}

// One pair of axes in a frame. x, y: Plot's scale options and {label}; legend: [{text, stroke, dash, fill, symbol}].
// Labels longer than their axis take several lines.
export function drawFrame(
  canvas,
  { x: xAxis, y: yAxis, marks, legend = [], marginRight = 20, marginLeft: leastLeft = 68, scales = {} },
) {
  const x = withPowers(xAxis),
    y = withPowers(yAxis);
  const marginLeft = Math.max(leastLeft, leftMargin(y, canvas.height));
  const yLabel = wrapped(y.label ?? "", canvas.height - 60),
    yMore = (yLabel.length - 1) * labelLineHeight;
  const xLabel = wrapped(x.label ?? "", canvas.width - marginLeft - marginRight - yMore);
  const xMore = (xLabel.length - 1) * labelLineHeight;
  const { rotation, more } = upright(x);
  const rows = legend.length ? legendRows(legend, canvas.width - marginLeft - marginRight - yMore) : [];
  const axis = (options) => ({ nice: false, ...options });
  const tickOptions = {
    labelAnchor: "center",
    labelArrow: "none",
    tickSize: ticksLength,
    tickPadding: 4,
    fontSize,
  };
  const svg = Plot.plot({
    document: canvas.document,
    width: canvas.width,
    height: canvas.height + rows.length * lineHeight + xMore + more,
    marginLeft: marginLeft + yMore,
    marginRight,
    marginTop: 14 + rows.length * lineHeight,
    marginBottom: 46 + xMore + more,
    x: axis({ ...x, label: null }),
    y: axis({ ...y, label: null }),
    ...scales,
    marks: [
      ...marks,
      Plot.frame({ stroke: "currentColor", strokeWidth: 1 }),
      Plot.axisX({
        ...tickOptions,
        label: xLabel.join("\n"),
        labelOffset: 38 + xMore + more,
        ...rotation,
        tickFormat: formatOf(x),
        ticks: x.ticks,
        tickSpacing: 70,
      }),
      Plot.axisY({
        ...tickOptions,
        label: yLabel.join("\n"),
        labelOffset: marginLeft - 10 + yMore,
        tickFormat: formatOf(y),
        ticks: y.ticks,
        tickSpacing: 40,
      }),
      ...(rows.length ? [legendMark(rows, marginLeft + yMore)] : []),
    ],
  });
  svg.setAttribute("font-family", fontFamily);
  svg.setAttribute("font-size", fontSize);
  return svg;
}

// The faint lines behind curves, at the ticks given or where ticks are by default.
export function grid(x = {}, y = {}) {
  return [
    Plot.gridX({ strokeOpacity: 0.12, tickSpacing: 70, ticks: x.ticks }),
    Plot.gridY({ strokeOpacity: 0.12, tickSpacing: 40, ticks: y.ticks }),
  ];
}

const leastSpread = 1e-4; // below it the labels of an axis would need too many digits

// Axis options for these values: round ends, and a margin around nearly equal values.
export function roomFor(values) {
  const [low, high] = extent(values.filter(Number.isFinite));
  const size = Math.max(Math.abs(low), Math.abs(high));
  if (!(low <= high)) return { domain: [0, 1] };
  if (size === 0) return { domain: [-1, 1], ticks: [0] };
  if (high - low > leastSpread * size) return { domain: nice(low, high, 8) };
  const middle = (low + high) / 2;
  return { domain: [middle - 0.01 * size, middle + 0.01 * size] };
}

// A line through (x[i], y[i]), broken where y is no number.
export function curve(x, y, options = {}) {
  const points = Array.from(x, (value, i) => [value, Number.isFinite(y[i]) ? y[i] : NaN]);
  return Plot.line(points, { strokeWidth: 1.6, strokeLinecap: "butt", ...options });
}

export function dots(x, y, options = {}) {
  const points = Array.from(x, (value, i) => [value, y[i]]).filter(([, value]) => Number.isFinite(value));
  return Plot.dot(points, { r: 3, ...options });
}

// Shows x and y of the curve point nearest to the pointer, on an interactive canvas. rows: [{x, y, text}].
export function tips(canvas, rows) {
  if (!canvas.interactive) return [];
  return [
    Plot.tip(
      rows,
      Plot.pointer({ x: "x", y: "y", title: "text", fontSize, fill: "var(--card, white)", lineHeight: 1.3 }),
    ),
  ];
}

// A valid file name made from any text.
export function fileName(text) {
  return text.replaceAll(/[^A-Za-z0-9_]+/g, "_");
}
