// A quantity over two axes of the map, as coloured cells, with the borders of a contact's regimes over it.
import * as Plot from "@observablehq/plot";
import { extent, rgb } from "d3";
import { axisLabel, axisScale, cellEdges, coordinateColumns, spacing } from "../axes.js";
import { borderCurves } from "../borders.js";
import { isMissing, meaningOf } from "../record.js";
import { shownUnit, withUnit, words } from "../units.js";
import { valueRange } from "../value_range.js";
import { colourBar, colourBarMargin } from "./colour_bar.js";
import { colourSteps, colourTable, flagColours, missingColour } from "./colours.js";
import { drawFrame, nameTicks, svgElement } from "./frame.js";

const resampled = 480; // cells of an axis whose values lie unevenly

// The grid index of each cell of the picture: its own, or that of the nearest point on an uneven axis.
function cellPoints({ values, isEven, scale }) {
  if (isEven) return Array.from(values, (_, i) => i);
  const to = scale === "log" ? Math.log : (value) => value;
  const edges = cellEdges(values, scale).map(to),
    low = edges[0],
    high = edges.at(-1);
  const cells = [];
  for (let c = 0, i = 0; c < resampled; ++c) {
    const at = low + ((high - low) * (c + 0.5)) / resampled;
    const passed = (edge) => (high > low ? at > edge : at < edge);
    while (i + 1 < values.length && passed(edges[i + 1])) ++i;
    cells.push(i);
  }
  return cells;
}

function painterOf(variable, range, state) {
  if (variable.kind === "flag") {
    const colours = flagColours(variable);
    return (value, rgba, at) => {
      const found = colours.get(value);
      const { r, g, b } = rgb(found?.colour ?? "black");
      rgba.set(found ? [r, g, b, 255] : missingColour, at);
    };
  }
  const table = colourTable(state.colours ?? "viridis");
  const to = state.scale === "log" ? Math.log : (value) => value;
  const low = to(range[0]),
    span = to(range[1]) - low || 1;
  return (value, rgba, at) => {
    if (isMissing(variable, value)) return rgba.set(missingColour, at);
    const place = (to(Math.max(value, range[0])) - low) / span;
    const step = 4 * Math.max(0, Math.min(colourSteps - 1, Math.round(place * (colourSteps - 1))));
    for (let c = 0; c < 4; ++c) rgba[at + c] = table[step + c];
  };
}

const logSpan = 1e-4; // of the largest value: smaller ones have the lowest colour on a logarithmic scale

// The lower end of a logarithmic scale of colours.
export function leastOfLogarithm(variable) {
  const { leastPositive, high } = valueRange(variable);
  return Math.max(leastPositive, high * logSpan);
}

// The colour range of the whole map, so that all slider positions share one scale. scale: "linear" or "log".
function colourRange(variable, scale) {
  const { low: least, high } = valueRange(variable);
  if (!(least <= high)) return [0, 1];
  const low = scale === "log" ? leastOfLogarithm(variable) : least;
  if (low < high) return [low, high];
  if (low === 0) return [0, 1];
  const room = Math.abs(low) / 2;
  return [low - room, high + room];
}

// The picture of the cells, first row at the top: y falls downwards.
function picture(canvas, map, variable, state, axes, paint) {
  const columns = cellPoints(axes.x),
    rows = cellPoints(axes.y);
  const flipX = axes.x.values.at(-1) < axes.x.values[0],
    flipY = axes.y.values.at(-1) < axes.y.values[0];
  if (flipX) columns.reverse();
  if (!flipY) rows.reverse();
  const base = map.offset(state.index.map((i, a) => (a === state.x || a === state.y ? 0 : i)));
  const rgba = new Uint8ClampedArray(4 * columns.length * rows.length);
  let at = 0;
  for (const row of rows) {
    const from = base + row * map.axes[state.y].stride;
    for (const column of columns) {
      paint(variable.values[from + column * map.axes[state.x].stride], rgba, at);
      at += 4;
    }
  }
  return canvas.image(columns.length, rows.length, rgba);
}

function axisOf(map, axis, coordinate) {
  const { values } = coordinate;
  const scale = axisScale(values);
  const edges = cellEdges(values, scale);
  return {
    values,
    names: coordinate.names,
    isEven: spacing(values) !== "",
    label: axisLabel(map, map.axes[axis], coordinate),
    scale,
    edges: [edges[0], edges.at(-1)],
    domain: extent(coordinate.names || values.length === 1 ? edges : values),
  };
}

// Names of records at their places on an axis of so many pixels.
function namesAt({ names }, pixels) {
  return names ? { ...nameTicks(names, pixels), areNames: true } : {};
}

// The cells reach half a cell beyond the first and the last point; the frame, which ends there, cuts them.
function pictureMark(url, axes) {
  return (index, scales, values, dimensions, { document }) => {
    const { marginLeft, marginTop, width, height, marginRight, marginBottom } = dimensions;
    const frame = {
      x: marginLeft,
      y: marginTop,
      width: width - marginLeft - marginRight,
      height: height - marginTop - marginBottom,
    };
    const [left, right] = extent(axes.x.edges.map(scales.x)),
      [top, bottom] = extent(axes.y.edges.map(scales.y));
    const inside = svgElement(document, "svg", frame);
    inside.appendChild(
      svgElement(document, "image", {
        x: left - frame.x,
        y: top - frame.y,
        width: right - left,
        height: bottom - top,
        preserveAspectRatio: "none",
        href: url,
        style: "image-rendering: pixelated",
      }),
    );
    return inside;
  };
}

