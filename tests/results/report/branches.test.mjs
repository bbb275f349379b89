// Branches through the rows of a map: which belong to a row, how they are drawn, and their columns.
import assert from "node:assert/strict";
import { test } from "node:test";
import {
  branchColumns,
  branchCurve,
  branchesOf,
  branchesThrough,
  placesBy,
  specialPoints,
  stabilityRuns,
} from "../../../results/report/page/branches.js";
import { sampleGroup, sampleRecord } from "./sample_record.mjs";

// Two branches at f = 0.1 and one at f = 0.2, the first with a fold between stable and unstable orbits.
function followed() {
  const group = sampleGroup(
    { along: "r" },
    {
      f: ["1", "branch", [0.1, 0.1, 0.2]],
      period_multiple: ["1", "branch", [1, 2, 1]],
      row_start: ["1", "branch", [0, 4, 6]],
      r: ["1", "place", [1, 2, 3, 2, 1, 1.5, 1, 3]],
      x_peak: ["m", "place", [1, 2, 3, 4, 5, 6, 7, 8]],
    },
    {
      stability: ["place", [1, 1, 2, 2, 1, 1, 1, 1], ["not_computed", "stable", "unstable"]],
      special: ["place", [1, 1, 2, 1, 1, 1, 1, 1], ["not_computed", "none", "fold"]],
    },
  );
  group.column("period_multiple").kind = group.column("row_start").kind = "count";
  return branchesOf(sampleRecord({ branches: group }));
}

const map = {
  axes: [
    { coordinates: [{ name: "f", values: [0.1, 0.2 * (1 + 1e-15)] }] },
    {
      coordinates: [
        { name: "r", values: [1, 2, 3] },
        { name: "speed", values: [10, 20, 40] },
      ],
    },
  ],
};

test("a row has the branches with its values, along their own axis alone", () => {
  const all = followed();
  assert.deepEqual(
    branchesThrough(all, map, 1, [0, 2]).map(({ from, to, multiple }) => [from, to, multiple]),
    [
      [0, 4, 1],
      [4, 6, 2],
    ],
  );
  assert.deepEqual(
    branchesThrough(all, map, 1, [1, 0]).map(({ from, to }) => [from, to]),
    [[6, 8]],
  );
  assert.deepEqual(branchesThrough(all, map, 0, [0, 0]), []);
  assert.deepEqual(branchesThrough(null, map, 1, [0, 0]), []);
});

test("a record without branches has none", () => {
  assert.equal(branchesOf(sampleRecord({})), null);
});

test("the parameter by another coordinate of its axis lies between its points", () => {
  const all = followed();
  const [r, speed] = map.axes[1].coordinates;
  assert.equal(placesBy(all, map.axes[1], r), all.x.values);
  assert.deepEqual([...placesBy(all, map.axes[1], speed).slice(2, 6)], [40, 20, 10, 15]);
});

test("lines of equal stability meet, and special points stand where they are", () => {
  const all = followed(),
    y = all.group.values("x_peak");
  const curves = all.branches.map((branch) => branchCurve(all, branch, all.x.values, y));
  assert.deepEqual(stabilityRuns(curves[0]), [
    { stable: true, from: 0, to: 2 },
    { stable: false, from: 2, to: 3 },
  ]);
  assert.deepEqual(specialPoints(curves), [{ x: 3, y: 3, kind: "fold" }]);
});

test("the columns of a branch are its own points, in words where they are flags", () => {
  const all = followed();
  const columns = branchColumns(all, all.branches[0], all.group.column("x_peak"), " of branch 1");
  assert.deepEqual(
    columns.map(({ name, unit, values }) => [name, unit, [...values]]),
    [
      ["r of branch 1", "1", [1, 2, 3, 2]],
      ["x_peak of branch 1", "m", [1, 2, 3, 4]],
      ["stability of branch 1", "", ["stable", "stable", "unstable", "unstable"]],
      ["special of branch 1", "", ["", "", "fold", ""]],
    ],
  );
});
