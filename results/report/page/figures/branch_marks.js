// Branches in a figure: stable ones solid, unstable ones dashed, special points marked.
import * as Plot from "@observablehq/plot";
import { specialPoints, stabilityRuns } from "../branches.js";
import { numberText, words } from "../units.js";
import { curve, lineColours } from "./frame.js";

const unstableDash = "5 4";

// Colour of each kind of special point; grazings, of which there may be many, are open.
const kinds = {
  fold: { stroke: lineColours[1] },
  corner: { stroke: lineColours[3] },
  grazing: { stroke: lineColours[7], symbol: "open" },
  branching: { stroke: lineColours[2] },
  period_doubling: { stroke: lineColours[4] },
  torus: { stroke: lineColours[6] },
  stability_jump: { stroke: lineColours[5] },
  jump: { stroke: lineColours[1], symbol: "open" },
};

// curves: [{x, y, stable, special}], y on the scale of the figure.  style: {stroke} of all of them.
export function branchLines(curves, style) {
  return curves.flatMap((one) =>
    stabilityRuns(one)
      .filter(({ from, to }) => to > from)
      .map(({ stable, from, to }) =>
        curve(one.x.slice(from, to + 1), one.y.slice(from, to + 1), {
          stroke: style.stroke,
          strokeWidth: 1.6,
          ...(stable ? {} : { strokeDasharray: unstableDash }),
        }),
      ),
  );
}

export function specialDots(points) {
  return points.map(({ x, y, kind }) => {
    const { stroke, symbol } = kinds[kind];
    return Plot.dot([[x, y]], { r: 4, stroke, strokeWidth: 1.5, fill: symbol === "open" ? "none" : stroke });
  });
}

// What of it is there: the lines' meanings, and the kinds of special points.
export function branchLegend(curves) {
  const points = specialPoints(curves);
  const has = (is) => curves.some(({ stable }) => stable.includes(is));
  return [
    ...(has(true) ? [{ text: "stable", stroke: "currentColor" }] : []),
    ...(has(false) ? [{ text: "unstable", stroke: "currentColor", dash: unstableDash }] : []),
    ...Object.entries(kinds)
      .filter(([kind]) => points.some((point) => point.kind === kind))
      .map(([kind, { stroke, symbol = "filled" }]) => ({ text: words(kind), stroke, symbol })),
  ];
}

// Rows for the tip at the pointer.
export function specialTips(points, xLabel, yLabel) {
  return points.map(({ x, y, kind }) => ({
    x,
    y,
    text: [words(kind), `${xLabel} = ${numberText(x, 9)}`, `${yLabel}: ${numberText(y, 9)}`].join("\n"),
  }));
}