const borderDashes = {
  "non_stop|one_stop": "",
  "one_stop|multi_stop": "5 3",
  "non_stop|multi_stop": "2 2",
  "one_stop|stuck": "9 3",
  "non_stop|stuck": "9 3 2 3",
  "multi_stop|stuck": "1 2",
};

// The value at a fractional index, by linear interpolation.
export function valueAt(values, place) {
  const i = Math.min(Math.floor(place), values.length - 2);
  return values.length === 1 ? values[0] : values[i] + (place - i) * (values[i + 1] - values[i]);
}

function borderMarks(crossings, state, map, axes) {
  const curves = borderCurves(crossings, {
    x: state.x,
    y: state.y,
    index: state.index,
    nx: map.axes[state.x].size,
    ny: map.axes[state.y].size,
  });
  const line = ({ key, points }) =>
    points.map(([i, j]) => [valueAt(axes.x.values, i), valueAt(axes.y.values, j)]);
  const marks = curves.flatMap((curve) => [
    Plot.line(line(curve), { stroke: "white", strokeWidth: 3, strokeOpacity: 0.75 }),
    Plot.line(line(curve), {
      stroke: "black",
      strokeWidth: 1.3,
      strokeDasharray: borderDashes[curve.key] ?? "",
    }),
  ]);
  const keys = [...new Set(curves.map(({ key }) => key))].sort();
  const legend = keys.map((key) => ({
    text: key.split("|").map(words).join(" | "),
    stroke: "currentColor",
    dash: borderDashes[key] ?? "",
  }));
  return { marks, legend };
}

// The picked points with their numbers; points that differ only along other axes coincide.
function pickedMarks({ picked = [], x, y }, axes) {
  const places = new Map();
  picked.forEach((index, n) => {
    const place = `${index[x]},${index[y]}`;
    const before = places.get(place);
    places.set(place, {
      x: axes.x.values[index[x]],
      y: axes.y.values[index[y]],
      number: before ? `${before.number},${n + 1}` : String(n + 1),
    });
  });
  return [...places.values()];
}

// state: {x, y: axes; coordinates: of each axis which one; index: of all axes; scale: "linear", or "log" where the
// quantity suits it;
// crossings: of a contact's borders; picked: points marked, [index]}.
export function responseMap(canvas, map, variable, state) {
  const axes = {
    x: axisOf(map, state.x, map.axes[state.x].coordinates[state.coordinates[state.x]]),
    y: axisOf(map, state.y, map.axes[state.y].coordinates[state.coordinates[state.y]]),
  };
  const flag = variable.kind === "flag";
  const { scale } = state,
    range = colourRange(variable, scale);
  const shown = flag ? { factor: 1, text: "" } : shownUnit(variable.unit, range);
  const paint = painterOf(variable, range, state);
  const borders = borderMarks(state.crossings ?? [], state, map, axes);
  const regimes = flag
    ? [...flagColours(variable).values()].map(({ word, colour }) => ({ text: words(word), fill: colour }))
    : [];
  const picked = pickedMarks(state, axes);
  const bar = {
    label: withUnit(words(variable.name), shown.text),
    range: range.map((value) => value * shown.factor),
    look: { colours: state.colours, scale, isWhole: variable.kind === "count" },
  };
  const frameHeight = canvas.height - 80;
  return drawFrame(canvas, {
    x: {
      label: axes.x.label,
      type: axes.x.scale,
      domain: axes.x.domain,
      ...namesAt(axes.x, canvas.width - 180),
    },
    y: {
      label: axes.y.label,
      type: axes.y.scale,
      domain: axes.y.domain,
      ...namesAt(axes.y, canvas.height - 60),
    },
    legend: [...regimes, ...borders.legend],
    marginRight: flag ? 20 : colourBarMargin(bar.label, bar.range, bar.look, frameHeight),
    marks: [
      pictureMark(picture(canvas, map, variable, state, axes, paint), axes),
      ...borders.marks,
      Plot.dot(picked, { x: "x", y: "y", r: 7, fill: "white", stroke: "black", strokeWidth: 1.5 }),
      Plot.text(picked, {
        x: "x",
        y: "y",
        text: "number",
        fill: "black",
        stroke: "none",
        fontSize: 10,
        fontWeight: 700,
      }),
      ...(flag ? [] : [colourBar(canvas, bar.label, bar.range, bar.look)]),
    ],
  });
}

// All cells of the map shown, row by row, with every coordinate of each.
export function responseMapTable(map, variable, state) {
  const points = [];
  for (let j = 0; j < map.axes[state.y].size; ++j) {
    for (let i = 0; i < map.axes[state.x].size; ++i)
      points.push(state.index.map((k, a) => (a === state.x ? i : a === state.y ? j : k)));
  }
  const values = points.map((index) => map.value(variable, index));
  const isWord = variable.kind === "flag";
  return [
    ...coordinateColumns(map, points),
    {
      name: variable.name,
      unit: variable.unit,
      digits: variable.digits,
      values: isWord ? values.map((value) => meaningOf(variable, value)) : values,
    },
  ];
}
