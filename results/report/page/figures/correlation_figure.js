// Correlations of the estimates as a matrix of coloured squares: blue goes with, orange against.
import * as Plot from "@observablehq/plot";
import { interpolateRgb } from "d3";
import { symbolText } from "../axes.js";
import { correlationText } from "../identification_words.js";
import { numberText } from "../units.js";
import { drawFrame, lineColours } from "./frame.js";
import { digitWidth, wrapped } from "./text_lines.js";

const [withColour, againstColour] = lineColours;
const none = "#F4F4F4",
  unknown = "#A8A8A8";
const leastNumberWidth = 54; // of a square that has room for its number

function colourOf(value) {
  if (!Number.isFinite(value)) return unknown;
  return interpolateRgb(none, value > 0 ? withColour : againstColour)(Math.min(1, Math.abs(value)));
}

const hasUnknown = (estimates) =>
  estimates.some(({ correlation }) => correlation.some(({ value }) => !Number.isFinite(value)));

function draw(canvas, estimates) {
  const numbers = estimates.map((_, i) => String(i + 1));
  const names = estimates.map(({ name }, i) => `${i + 1}  ${symbolText(name)}`);
  const marginLeft = Math.min(
    canvas.width * 0.45,
    24 + digitWidth * Math.max(...names.map((name) => name.length)),
  );
  const nameLines = names.map((name) => wrapped(name, marginLeft - 16));
  const height = Math.max(
    canvas.height,
    64 + names.length * (8 + 15 * Math.max(...nameLines.map(({ length }) => length))),
  );
  const cells = estimates.flatMap(({ correlation }, i) =>
    correlation.map(({ value }, j) => ({ x: numbers[j], y: numbers[i], value })),
  );
  const room = (canvas.width - marginLeft - 20) / numbers.length;
  const texts =
    room < leastNumberWidth
      ? []
      : [
          Plot.text(
            cells.filter(({ value }) => Number.isFinite(value)),
            {
              x: "x",
              y: "y",
              text: ({ value }) => correlationText(value, 3),
              fill: ({ value }) => (Math.abs(value) > 0.6 ? "white" : "black"),
              stroke: "none",
            },
          ),
        ];
  return drawFrame(
    { ...canvas, height },
    {
      marginLeft,
      x: { type: "band", padding: 0.03, domain: numbers, label: "number of the estimate" },
      y: {
        type: "band",
        padding: 0.03,
        domain: numbers,
        label: "",
        tickFormat: (number) => nameLines[Number(number) - 1].join("\n"),
      },
      legend: [
        ...[-1, -0.5, 0, 0.5, 1].map((value) => ({ text: numberText(value), fill: colourOf(value) })),
        ...(hasUnknown(estimates) ? [{ text: "none: not determined by the data", fill: unknown }] : []),
      ],
      marks: [
        Plot.cell(cells, { x: "x", y: "y", fill: ({ value }) => colourOf(value), inset: 0.5 }),
        ...texts,
      ],
    },
  );
}

export function correlationFigure(estimates) {
  return {
    name: "correlations",
    title: "Correlations of the estimates",
    caption: "Near \u22121 or 1 the data hardly distinguish the two estimates.",
    draw: (canvas) => draw(canvas, estimates),
    table: () => [
      { name: "estimate", unit: "1", values: estimates.map(({ name }) => name) },
      ...estimates.map(({ name, correlation }) => ({
        name: `${name}_correlation`,
        unit: "1",
        values: correlation.map(({ value }) => value),
      })),
    ],
  };
}
