// A quantity over the records that drive a map of motions: the largest and the mean of all records along another axis.
import { symbolText } from "../axes.js";
import { numberText, words } from "../units.js";
import { lineFigure, style } from "./line_figure.js";

// The axis of records and its names, or null.
export function recordsOf({ axes }) {
  const axis = axes.findIndex(({ coordinates }) => coordinates.some(({ names }) => names));
  if (axis < 0) return null;
  return { axis, names: axes[axis].coordinates.find(({ names }) => names).names };
}

// Over the records at a point, of sizes: {largest, record: its number, mean, deviation, count}; NaN without values.
export function overRecords(map, variable, index, { axis }) {
  const sizes = Array.from(map.line(variable, index, axis), Math.abs);
  const known = sizes.filter((size) => !Number.isNaN(size)),
    count = known.length;
  if (count === 0) return { largest: NaN, record: -1, mean: NaN, deviation: NaN, count };
  const largest = Math.max(...known),
    mean = known.reduce((sum, size) => sum + size, 0) / count;
  const squares = known.reduce((sum, size) => sum + (size - mean) ** 2, 0);
  return {
    largest,
    record: sizes.indexOf(largest),
    mean,
    deviation: count > 1 ? Math.sqrt(squares / (count - 1)) : NaN,
    count,
  };
}

// state: {variable, axis: along which, coordinate: of that axis, index}; caption: the other axes.
export function overRecordsFigure(map, records, { variable, axis, coordinate, index, caption }) {
  const { values: x, name, unit } = coordinate;
  const points = Array.from(x, (_, i) => index.map((at, a) => (a === axis ? i : at)));
  const over = points.map((point) => overRecords(map, variable, point, records));
  const sizes = (record) =>
    points.map((point) =>
      Math.abs(
        map.value(
          variable,
          point.map((at, a) => (a === records.axis ? record : at)),
        ),
      ),
    );
  const steps = Array.from(x.slice(1), (value, i) => value / x[i]);
  const isLog =
    x.every((value) => value > 0) &&
    x.length > 2 &&
    steps.every((step) => Math.abs(step / steps[0] - 1) < 1e-6);
  return lineFigure({
    name: `records_${variable.name}`,
    title: `Largest and mean ${words(variable.name)} of ${records.names.length} records along ${symbolText(name)}`,
    caption,
    x: { label: symbolText(name), name, unit, type: isLog ? "log" : "linear", tight: true },
    y: { label: words(variable.name), unit: variable.unit, zero: true },
    lines: [
      ...records.names.map((record, n) => ({
        name: `${variable.name} ${record}`,
        text: n === 0 ? "each record" : "",
        x,
        y: sizes(n),
        stroke: "#7F7F7F",
        width: 0.8,
        opacity: 0.7,
      })),
      {
        name: `${variable.name} largest`,
        text: "largest",
        x,
        y: over.map(({ largest }) => largest),
        ...style(1),
        dash: "",
        width: 2.2,
      },
      {
        name: `${variable.name} mean`,
        text: "mean",
        x,
        y: over.map(({ mean }) => mean),
        ...style(0),
        dash: "6 3",
        width: 2.2,
      },
    ],
  });
}

// A row for the table: quantity, largest, its record, mean, deviation, records with a value.
export function overRecordsRow(map, records, variable, index) {
  const { largest, record, mean, deviation, count } = overRecords(map, variable, index, records);
  return [
    words(variable.name),
    numberText(largest),
    records.names[record] ?? "",
    numberText(mean),
    numberText(deviation),
    String(count),
  ];
}
