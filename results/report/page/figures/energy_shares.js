// The damping budget along a response curve: each element's share of the energy dissipated in a period, stacked.
import * as Plot from "@observablehq/plot";
import { extent } from "d3";
import { axisLabel, axisScale } from "../axes.js";
import { words } from "../units.js";
import { drawFrame, lineColours } from "./frame.js";

const shareEnd = "_energy_share";

// The shares of elements that dissipate energy.
export function dissipating(variables) {
  return variables.filter(({ name, values }) => name.endsWith(shareEnd) && values.some((value) => value > 0));
}

export function energyShares(canvas, map, variables, { axis, coordinate, index }) {
  const x = map.axes[axis].coordinates[coordinate];
  const shares = variables.map((variable) => map.line(variable, index, axis));
  const isDissipated = (i) => shares.some((share) => share[i] > 0);
  const below = new Float64Array(x.values.length);
  const marks = shares.map((share, n) => {
    const band = Array.from(x.values, (value, i) => {
      const low = 100 * below[i];
      if (isDissipated(i) && Number.isFinite(share[i])) below[i] += share[i];
      return { x: value, low, high: isDissipated(i) ? 100 * below[i] : NaN };
    });
    return Plot.areaY(band, {
      x: "x",
      y1: "low",
      y2: "high",
      fill: lineColours[n % lineColours.length],
      fillOpacity: 0.85,
    });
  });
  return drawFrame(canvas, {
    x: { label: axisLabel(map, map.axes[axis], x), type: axisScale(x.values), domain: extent(x.values) },
    y: { label: "share of the energy dissipated (%)", domain: [0, 100] },
    legend: variables.map(({ name }, n) => ({
      text: words(name.slice(0, -shareEnd.length)),
      fill: lineColours[n % lineColours.length],
    })),
    marks,
  });
}

export function energySharesTable(map, variables, { axis, index }) {
  return [
    ...map.axes[axis].coordinates.map(({ name, unit, values }) => ({ name, unit, values })),
    ...variables.map((variable) => ({
      name: variable.name,
      unit: "1",
      digits: variable.digits,
      values: map.line(variable, index, axis),
    })),
  ];
}
