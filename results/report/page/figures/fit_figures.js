// Data against the fitted model, and the residuals.
import { symbolText } from "../axes.js";
import { residualRms } from "../identification.js";
import { numberText, quantityText, words } from "../units.js";
import { lineFigure } from "./line_figure.js";
import { lineColours } from "./frame.js";

const mostPoints = 400; // beyond which data are drawn as a line
const data = lineColours[4],
  model = lineColours[0],
  left = lineColours[1];

function titleOf({ record, quantity }) {
  return record ? `${words(record)}: ${words(quantity)}` : words(quantity);
}

function xAxis({ along, over }) {
  return { label: symbolText(over), name: along.name, unit: along.unit };
}

// Data as points, or as a broad pale line where there are many.
function drawnData(series) {
  const { along, measured } = series;
  const drawn = { name: measured.name, text: "data", x: along.values, y: measured.values, stroke: data };
  return along.values.length > mostPoints
    ? { lines: [{ ...drawn, width: 4, opacity: 0.6 }], points: [] }
    : { lines: [], points: [{ ...drawn, r: 2.6, symbol: "open" }] };
}

// The model is drawn at some value even of an estimate that the data do not determine.
function undeterminedText(estimates) {
  const names = estimates.filter(({ value }) => Number.isNaN(value)).map(({ name }) => symbolText(name));
  if (names.length === 0) return "";
  return ` The model is drawn at values of ${names.join(", ")} that the data do not determine; other values give the same curve.`;
}

function fitFigure(series, estimates) {
  const { name, along, fitted, measured, quantity, nrmse } = series;
  const { lines, points } = drawnData(series);
  const order = [...along.values.keys()].sort((a, b) => along.values[a] - along.values[b]);
  const sorted = (values) => Float64Array.from(order, (i) => values[i]);
  return lineFigure({
    name: `fit_${name}`,
    title: `${titleOf(series)}, data against model`,
    caption: Number.isNaN(nrmse)
      ? "No fit quality: the data are constant."
      : `NRMSE fit ${numberText(nrmse)} %.${undeterminedText(estimates)}`,
    x: xAxis(series),
    y: { label: words(quantity), unit: measured.unit },
    lines: [
      ...lines,
      {
        name: fitted.name,
        text: "model",
        x: sorted(along.values),
        y: sorted(fitted.values),
        stroke: model,
        width: 1.5,
      },
    ],
    points,
  });
}

function residualFigure(series) {
  const { name, along, residual } = series;
  const drawn = { name: residual.name, x: along.values, y: residual.values, stroke: left };
  const many = along.values.length > mostPoints;
  return lineFigure({
    name: `residual_${name}`,
    title: `${titleOf(series)}, residual`,
    caption: `Data minus model; root mean square ${quantityText(residualRms(series), residual.unit, 4)}.`,
    x: xAxis(series),
    y: { label: "residual", unit: residual.unit, zero: true },
    lines: many ? [{ ...drawn, width: 1.1 }] : [],
    points: many ? [] : [{ ...drawn, r: 2.6 }],
    levels: [{ y: 0, dash: "" }],
  });
}

export function fitFigures({ series, estimates }) {
  return series.flatMap((one) =>
    one.residual && one.along ? [fitFigure(one, estimates), residualFigure(one)] : [],
  );
}
