// What a crank drives: its motion over the angle, with the Taylor series cut after an order, and what the cuts miss.
import { cutErrors } from "../crank.js";
import { numberText, quantityText, words } from "../units.js";
import { lineFigure, style } from "./line_figure.js";

const quarter = Math.PI / 2;
const quarterWords = ["0", "\u03c0/2", "\u03c0", "3\u03c0/2", "2\u03c0"];

function angleAxis({ angle }) {
  const turn = Math.abs(angle.values.at(-1) - 4 * quarter) < 0.1;
  const ticks = turn ? { ticks: quarterWords.map((_, i) => i * quarter), tickFormat: (value) => quarterWords[Math.round(value / quarter)], domain: [0, 4 * quarter] } : { tight: true };
  return { label: "angle of the crank", name: "angle", unit: angle.unit, ...ticks };
}

const orderText = (order) => `series to order ${numberText(order)}`;

export function crankMotionFigure(crank) {
  const { name, angle, motion, cuts } = crank;
  return lineFigure({
    name: `crank_${name}`, title: `What the crank drives: ${words(name)}`, caption: "The exact motion, and its series in crank over rod cut after an order.",
    x: angleAxis(crank), y: { label: `displacement of ${words(name)}`, unit: motion.unit },
    lines: [{ name: motion.name, text: "exact", x: angle.values, y: motion.values, stroke: style(0).stroke, width: 2.2 },
      ...cuts.map(({ order, column }, i) => ({ name: column.name, text: orderText(order), x: angle.values, y: column.values, ...style(i + 1) }))],
  });
}

export function crankErrorFigure(crank) {
  const { name, angle, cuts, length, motion, isThrow } = crank;
  return lineFigure({
    name: `crank_errors_${name}`, title: `What the series of ${words(name)} misses`,
    caption: `Relative to ${isThrow ? "the throw" : "the largest displacement"}, ${quantityText(length, motion.unit)}.`,
    x: angleAxis(crank), y: { label: "relative error", unit: "1", type: "log", decades: 6 },
    lines: cuts.map((cut, i) => ({ name: `${name}_error_${cut.order}`, text: orderText(cut.order), x: angle.values, y: cutErrors(crank, cut), ...style(i + 1) })),
  });
}
