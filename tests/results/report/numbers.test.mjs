// The page's numbers, unpacked.
import assert from "node:assert/strict";
import { test } from "node:test";
import { deflateSync } from "node:zlib";
import { unpackLevels, unpackNumbers } from "../../../results/report/page/numbers.js";

function shuffled(typed) {
  const bytes = new Uint8Array(typed.buffer),
    size = typed.BYTES_PER_ELEMENT,
    out = new Uint8Array(bytes.length);
  for (let i = 0; i < typed.length; ++i)
    for (let b = 0; b < size; ++b) out[b * typed.length + i] = bytes[i * size + b];
  return deflateSync(out).toString("base64");
}

test("numbers come back bit for bit", async () => {
  const numbers = Float64Array.of(0, -0, 1 / 3, NaN, Infinity, -1e-300);
  assert.deepEqual(await unpackNumbers(shuffled(numbers)), numbers);
});

test("levels are the running sums of running sums along their lines", async () => {
  // Two lines side by side (stride 2): levels 1 3 5 0 and 2 2 2 2, written across.
  const coded = Uint32Array.from([1, 2, 1, -2, 0, 0, -7, 0], (d) => (d >= 0 ? 2 * d : -2 * d - 1));
  const values = await unpackLevels({ levels: shuffled(coded), low: 10, step: 0.5 }, { size: 4, stride: 2 });
  assert.deepEqual([...values], [10, 10.5, 11, 10.5, 12, 10.5, NaN, 10.5]);
});

test("levels of a logarithmic scale know zero and what is missing", async () => {
  // Levels 2, 1, 0, 3: low, zero, missing, low times e^step; written as second differences.
  const coded = Uint32Array.from([2, -3, 0, 4], (d) => (d >= 0 ? 2 * d : -2 * d - 1));
  const values = await unpackLevels(
    { levels: shuffled(coded), scale: "log", low: 1e-3, step: Math.log(2) },
    { size: 4, stride: 1 },
  );
  assert.deepEqual([...values].slice(0, 3), [1e-3, 0, NaN]);
  assert.ok(Math.abs(values[3] - 2e-3) < 1e-15);
});
