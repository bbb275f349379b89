// The CSV of a figure of curves and points.
import assert from "node:assert/strict";
import { test } from "node:test";
import { tableOf } from "../../../results/report/page/figures/line_table.js";

test("each place that is not that of the curves before stands in a column with a name of its own", () => {
  const x = [1, 2, 3];
  const columns = tableOf({
    x: { label: "frequency", name: "omega", unit: "rad s-1" },
    y: { label: "peak", unit: "m" },
    lines: [
      { name: "before", x, y: [1, 2, 1] },
      { name: "after", x, y: [1, 1, 1] },
    ],
    points: [
      { name: "active_peak", x: [2], y: [2] },
      { name: "other_peak", x: [1, 3], y: [1, 1] },
    ],
  });
  assert.deepEqual(
    columns.map(({ name }) => name),
    ["omega", "before", "after", "active_peak_omega", "active_peak", "other_peak_omega", "other_peak"],
  );
});
