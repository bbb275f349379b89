// Named amounts as horizontal bars, each with its number.
import * as Plot from "@observablehq/plot";
import { axisUnit, numberText, withUnit } from "../units.js";
import { drawFrame, fileName, lineColours } from "./frame.js";
import { digitWidth, wrapped } from "./text_lines.js";

const barHeight = 30,
  aroundBars = 64;

function draw(canvas, { label, unit, bars }) {
  const { factor, text } = axisUnit(unit, bars.map(({ value }) => value).filter(Number.isFinite));
  const longest = Math.max(...bars.map(({ name }) => name.length));
  const marginLeft = Math.min(canvas.width * 0.4, 20 + digitWidth * longest);
  const names = bars.map(({ name }) => wrapped(name, marginLeft - 20));
  const height =
    aroundBars + bars.length * barHeight + 15 * names.reduce((sum, lines) => sum + lines.length - 1, 0);
  const rows = bars.map(({ value, note }, i) => ({
    row: i,
    value: value * factor,
    text: `${numberText(value * factor, 4)}${note ? ` (${note})` : ""}`,
  }));
  const known = rows.filter(({ value }) => Number.isFinite(value));
  const [low, high] = [
    Math.min(0, ...known.map(({ value }) => value)),
    Math.max(0, ...known.map(({ value }) => value)),
  ];
  const textWidth = digitWidth * Math.max(...rows.map((row) => row.text.length)) + 8;
  const sides = (low < 0 ? 1 : 0) + (known.some(({ value }) => value >= 0) || low === high ? 1 : 0);
  const room =
    ((high - low || 1) * textWidth) / Math.max(80, canvas.width - marginLeft - 20 - sides * textWidth);
  return drawFrame(
    { ...canvas, height },
    {
      marginLeft,
      x: {
        label: withUnit(label, text),
        domain: [low < 0 ? low - room : 0, (high > low ? high : 1) + (sides > 1 || low === 0 ? room : 0)],
      },
      y: {
        type: "band",
        domain: rows.map(({ row }) => row),
        label: "",
        tickFormat: (row) => names[row].join("\n"),
      },
      marks: [
        Plot.barX(known, { x: "value", y: "row", fill: lineColours[0], insetTop: 2, insetBottom: 2 }),
        Plot.ruleX([0]),
        Plot.text(
          rows.filter(({ value }) => !(value < 0)),
          {
            x: ({ value }) => (Number.isFinite(value) ? value : 0),
            y: "row",
            text: "text",
            textAnchor: "start",
            dx: 5,
            fill: "currentColor",
            stroke: "none",
          },
        ),
        Plot.text(
          rows.filter(({ value }) => value < 0),
          {
            x: "value",
            y: "row",
            text: "text",
            textAnchor: "end",
            dx: -5,
            fill: "currentColor",
            stroke: "none",
          },
        ),
      ],
    },
  );
}

// bars: [{name, value, note}], values in `unit`; label: of the axis.
export function barFigure({ name, title, caption, label, unit, bars }) {
  return {
    name: fileName(name),
    title,
    caption,
    draw: (canvas) => draw(canvas, { label, unit, bars }),
    table: () => [
      { name: "name", unit: "1", values: bars.map((bar) => bar.name) },
      { name: label, unit, values: bars.map(({ value }) => value) },
    ],
  };
}
