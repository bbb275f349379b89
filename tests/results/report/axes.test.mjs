// Axes in words and places, and the scales that suit numbers.
import assert from "node:assert/strict";
import { test } from "node:test";
import { axisLabel, axisScale, nearest, symbolText } from "../../../results/report/page/axes.js";
import { spansDecades, suitsLogarithm, valueRange } from "../../../results/report/page/value_range.js";

test("a parameter may have any name, those of JavaScript's own objects too", () => {
  assert.equal(symbolText("omega_1"), "ω 1");
  for (const name of ["constructor", "toString", "hasOwnProperty"]) assert.equal(symbolText(name), name);
});

test("an axis names all parameters that move along it", () => {
  const mass = { name: "m1", unit: "kg", long_name: "parameter m1" },
    stiffness = { name: "k1", unit: "N m-1", long_name: "parameter k1" },
    ratio = { name: "mass_ratio", unit: "1", long_name: "" };
  const map = { parameters: new Set(["m1", "k1"]) };
  assert.equal(axisLabel(map, { coordinates: [mass, stiffness, ratio] }, mass), "m1 (kg), with k1");
  assert.equal(axisLabel(map, { coordinates: [mass] }, mass), "m1 (kg)");
});

test("an uneven axis over decades is drawn and searched on one scale", () => {
  const values = [1, 3, 10, 100, 5000];
  assert.equal(axisScale(values), "log");
  assert.equal(nearest(values, 1000, axisScale(values)), 4);
  assert.equal(nearest(values, 1000, "linear"), 3);
  assert.equal(axisScale([3000, 40, 1]), "log");
  assert.equal(axisScale([-1, 3, 9000]), "linear");
});

test("logarithms suit what is never negative, and neither counts nor words", () => {
  const of = (kind, values) => ({ kind, values: Float64Array.from(values) });
  const decades = of("float", [0, NaN, 1, 1, 1000]);
  assert.ok(suitsLogarithm(decades) && spansDecades(decades));
  assert.deepEqual(valueRange(decades), { low: 0, high: 1000, leastPositive: 1, hasGaps: true });
  assert.ok(!spansDecades(of("float", [1, 2, 3])));
  for (const unsuited of [
    of("float", [-1, 1, 1000]),
    of("float", [0, 0]),
    of("count", [1, 1, 100]),
    of("flag", [1, 5]),
  ])
    assert.ok(!suitsLogarithm(unsuited) && !spansDecades(unsuited));
});
