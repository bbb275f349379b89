// The quantiles of a quantity along an axis of the map: a band from the lowest to the highest, and so on inwards, the
// median as a line, and the interval of each quantile.
import * as Plot from "@observablehq/plot";
import { extent } from "d3";
import { axisLabel, axisScale } from "../axes.js";
import { numberText, shownUnit, withUnit, words } from "../units.js";
import { curve, drawFrame, fileName, grid, tips } from "./frame.js";
import { style } from "./line_figure.js";

const shareName = (share) => `${numberText(100 * share, 4)} %`;
const colour = style(0).stroke,
  ofIntervals = style(1).stroke;

// [[lower, upper], ...] from outside to inside; the middle one of an odd number has no partner.
function pairsOf(lines) {
  return lines.slice(0, Math.floor(lines.length / 2)).map((line, i) => [line, lines[lines.length - 1 - i]]);
}

function area(x, low, high, options) {
  const rows = Array.from(x, (at, i) => ({ at, low: low[i], high: high[i] })).map((row) =>
    Number.isFinite(row.low) && Number.isFinite(row.high) ? row : { at: row.at, low: NaN, high: NaN },
  );
  return Plot.areaY(rows, { x: "at", y1: "low", y2: "high", ...options });
}

function legendOf(lines) {
  const middle = lines.length % 2 ? lines[(lines.length - 1) / 2] : null;
  return [
    ...(middle
      ? [{ text: middle.share === 0.5 ? "median" : `${shareName(middle.share)} quantile`, stroke: colour }]
      : []),
    ...pairsOf(lines).map(([low, high]) => ({
      text: `${shareName(low.share)} to ${shareName(high.share)}`,
      fill: colour,
    })),
    { text: "95 % interval of each quantile", fill: ofIntervals },
  ];
}

function draw(canvas, { map, variable, axis, coordinate, lines }) {
  const finite = lines.flatMap(({ value }) => Array.from(value).filter(Number.isFinite));
  const { factor, text } = shownUnit(variable.unit, finite);
  const drawn = lines.map(({ share, ...of }) => {
    const scaled = Object.entries(of).map(([name, values]) => [name, values.map((value) => value * factor)]);
    return { share, ...Object.fromEntries(scaled) };
  });
  const label = withUnit(words(variable.name), text),
    x = coordinate.values;
  const ends = extent(
    drawn.flatMap(({ value, low, high }) => [...value, ...low, ...high]).filter(Number.isFinite),
  );
  const domain = finite.length ? [Math.min(0, ends[0]), Math.max(0, ends[1])] : [0, 1];
  const rows = drawn.flatMap(({ share, value, low, high }) =>
    Array.from(x, (at, i) => ({
      x: at,
      y: value[i],
      text: `${numberText(at)}\n${shareName(share)} quantile ${numberText(value[i])}\n95 % interval ${numberText(low[i])} to ${numberText(high[i])}`,
    })).filter(({ y }) => Number.isFinite(y)),
  );
  const middle = drawn.length % 2 ? [drawn[(drawn.length - 1) / 2]] : [];
  return drawFrame(canvas, {
    x: { label: axisLabel(map, map.axes[axis], coordinate), type: axisScale(x), domain: extent(x) },
    y: { label, domain: domain[1] > domain[0] ? domain : [0, 1], nice: true },
    legend: legendOf(lines),
    marks: [
      ...pairsOf(drawn).map(([low, high]) =>
        area(x, low.value, high.value, { fill: colour, fillOpacity: 0.18 }),
      ),
      ...drawn.map(({ low, high }) => area(x, low, high, { fill: ofIntervals, fillOpacity: 0.4 })),
      ...grid(),
      ...middle.map(({ value }) => curve(x, value, { stroke: colour })),
      ...tips(canvas, rows),
    ],
  });
}

function tableOf({ map, variable, axis, lines }) {
  const columns = map.axes[axis].coordinates.map(({ name, unit, values }) => ({ name, unit, values }));
  for (const { suffix, value, low, high } of lines) {
    for (const [end, values] of Object.entries({ "": value, _low: low, _high: high }))
      columns.push({ name: variable.name + suffix + end, unit: variable.unit, values });
  }
  return columns;
}

// spec(): {map, variable, axis, coordinate, lines: [{share, suffix, value, low, high}] along the axis}, as now shown.
export function quantileBands({ title, caption, spec }) {
  return {
    get name() {
      return fileName(`quantiles_${spec().variable.name}`);
    },
    get title() {
      return title();
    },
    get caption() {
      return caption();
    },
    draw: (canvas) => {
      const { lines, ...others } = spec();
      return draw(canvas, { ...others, lines: lines.map(({ suffix, ...line }) => line) });
    },
    table: () => tableOf(spec()),
  };
}
