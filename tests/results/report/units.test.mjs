// Units and numbers as readers write them, axes and legends that hold them.
import assert from "node:assert/strict";
import { test } from "node:test";
import { powerText, powerTicks } from "../../../results/report/page/figures/power_ticks.js";
import { wrapped } from "../../../results/report/page/figures/text_lines.js";
import {
  axisUnit,
  groupedByUnit,
  numberText,
  quantityText,
  shareText,
  unitText,
} from "../../../results/report/page/units.js";

test("units have powers, products and quotients", () => {
  assert.equal(unitText("m s-2"), "m/s²");
  assert.equal(unitText("N s m-1"), "N s/m");
  assert.equal(unitText("rad s-1"), "rad/s");
  assert.equal(unitText("(m)2"), "m²");
  assert.equal(unitText("(m s-1)2"), "(m/s)²");
  assert.equal(unitText("percent"), "%");
  assert.equal(unitText("1"), "");
  assert.equal(unitText("kN/m"), "kN/m");
});

test("quantities stand in the unit that reads best", () => {
  assert.equal(quantityText(0.0319116, "m", 4), "31.91 mm");
  assert.equal(quantityText(-2.5e-7, "m", 4), "−250 nm");
  assert.equal(quantityText(26.5, "N s m-1"), "26.5 N s/m");
  assert.equal(quantityText(NaN, "m"), "–");
  assert.equal(numberText(1.1058e-9, 2), "1.1×10⁻⁹");
  assert.equal(numberText(Infinity), "∞");
});

test("what is beyond the prefixes stands in the unit itself with its power of ten", () => {
  assert.equal(quantityText(8.76588e-203, "J"), "8.76588×10⁻²⁰³ J");
  assert.equal(quantityText(-1.396e-17, "m", 4), "−1.396×10⁻¹⁷ m");
  assert.equal(quantityText(2.5e-12, "m"), "0.0025 nm");
  assert.equal(quantityText(0, "m"), "0 m");
});

test("a long label falls into lines at its blanks, a long word where it must, and nothing is lost", () => {
  const text = "the growth of the worst_peak_of_a_mass_with_a_name_that_goes_on_and_on (mm)",
    lines = wrapped(text, 120);
  assert.ok(lines.length > 3);
  assert.ok(lines.every((line) => line.length <= Math.floor(120 / (0.56 * 12))));
  assert.equal(lines.join("").replaceAll(" ", ""), text.replaceAll(" ", ""));
  assert.deepEqual(wrapped("short", 120), ["short"]);
  assert.deepEqual(wrapped("", 120), [""]);
});

test("a logarithmic axis has ticks at powers of ten, one style for all of them", () => {
  assert.deepEqual(powerTicks([2e-6, 3e-3]).map(powerText([2e-6, 3e-3])), ["10⁻⁵", "10⁻⁴", "10⁻³"]);
  assert.deepEqual(powerTicks([0.8, 30]).map(powerText([0.8, 30])), ["1", "2", "5", "10", "20"]);
  assert.ok(powerTicks([1e-16, 1]).length <= 9);
});

test("a share that is not all is not told as all", () => {
  assert.equal(shareText(0.99971), "99.97 %");
  assert.equal(shareText(0.999999), "99.9999 %");
  assert.equal(shareText(1), "100 %");
  assert.equal(shareText(0.7512), "75.1 %");
});

test("a linear axis has a power of ten before its unit where its numbers would have many zeros", () => {
  assert.deepEqual(axisUnit("J", [0, 2.5e-13]), { factor: 1e15, text: "×10⁻¹⁵ J" });
  assert.equal(axisUnit("J", [0, 5e12]).text, "×10¹² J");
  assert.deepEqual(axisUnit("J", [0, 0.25]), { factor: 1000, text: "mJ" });
});

test("what has different units is drawn on different axes, in the order in which it comes", () => {
  const named = (name, unit) => ({ name, unit });
  const items = [named("machine", "m"), named("flywheel", "rad"), named("rack", "m")];
  const groups = groupedByUnit(items, ({ unit }) => unit);
  assert.deepEqual(
    groups.map(({ unit, members }) => [unit, members.map(({ name }) => name)]),
    [
      ["m", ["machine", "rack"]],
      ["rad", ["flywheel"]],
    ],
  );
});
