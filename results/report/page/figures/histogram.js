// How the samples of a quantity are spread: a histogram with upright lines at its quantiles and their intervals.
import * as Plot from "@observablehq/plot";
import { bin, thresholdFreedmanDiaconis } from "d3";
import { numberText, shownUnit, withUnit, words } from "../units.js";
import { drawFrame, fileName, grid } from "./frame.js";
import { style } from "./line_figure.js";

const mostBins = 60;
const shareName = (share) => `${numberText(100 * share, 4)} %`;

// [{from, to, count}]; widths by Freedman and Diaconis.
function binsOf(values) {
  const known = Array.from(values).filter(Number.isFinite);
  const count = (all, low, high) =>
    Math.min(mostBins, Math.max(1, thresholdFreedmanDiaconis(all, low, high) || 1));
  return bin()
    .thresholds(count)(known)
    .map((one) => ({ from: one.x0, to: one.x1, count: one.length }));
}

function domainOf(bins, quantiles) {
  const ends = [...bins.flatMap(({ from, to }) => [from, to]), ...quantiles.map(({ value }) => value)];
  const known = ends.filter(Number.isFinite),
    low = Math.min(...known),
    high = Math.max(...known);
  const room = (high - low) * 0.02 || Math.abs(high) * 0.02 || 0.5;
  return known.length ? [low - room, high + room] : [0, 1];
}

function draw(canvas, { variable, values, quantiles }) {
  const bins = binsOf(values);
  const inUnit = domainOf(bins, quantiles);
  const { factor, text } = shownUnit(variable.unit, inUnit);
  const domain = inUnit.map((end) => end * factor);
  const within = (value) => Math.min(domain[1], Math.max(domain[0], value * factor));
  const most = Math.max(1, ...bins.map(({ count }) => count)) * 1.06;
  const known = quantiles.filter(({ value }) => Number.isFinite(value));
  return drawFrame(canvas, {
    x: { label: withUnit(words(variable.name), text), domain },
    y: { label: "samples", domain: [0, most] },
    legend: known.map(({ share }, i) => ({ text: `${shareName(share)} quantile`, ...style(i + 1) })),
    marks: [
      Plot.rectY(
        bins.filter(({ from, to }) => to > from),
        {
          x1: ({ from }) => from * factor,
          x2: ({ to }) => to * factor,
          y: "count",
          fill: style(0).stroke,
          fillOpacity: 0.6,
          inset: 0.5,
        },
      ),
      ...known.map(({ low, high }, i) =>
        Plot.rectX([{ low: within(low), high: within(high) }], {
          x1: "low",
          x2: "high",
          fill: style(i + 1).stroke,
          fillOpacity: 0.2,
        }),
      ),
      ...grid(),
      ...known.map(({ value }, i) =>
        Plot.ruleX([value * factor], {
          stroke: style(i + 1).stroke,
          strokeDasharray: style(i + 1).dash || undefined,
          strokeWidth: 1.8,
        }),
      ),
    ],
  });
}

// spec(): {variable, values: of the samples, quantiles: [{share, value, low, high}]}, as now shown.
export function histogram({ title, caption, spec }) {
  return {
    get name() {
      return fileName(`histogram_${spec().variable.name}`);
    },
    get title() {
      return title();
    },
    get caption() {
      return caption();
    },
    draw: (canvas) => draw(canvas, spec()),
    table: () => {
      const { variable, values } = spec(),
        bins = binsOf(values);
      return [
        { name: `${variable.name}_from`, unit: variable.unit, values: bins.map(({ from }) => from) },
        { name: `${variable.name}_to`, unit: variable.unit, values: bins.map(({ to }) => to) },
        { name: "samples", unit: "1", values: bins.map(({ count }) => count) },
      ];
    },
  };
}
