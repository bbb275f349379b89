// The motion that a crank gives its node over the angle, its Taylor series cut after an order, and the cuts' errors.
import { numberText, words } from "../units.js";
import { lineFigure, style } from "./line_figure.js";

const quarter = Math.PI / 2;
const quarterWords = ["0", "\u03c0/2", "\u03c0", "3\u03c0/2", "2\u03c0"];

// One turn.
function angleAxis({ angle }) {
  return {
    label: "angle of the crank",
    name: "angle",
    unit: angle.unit,
    domain: [0, 4 * quarter],
    ticks: quarterWords.map((_, i) => i * quarter),
    tickFormat: (value) => quarterWords[Math.round(value / quarter)],
  };
}

const orderText = (order) => `series to order ${numberText(order)}`;

export function crankMotionFigure(crank) {
  const { name, angle, motion, cuts } = crank;
  return lineFigure({
    name: `crank_${name}`,
    title: `What the crank drives: ${words(name)}`,
    caption: "The exact motion and its series in crank over rod, cut at an order.",
    x: angleAxis(crank),
    y: { label: `displacement of ${words(name)}`, unit: motion.unit },
    lines: [
      {
        name: motion.name,
        text: "exact",
        x: angle.values,
        y: motion.values,
        stroke: style(0).stroke,
        width: 2.2,
      },
      ...cuts.map(({ order, series }, i) => ({
        name: series.name,
        text: orderText(order),
        x: angle.values,
        y: series.values,
        ...style(i + 1),
      })),
    ],
  });
}

export function crankErrorFigure(crank) {
  const { name, angle, cuts } = crank;
  return lineFigure({
    name: `crank_errors_${name}`,
    title: `Error of the series of ${words(name)}`,
    caption: "Relative to the distance from the crank's bearing to the driven node.",
    x: angleAxis(crank),
    y: { label: "relative error", unit: "1", type: "log", decades: 6 },
    lines: cuts.map(({ order, error }, i) => ({
      name: error.name,
      text: orderText(order),
      x: angle.values,
      y: error.values,
      ...style(i + 1),
    })),
  });
}
