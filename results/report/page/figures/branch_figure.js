// Branches alone, without a map: a quantity along their parameter.
import { extent } from "d3";
import { coordinateLabel, symbolText } from "../axes.js";
import { branchColumns, branchCurve, specialPoints } from "../branches.js";
import { shownUnit, withUnit, words } from "../units.js";
import { branchLegend, branchLines, specialDots, specialTips } from "./branch_marks.js";
import { drawFrame, grid, lineColours, roomFor, tips } from "./frame.js";

export function branchFigure(canvas, followed, quantity) {
  const { factor, text } = shownUnit(quantity.unit, quantity.values);
  const y = quantity.values.map((value) => value * factor);
  const curves = followed.branches.map((branch) => branchCurve(followed, branch, followed.x.values, y));
  const points = specialPoints(curves),
    label = withUnit(words(quantity.name), text);
  return drawFrame(canvas, {
    x: { label: coordinateLabel(followed.x), domain: extent(followed.x.values) },
    y: { label, ...roomFor(Array.from(y)) },
    legend: branchLegend(curves),
    marks: [
      ...grid(),
      ...branchLines(curves, { stroke: lineColours[0] }),
      ...specialDots(points),
      ...tips(canvas, specialTips(points, symbolText(followed.along), label)),
    ],
  });
}

export function branchTable(followed, quantity) {
  return followed.branches.flatMap((branch, n) =>
    branchColumns(followed, branch, quantity, followed.branches.length > 1 ? ` of branch ${n + 1}` : ""),
  );
}
