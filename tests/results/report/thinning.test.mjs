// Long curves with fewer points keep what the eye would see.
import assert from "node:assert/strict";
import { test } from "node:test";
import { thinnedHistory, thinnedPath } from "../../../results/report/page/figures/line_thinning.js";

const count = 200000,
  columns = 600;
const time = Float64Array.from({ length: count }, (_, i) => i * 1e-3);

test("a history of 200000 samples keeps its spikes, its ends and the order of its points", () => {
  const y = time.map((t) => Math.sin(40 * t));
  y[77777] = 5;
  y[123456] = -7;
  const thin = thinnedHistory(time, y, columns);
  assert.ok(thin.x.length <= 4 * (columns + 1), `${thin.x.length} points`);
  assert.equal(Math.max(...thin.y), 5);
  assert.equal(Math.min(...thin.y), -7);
  assert.equal(thin.x[0], time[0]);
  assert.equal(thin.x.at(-1), time[count - 1]);
  assert.ok(thin.x.every((x, i) => i === 0 || x > thin.x[i - 1]));
});

test("every column of pixels keeps its own least and greatest value", () => {
  const y = time.map((t) => Math.sin(40 * t) * t);
  const thin = thinnedHistory(time, y, columns),
    width = (time[count - 1] - time[0]) / columns;
  for (const column of [0, 17, 300, 599]) {
    const within = (x) => Math.floor(x / width) === column;
    const whole = y.filter((_, i) => within(time[i])),
      kept = thin.y.filter((_, i) => within(thin.x[i]));
    assert.equal(
      Math.max(...kept),
      whole.reduce((a, b) => Math.max(a, b)),
    );
    assert.equal(
      Math.min(...kept),
      whole.reduce((a, b) => Math.min(a, b)),
    );
  }
});

test("a short history stays as it is", () => {
  const x = [0, 1, 2],
    y = [3, NaN, 5];
  assert.deepEqual(thinnedHistory(x, y, columns), { x, y });
});

// Distance of a point from a line of straight pieces.
function distance([px, py], { x, y }) {
  let least = Infinity;
  for (let i = 0; i + 1 < x.length; ++i) {
    const [dx, dy] = [x[i + 1] - x[i], y[i + 1] - y[i]],
      square = dx * dx + dy * dy;
    const along = square === 0 ? 0 : Math.max(0, Math.min(1, ((px - x[i]) * dx + (py - y[i]) * dy) / square));
    least = Math.min(least, Math.hypot(px - x[i] - along * dx, py - y[i] - along * dy));
  }
  return least;
}

test("a thinned spiral lies within the tolerance of all its points", () => {
  const turns = 5,
    points = 20000,
    tolerance = 0.2;
  const phase = Array.from({ length: points }, (_, i) => (2 * Math.PI * turns * i) / points);
  const x = phase.map((p) => 200 * Math.exp(-0.02 * p) * Math.cos(p)),
    y = phase.map((p) => 200 * Math.exp(-0.02 * p) * Math.sin(p));
  const thin = thinnedPath(x, y, { x: 1, y: 1 }, tolerance);
  assert.ok(thin.x.length < points / 20, `${thin.x.length} points`);
  for (let i = 0; i < points; i += 7) assert.ok(distance([x[i], y[i]], thin) <= 1.001 * tolerance);
});

test("a path that goes forth and back keeps its turning points", () => {
  const x = [0, 1, 2, 3, 2, 1, 0, -1, 0],
    y = x.map(() => 0);
  const thin = thinnedPath(x, y, { x: 10, y: 10 }, 0.2);
  assert.deepEqual(thin.x, [0, 3, -1, 0]);
});
