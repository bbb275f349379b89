// Solved resonances: a quantity of group /resonance over one of the map's parameters, one curve for each value of
// the others.
import { axisScale, coordinateLabel, symbolText } from "../axes.js";
import { numberText, shownUnit, unitText, withUnit, words } from "../units.js";
import { curve, dots, drawFrame, grid, lineColours, roomFor } from "./frame.js";

const mostCurves = 8;

const solved =
  /_(resonance_frequency|resonance_amplitude|half_power_low|half_power_high|half_power_damping)$/;

export function resonanceQuantities(group) {
  return group.along("curve").filter(({ name }) => solved.test(name));
}

export function resonanceParameters(group) {
  return group.along("curve").filter(({ name }) => !solved.test(name));
}

// The number of each curve, used if no parameter orders the curves.
export function curveNumbers(group) {
  const { length } = resonanceQuantities(group)[0].values;
  return { name: "curve", unit: "1", values: Float64Array.from({ length }, (_, i) => i + 1) };
}

// The first parameter along which some curve has two points or more, else the curves' number.
export function firstParameter(group) {
  const joins = (x) => curvesOver(group, x).some(({ rows }) => rows.length > 1);
  return resonanceParameters(group).find(joins) ?? curveNumbers(group);
}

// At most `mostCurves` of a list, evenly chosen.
function some(list) {
  if (list.length <= mostCurves) return list;
  return Array.from(
    { length: mostCurves },
    (_, i) => list[Math.round((i * (list.length - 1)) / (mostCurves - 1))],
  );
}

// Rows of the group by the values of the other parameters: [{text, rows}].
function allCurvesOver(group, x) {
  const others = x.name === "curve" ? [] : resonanceParameters(group).filter(({ name }) => name !== x.name);
  const curves = new Map();
  for (let row = 0; row < x.values.length; ++row) {
    const text = others
      .map(
        ({ name, unit, values }) =>
          `${symbolText(name)} = ${numberText(values[row], 4)}${unitText(unit) ? ` ${unitText(unit)}` : ""}`,
      )
      .join(", ");
    curves.set(text, [...(curves.get(text) ?? []), row]);
  }
  return [...curves].map(([text, rows]) => ({ text, rows }));
}

function curvesOver(group, x) {
  return some(allCurvesOver(group, x));
}

// How many curves are shown, and how many response curves have no resonance.
export function resonanceNote(group, quantity, x) {
  const all = allCurvesOver(group, x).length,
    none = quantity.values.filter(Number.isNaN).length;
  return [
    "Solved along the frequency axis, not sampled.",
    none ? `${none} of ${quantity.values.length} response curves have none within it.` : "",
    all > mostCurves ? `${mostCurves} of ${all} lines; the CSV has all.` : "",
  ]
    .filter(Boolean)
    .join(" ");
}

export function resonanceFigure(canvas, group, quantity, x) {
  const { factor, text } = shownUnit(quantity.unit, quantity.values);
  const curves = curvesOver(group, x);
  return drawFrame(canvas, {
    x: { label: coordinateLabel(x), type: axisScale([...new Set(x.values)].sort((a, b) => a - b)) },
    y: {
      label: withUnit(words(quantity.name), text),
      ...roomFor(Array.from(quantity.values, (value) => value * factor)),
    },
    legend:
      curves.length > 1
        ? curves.map((one, n) => ({ text: one.text, stroke: lineColours[n % lineColours.length] }))
        : [],
    marks: [
      ...grid(),
      ...curves.flatMap(({ rows }, n) => {
        const xs = rows.map((row) => x.values[row]),
          ys = rows.map((row) => quantity.values[row] * factor);
        const stroke = lineColours[n % lineColours.length];
        return [
          curve(xs, ys, { stroke }),
          ...(rows.length <= 60 ? [dots(xs, ys, { fill: stroke, r: 2.5 })] : []),
        ];
      }),
    ],
  });
}

export function resonanceTable(group) {
  return group.along("curve").map(({ name, unit, values }) => ({ name, unit, values }));
}
