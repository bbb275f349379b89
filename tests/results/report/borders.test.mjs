// Crossings on the edges of the grid, joined into curves.
import assert from "node:assert/strict";
import { test } from "node:test";
import { borderCurves } from "../../../results/report/page/borders.js";

const crossing = (i, j, axis, key = "a|b") => ({ place: [i, j], axis, key });
const whole = { x: 0, y: 1, index: [0, 0] };

test("a straight border is one curve from rim to rim", () => {
  // Between the columns 0 and 1 of a grid of 3 x 4 points, at i = 0.4 in each of four rows.
  const crossings = [0, 1, 2, 3].map((j) => crossing(0.4, j, 0));
  const curves = borderCurves(crossings, { ...whole, nx: 3, ny: 4 });
  assert.equal(curves.length, 1);
  assert.deepEqual(
    curves[0].points.map(([i]) => i),
    [0.4, 0.4, 0.4, 0.4],
  );
  assert.deepEqual(curves[0].points.map(([, j]) => j).sort(), [0, 1, 2, 3]);
});

test("a border about one point closes", () => {
  const crossings = [crossing(0.5, 1, 0), crossing(1.5, 1, 0), crossing(1, 0.5, 1), crossing(1, 1.5, 1)];
  const curves = borderCurves(crossings, { ...whole, nx: 3, ny: 3 });
  assert.equal(curves.length, 1);
  assert.equal(curves[0].points.length, 5);
  assert.deepEqual(curves[0].points[0], curves[0].points[4]);
});

test("three borders that meet in a cell meet in one point", () => {
  const crossings = [crossing(0.5, 0, 0, "a|b"), crossing(0, 0.5, 1, "a|c"), crossing(1, 0.5, 1, "b|c")];
  const curves = borderCurves(crossings, { ...whole, nx: 2, ny: 2 });
  assert.equal(curves.length, 3);
  const meet = new Set(
    curves.map(({ points }) => points.find(([i, j]) => i !== 0 && i !== 1 && j !== 0)?.join()),
  );
  assert.equal(meet.size, 1);
});

test("crossings of other slices stay away", () => {
  const crossings = [
    { place: [0.5, 0, 2], axis: 0, key: "a|b" },
    { place: [0.5, 1, 2], axis: 0, key: "a|b" },
    { place: [0.3, 0, 1], axis: 0, key: "a|b" },
  ];
  const curves = borderCurves(crossings, { x: 0, y: 1, index: [0, 0, 2], nx: 2, ny: 2 });
  assert.deepEqual(
    curves.map(({ points }) => points.map(([i]) => i)),
    [[0.5, 0.5]],
  );
});
