// The records of a map of motions: the largest and the mean of all, along an axis and at the point shown.
import { axisText } from "../axes.js";
import { overRecordsFigure, overRecordsRow, recordsOf } from "../figures/over_records.js";
import { element, table } from "../parts/elements.js";
import { unitText } from "../units.js";
import { sliding } from "./sweep_state.js";

// The axis of the figure: that of the curves, unless it is the records' own.
function alongOf(map, state, records) {
  if (state.curveAxis !== records.axis) return state.curveAxis;
  return sliding(map).find((axis) => axis !== records.axis) ?? null;
}

function now(map, state, records) {
  const axis = alongOf(map, state, records);
  return overRecordsFigure(map, records, {
    variable: state.variable,
    axis,
    coordinate: map.axes[axis].coordinates[state.coordinates[axis]],
    index: state.index,
    caption: map.axes
      .map((other, a) =>
        a === axis || a === records.axis || other.size < 2 ? "" : axisText(map, other, state.index[a]),
      )
      .filter(Boolean)
      .join(", "),
  });
}

// null without records, or without another axis.
export function recordsFigure(map, state) {
  const records = recordsOf(map);
  if (!records || alongOf(map, state, records) === null) return null;
  return {
    get name() {
      return now(map, state, records).name;
    },
    get title() {
      return now(map, state, records).title;
    },
    get caption() {
      return now(map, state, records).caption;
    },
    draw: (canvas) => now(map, state, records).draw(canvas),
    table: () => now(map, state, records).table(),
  };
}

// The numbers of the quantities over the records at the point shown; null without records.
export function recordsTable(map, state, variables) {
  const records = recordsOf(map);
  if (!records) return null;
  const shown = variables.filter(({ kind }) => kind !== "flag");
  const rows = shown.map((variable) => {
    const [name, ...numbers] = overRecordsRow(map, records, variable, state.index);
    return [name, unitText(variable.unit), ...numbers];
  });
  return element(
    "div",
    { id: "records" },
    table(["quantity", "unit", "largest", "for record", "mean", "deviation", "records"], rows, {
      caption: "Over all records, absolute values, at the point below.",
      numeric: [2, 4, 5, 6],
    }),
  );
}
